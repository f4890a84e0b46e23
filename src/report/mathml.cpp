#include "report/mathml.hpp"

#include "report/markup.hpp"

#include <algorithm>
#include <optional>

namespace maupertuis {
namespace {

// ---------------------------------------------------------------------------------------------------------- reading

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  std::optional<MathRow> read() {
    MathRow row = elements();
    return failed_ || at_ != text_.size() ? std::nullopt : std::optional(std::move(row));
  }

 private:
  MathRow elements() {
    MathRow row;
    while (!failed_ && at_ < text_.size() && text_[at_] == '<' && text_.substr(at_, 2) != "</") row.push_back(element());
    return row;
  }

  MathElement element() {
    MathElement e;
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos) return fail();
    std::string_view tag = text_.substr(at_ + 1, end - at_ - 1);
    const bool closed = !tag.empty() && tag.back() == '/';
    if (closed) tag.remove_suffix(1);
    const std::size_t space = std::min(tag.find(' '), tag.size());
    e.name = tag.substr(0, space);
    e.attributes = tag.substr(space);
    at_ = end + 1;
    if (closed) return e;
    e.children = elements();
    const std::size_t close = text_.find('<', at_);
    if (close == std::string_view::npos || text_.substr(close, e.name.size() + 3) != "</" + e.name + ">") return fail();
    e.text = text_.substr(at_, close - at_);
    at_ = close + e.name.size() + 3;
    return e;
  }

