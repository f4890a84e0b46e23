#include "report/markup.hpp"

#include <maupertuis/escape_xml.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace maupertuis {

std::string unit_html(std::string_view unit) {
  std::string result;
  for (std::size_t i = 0; i < unit.size();) {
    if (unit[i] != '^') {
      result += escape_xml(unit.substr(i++, 1));
      continue;
    }
    const std::size_t end = std::min(unit.find_first_not_of("-0123456789", i + 1), unit.size());
    std::string exponent(unit.substr(i + 1, end - i - 1));
    if (!exponent.empty() && exponent[0] == '-') exponent.replace(0, 1, "−");
    result += "<sup>" + exponent + "</sup>";
    i = end;
  }
  return result;
}

std::string number_html(std::string_view number) {
  const auto e = number.find('e');
  const bool plain = e == std::string_view::npos || e == 0 || number.find_first_not_of("+-0123456789.", 0) != e;
  const bool quantity = !number.empty() && std::string_view("+-.0123456789").find(number[0]) != std::string_view::npos;
  const std::string_view rest = number.substr(0, plain ? number.size() : e);
  std::string mantissa = quantity ? unit_html(rest) : escape_xml(rest);
  if (!mantissa.empty() && mantissa[0] == '-' && mantissa.size() > 1) mantissa.replace(0, 1, "−");
  if (plain) return mantissa;
  std::size_t end = e + 1;
  while (end < number.size() &&
         (number[end] == '-' || number[end] == '+' || (number[end] >= '0' && number[end] <= '9')))
    ++end;
  int exponent = 0;
  for (const char c : number.substr(e + 1, end - e - 1))
    if (c >= '0' && c <= '9') exponent = 10 * exponent + (c - '0');
  const std::string factor = mantissa == "1" ? "" : mantissa + " × ";
  return fmt::format("{}10<sup>{}{}</sup>{}", factor, number[e + 1] == '-' ? "−" : "", exponent,
                     unit_html(number.substr(end)));
}

// ------------------------------------------------------------------------------------------------------ mathematics

namespace {

constexpr double one_line = 34;     // em that fit into a line of the page
constexpr double surely_fits = 18;  // … of a narrow window

Layout with_sign(const Layout& left, const Layout& right) {
  if (left.empty()) return right;
  if (right.empty()) return left;
  Layout equals, row;
  equals.shape = Shape::Sign;
  equals.text = "=";
  row.shape = Shape::Row;
  row.parts = {left, equals, right};
  return row;
}

}  // namespace

std::string inline_math(const Layout& formula) {
  return formula.empty() ? std::string() : fmt::format("<math>{}</math>", to_mathml(formula));
}

std::string display_math(const Layout& left, const Layout& right) {
  const double whole = width(left) + width(right);
  const std::vector<Layout> parts =
      whole <= surely_fits ? std::vector<Layout>{with_sign(left, right)} : pieces(left, right, one_line);
  std::string html;
  for (const Layout& piece : parts)
    html += fmt::format("{}<math displaystyle=\"true\">{}</math>", html.empty() ? "" : "<wbr>", to_mathml(piece));
  return fmt::format("<div class=\"formula{}\">{}</div>", whole > one_line ? " long" : "", html);
}

// ------------------------------------------------------------------------------------------------------------- text

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_greek_lead(char c) { return c == '\xce' || c == '\xcf'; }
bool is_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80); }

/// Whether the word that ends at `end` is one letter: names of files and of options keep their underscores.
bool is_one_letter_before(std::string_view text, std::size_t end) {
  std::size_t begin = end - 1;
  while (begin > 0 && (text[begin] & 0xc0) == 0x80) --begin;
  return is_word(text[begin]) && (begin == 0 || !(is_word(text[begin - 1]) || text[begin - 1] == '_'));
}

// θ1 with its index below the line, p_θ1 and h_E likewise; a minus sign between spaces as one.
std::string prose_html(std::string_view text) {
  std::string html;
  for (std::size_t i = 0; i < text.size();) {
    if (is_greek_lead(text[i]) && i + 2 < text.size() && is_digit(text[i + 2])) {
      const std::size_t end = std::min(text.find_first_not_of("0123456789", i + 2), text.size());
      html += fmt::format("{}<sub>{}</sub>", text.substr(i, 2), text.substr(i + 2, end - i - 2));
      i = end;
    } else if (text[i] == '_' && i > 0 && is_one_letter_before(text, i) && i + 1 < text.size() &&
               is_word(text[i + 1])) {
      std::size_t end = i + 1;
      while (end < text.size() && is_word(text[end])) ++end;
      html += fmt::format("<sub>{}</sub>", prose_html(text.substr(i + 1, end - i - 1)));
      i = end;
    } else if (text.substr(i, 3) == " - ") {
      html += " − ";
      i += 3;
    } else {
      html += escape_xml(text.substr(i, 1));
      ++i;
    }
  }
  return html;
}

}  // namespace

std::string sentence_html(std::string_view sentence) {
  std::string html;
  bool code = false;
  for (std::size_t at = 0; at <= sentence.size();) {
    const std::size_t next = std::min(sentence.find('`', at), sentence.size());
    const std::string_view part = sentence.substr(at, next - at);
    html += code ? escape_xml(part) : prose_html(part);
    if (next == sentence.size()) break;
    html += code ? "</code>" : "<code>";
    code = !code;
    at = next + 1;
  }
  return code ? html + "</code>" : html;
}

namespace {

constexpr std::array statement_words{
    "system",  "source",    "dimensionless", "param",       "coord",   "let",   "input",   "frame",    "point",
    "body",    "gravity",   "spring",        "damper",      "torsion", "force", "torque",  "friction", "constraint",
    "note",    "gauge",     "reaction",      "contact",     "impact",  "event", "start",   "run",      "output",
    "sweep",   "draw",      "independent",   "path",        "rates",   "field", "density", "expect",   "claim",
    "kinetic", "potential", "lagrangian",    "dissipation", "T",       "V",     "U",       "L",        "D"};

// Where a comment begins: a # that stands in no quotation.
std::size_t comment_start(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted) return i;
  }
  return line.size();
}

std::string line_html(std::string_view line) {
  const std::size_t comment = comment_start(line);
  const std::string_view statement = line.substr(0, comment);
  const std::size_t word = std::min(statement.find_first_of(" \t"), statement.size());
  const bool known =
      std::find(statement_words.begin(), statement_words.end(), statement.substr(0, word)) != statement_words.end();
  std::string html = known ? fmt::format("<span class=\"word\">{}</span>", statement.substr(0, word))
                           : escape_xml(statement.substr(0, word));
  html += escape_xml(statement.substr(word));
  if (comment < line.size()) html += fmt::format("<span class=\"comment\">{}</span>", escape_xml(line.substr(comment)));
  return html;
}

}  // namespace

std::string model_html(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  std::string html;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    html += line_html(text.substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return html;
}

}  // namespace maupertuis