  MathElement fail() {
    failed_ = true;
    return {};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

void write(std::string& out, const MathElement& e) {
  out += '<' + e.name + e.attributes + '>' + e.text;
  for (const MathElement& child : e.children) write(out, child);
  out += "</" + e.name + '>';
}

// ------------------------------------------------------------------------------------------------------ typesetting

constexpr std::string_view invisible_times = "&#x2062;", function_application = "&#x2061;";

bool is(const MathElement& e, std::string_view name, std::string_view text) { return e.name == name && e.text == text; }

bool is_tall(const MathElement& e) {
  return e.name == "mfrac" || e.name == "msqrt" || e.name == "mroot" || e.name == "mtable" ||
         std::any_of(e.children.begin(), e.children.end(), is_tall);
}

bool is_bracketed(const MathElement& e) {
  return e.name == "mrow" && e.children.size() >= 2 && is(e.children.front(), "mo", "(") && is(e.children.back(), "mo", ")");
}

// sin, cos², …: a name of several letters, perhaps raised.
bool is_function_name(const MathElement& e) {
  if (e.name == "msup" && !e.children.empty()) return is_function_name(e.children[0]);
  return e.name == "mi" && e.text.size() > 1 && e.text.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos;
}

bool begins_with_function(const MathElement& e) {
  return e.name == "mrow" && e.children.size() >= 2 && is(e.children[1], "mo", function_application) && is_function_name(e.children[0]);
}

MathElement thin_space() { return {"mspace", " width=\"0.17em\"", "", {}}; }

void raise_beside_index(MathElement& e) {
  if (e.name != "msup" || e.children.size() != 2 || e.children[0].name != "msub" || e.children[0].children.size() != 2) return;
  MathElement base = std::move(e.children[0]), exponent = std::move(e.children[1]);
  e = {"msubsup", "", "", {std::move(base.children[0]), std::move(base.children[1]), std::move(exponent)}};
}

void keep_brackets_plain(MathElement& e) {
  if (!is_bracketed(e) || is_tall(e)) return;
  e.children.front().attributes = e.children.back().attributes = " stretchy=\"false\"";
}

bool ends_with_bare_argument(const MathElement& e) { return begins_with_function(e) && !is_bracketed(e.children.back()); }

// Whether a thin space follows element i: between a function and its bare argument, and on either side of it in a product.
bool space_follows(const MathRow& row, std::size_t i) {
  if (i + 1 >= row.size()) return false;
  if (is(row[i], "mo", function_application)) return !is_bracketed(row[i + 1]);
  if (!is(row[i], "mo", invisible_times)) return false;
  return begins_with_function(row[i + 1]) || (i > 0 && ends_with_bare_argument(row[i - 1]));
}

MathRow spaced(const MathRow& row) {
  MathRow result;
  for (std::size_t i = 0; i < row.size(); ++i) {
    result.push_back(row[i]);
    if (space_follows(row, i)) result.push_back(thin_space());
  }
  return result;
}

bool is_sum_sign(const MathElement& e) {
  return e.name == "mo" && (e.text == "+" || e.text == "−" || e.text == "-" || e.text == "&#x2212;");
}

}  // namespace

MathRow parse_mathml(std::string_view fragment) {
  if (auto row = Reader(fragment).read()) return std::move(*row);
  return {{"mtext", "", escape_html(fragment), {}}};
}

std::string to_string(const MathRow& row) {
  std::string out;
  for (const MathElement& e : row) write(out, e);
  return out;
}

void typeset(MathRow& row) {
  for (MathElement& e : row) {
    typeset(e.children);
    raise_beside_index(e);
    keep_brackets_plain(e);
    if (e.name == "mrow") e.children = spaced(e.children);
  }
}

std::size_t letters_in(const MathRow& row) {
  std::size_t count = 0;
  for (const MathElement& e : row) {
    const bool invisible = e.text == invisible_times || e.text == function_application;
    if (!invisible && e.text.size() > 1 && e.text[0] == '&') ++count;
    else if (!invisible)
      count += static_cast<std::size_t>(std::count_if(e.text.begin(), e.text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
    // A fraction is as wide as its wider part.
    if (e.name == "mfrac" && e.children.size() == 2) count += std::max(letters_in({e.children[0]}), letters_in({e.children[1]}));
    else count += letters_in(e.children);
  }
  return count;
}

std::vector<MathRow> open_longest_bracket(MathRow term) {
  if (term.size() == 1 && term[0].name == "mrow" && !is_bracketed(term[0])) term = MathRow(term[0].children);
  // A sign in front and one factor: the factors stand a level deeper.
  if (term.size() == 2 && term[1].name == "mrow" && !is_bracketed(term[1])) {
    MathRow flat{term[0]};
    flat.insert(flat.end(), term[1].children.begin(), term[1].children.end());
    term = std::move(flat);
  }
  std::size_t longest = term.size();
  for (std::size_t i = 0; i < term.size(); ++i)
    if (is_bracketed(term[i]) && (longest == term.size() || letters_in({term[i]}) > letters_in({term[longest]}))) longest = i;
  if (longest == term.size()) return {term};

  MathElement open = term[longest].children.front(), close = term[longest].children.back();
  if (is_tall(term[longest])) open.attributes = close.attributes = " stretchy=\"true\" minsize=\"2.4em\" maxsize=\"2.4em\"";
  open.attributes += " form=\"prefix\"";
  close.attributes += " form=\"postfix\"";
  auto pieces = signed_terms(MathRow(term[longest].children.begin() + 1, term[longest].children.end() - 1));
  if (pieces.size() < 2) return {term};
  pieces.front().insert(pieces.front().begin(), open);
  pieces.front().insert(pieces.front().begin(), term.begin(), term.begin() + static_cast<std::ptrdiff_t>(longest));
  pieces.back().push_back(close);
  pieces.back().insert(pieces.back().end(), term.begin() + static_cast<std::ptrdiff_t>(longest) + 1, term.end());
  return pieces;
}

std::vector<MathRow> signed_terms(MathRow row) {
  while (row.size() == 1 && row[0].name == "mrow" && row[0].attributes.empty()) {
    MathRow inner = std::move(row[0].children);
    row = std::move(inner);
  }
  std::vector<MathRow> terms;
  for (MathElement& e : row) {
    const bool sign = is_sum_sign(e);
    if (sign && !terms.empty()) e.attributes = " form=\"infix\"";
    if (sign || terms.empty()) terms.emplace_back();
    terms.back().push_back(std::move(e));
  }
  return terms;
}

}  // namespace maupertuis
