#include <maupertuis/language_services.hpp>
#include <maupertuis/look_alikes.hpp>

#include "language_services/roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

/// Fixes: what the help of a message proposes, tried on the text.
namespace maupertuis::language {
namespace {

/// A change that may mend a mistake.
struct Proposal {
  std::string title;
  std::vector<TextEdit> edits;
};

std::string without_ticks(std::string_view text) {
  if (text.size() >= 2 && text.front() == '`' && text.back() == '`') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// The words of "auto, taylor, variational or stiff", and nothing for a text that is no such list.
std::vector<std::string> choices(std::string_view text) {
  std::vector<std::string> out;
  const std::size_t last = text.rfind(" or ");
  if (last == std::string_view::npos || text.find(", ") == std::string_view::npos) return {};
  std::string_view head = text.substr(0, last);
  while (!head.empty()) {
    const std::size_t comma = head.find(", ");
    out.emplace_back(head.substr(0, comma));
    head = comma == std::string_view::npos ? std::string_view() : head.substr(comma + 2);
  }
  out.emplace_back(text.substr(last + 4));
  const bool words =
      std::all_of(out.begin(), out.end(), [](const std::string& w) { return w.find(' ') == std::string::npos; });
  return words ? out : std::vector<std::string>();
}

/// Up to where an explanation begins: "θ' for a velocity", "60 deg if degrees are meant".
std::string_view before_explanation(std::string_view text) {
  for (const std::string_view end : {std::string_view(" for "), std::string_view(" if "),
                                     std::string_view(" in the place of "), std::string_view(" instead")})
    text = text.substr(0, text.find(end));
  while (!text.empty() && (text.back() == ' ' || text.back() == ',')) text.remove_suffix(1);
  return text;
}

/// "one statement a line": words of a sentence, and no text of a model, which is letters, signs or `in ticks`.
bool is_sentence(std::string_view text) {
  std::size_t words = 0, length = 0;
  for (const char c : text) {
    if (c != ' ' && (c < 'a' || c > 'z')) return false;
    length = c == ' ' ? 0 : length + 1;
    if (length == 4) ++words;
  }
  return words >= 2;
}

/// The texts that a proposal holds: one, or those between which it leaves the choice.
std::vector<std::string> readings(std::string_view proposed) {
  std::vector<std::string> out = choices(proposed);
  if (!out.empty()) return out;
  const auto add = [&](std::string_view text) {
    const std::string reading = without_ticks(before_explanation(text));
    const bool form = reading.empty() || reading.find("…") != std::string::npos ||  // with places to fill in
                      reading.find('`') != std::string::npos || is_sentence(text);  // words with `code` among them
    if (!form && std::find(out.begin(), out.end(), reading) == out.end()) out.push_back(reading);
  };
  const std::size_t either = proposed.find(" or ");
  add(proposed.substr(0, either));
  if (either != std::string_view::npos) add(proposed.substr(either + 4));
  return out;
}

/// The sentences of a help that begin with this word: what follows it, up to the end of the sentence.
std::vector<std::string_view> after_word(std::string_view help, std::string_view word) {
  std::vector<std::string_view> out;
  for (std::size_t at = help.find(word); at != std::string_view::npos; at = help.find(word, at + 1)) {
    const bool begins = at == 0 || help.substr(at < 2 ? 0 : at - 2, 2) == ". ";
    if (!begins) continue;
    const std::string_view rest = help.substr(at + word.size());
    std::size_t end = rest.find(". ");
    if (end == std::string_view::npos) end = rest.size() - (!rest.empty() && rest.back() == '.' ? 1 : 0);
    const std::size_t colon = rest.substr(0, end).find("; ");
    out.push_back(rest.substr(0, std::min(end, colon)));
  }
  return out;
}

class Proposals {
 public:
  Proposals(Document& document, const Diagnostic& diagnostic)
      : document_(document), diagnostic_(diagnostic), span_(*diagnostic.span) {}

  std::vector<Proposal> run() {
    const std::string_view help = diagnostic_.help;
    if (quotient_of_leibniz()) return std::move(out_);
    for (const std::string_view text : after_word(help, "Did you mean "))
      if (const std::string other = without_ticks(text.substr(0, text.find('?'))); may_be_misspelled(other))
        propose(other);
    for (const std::string_view word :
         {std::string_view("Write "), std::string_view("Type "), std::string_view("Close it with ")}) {
      for (std::string_view text : after_word(help, word)) {
        if (text.substr(0, 12) == "the missing ") {
          insert_at_end(without_ticks(text.substr(12)));
          continue;
        }
        for (const std::string& reading : readings(text)) propose(reading);
        propose_head(text);
      }
    }
    if (help.find("Remove the indentation") != std::string_view::npos) remove_indentation();
    const auto says = [&](std::string_view words) { return help.find(words) != std::string_view::npos; };
    if (says("Remove it") || says("Leave it out") || says("Remove the line") || says("Keep one of them") ||
        says("Leave one of them out"))
      remove();
    if (says("Leave the unit out")) add("Leave the unit out", with_blank_before(span_), "");
    if (says("Write it with Latin letters")) rename(latin_look(written()));
    of_code();
    return std::move(out_);
  }

 private:
  std::string_view written() const { return document_.source().slice(span_); }

  void add(std::string title, Span span, std::string text) {
    if (document_.source().slice(span) == text) return;
    out_.push_back({std::move(title), {{span, std::move(text)}}});
  }

  void propose(const std::string& text) {
    const Span place = place_of(text);
    const std::string_view replaced = document_.source().slice(place);
    const bool number = text[0] >= '0' && text[0] <= '9';
    // The 3 of `3 [m]` in the place of m is the help's own: a number is the author's to choose.
    if (number && replaced.find_first_of("0123456789") == std::string_view::npos) return;
    add(fmt::format("Write {}", text), place, text);
  }

  /// The words at fault; with the number before them where the proposal begins with it: 2 [m] for 2 m; with their
  /// arguments where the proposal has these in brackets too: cos(θ) for cosine(θ).
  Span place_of(const std::string& text) const {
    const std::string_view source = document_.source().text();
    Span place = span_;
    const std::string number = text.substr(0, text.find(' ')) + " ";
    if (text[0] >= '0' && text[0] <= '9' && source.substr(0, place.begin).size() >= number.size() &&
        source.substr(place.begin - number.size(), number.size()) == number)
      place.begin -= static_cast<std::uint32_t>(number.size());
    if (text[0] == '/' && place.begin > 0 && source[place.begin - 1] == '/') --place.begin;
    if (text.empty() || text.back() != ')' || written().find('(') != std::string_view::npos) return place;
    std::uint32_t end = span_.end;
    int depth = 0;
    do {
      if (end >= source.size() || source[end] == '\n' || (depth == 0 && source[end] != '(')) return place;
      depth += source[end] == '(' ? 1 : source[end] == ')' ? -1 : 0;
      ++end;
    } while (depth > 0);
    place.end = end;
    return place;
  }

  /// What a form such as `T += …` says of how the statement begins, up to its sign of equality.
  void propose_head(std::string_view form) {
    const std::size_t begin = form.find('`'), end = form.find(" …`");
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return;
    const std::string head(form.substr(begin + 1, end - begin - 1));
    const syntax::TextStatement* statement = statement_at();
    if (!statement || head.back() != '=' || statement->declares.size() > 1) return;
    const auto& tokens = document_.reading().tokens;
    for (std::size_t i = statement->begin; i < statement->end; ++i)
      if (tokens[i].is("=") || tokens[i].is("+="))
        return add(fmt::format("Write {} …", head), cover(tokens[statement->begin].span, tokens[i].span), head);
  }

  /// The statement that holds the span.
  const syntax::TextStatement* statement_at() {
    const syntax::TextReading& reading = document_.reading();
    for (const syntax::TextStatement& s : reading.statements)
      if (s.begin != s.end && reading.tokens[s.begin].span.begin <= span_.begin &&
          span_.end <= reading.tokens[s.end - 1].span.end)
        return &s;
    return nullptr;
  }

  Span with_blank_before(Span span) const { return {line_before(span.begin).begin, span.end, span.source}; }

  /// The name at the span, wherever it stands.
  void rename(const std::string& to) {
    Proposal proposal{fmt::format("Write {}", to), {}};
    for (const syntax::TextToken& token : document_.reading().tokens)
      if (token.kind == syntax::TextToken::Kind::Name && document_.source().slice(token.span) == written())
        proposal.edits.push_back({token.span, to});
    if (!proposal.edits.empty()) out_.push_back(std::move(proposal));
  }

  /// Where the statement ends that holds the span.
  Span end_of_statement() {
    const syntax::TextReading& reading = document_.reading();
    for (const syntax::TextStatement& s : reading.statements) {
      if (s.begin == s.end || reading.tokens[s.end - 1].span.end < span_.end) continue;
      const std::uint32_t end = reading.tokens[s.end - 1].span.end;
      return {end, end, span_.source};
    }
    return {span_.end, span_.end, span_.source};
  }

  void insert_at_end(const std::string& text) {
    add(fmt::format("Write the missing {}", text.substr(text[0] == ' ')), end_of_statement(), text);
  }

  Span line_before(std::uint32_t offset) const {
    const std::string_view text = document_.source().text();
    std::uint32_t begin = offset;
    while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
    return {begin, offset, span_.source};
  }

  void remove_indentation() { add("Remove the indentation", line_before(span_.begin), ""); }

  bool of_text() const { return diagnostic_.code[1] == '0' && diagnostic_.code[2] == '1'; }

  /// The words at fault, the statement that they are in, or of a statement that says several things the one at fault.
  void remove() {
    const std::string_view text = document_.source().text();
    if (of_text()) return add("Remove it", span_, "");
    const syntax::TextStatement* statement = statement_at();
    if (!statement) return;
    if (is_list(*statement)) return remove_of_list(*statement);
    const auto& tokens = document_.reading().tokens;
    Span whole = cover(tokens[statement->begin].span, tokens[statement->end - 1].span);
    while (whole.end < text.size() && text[whole.end] != '\n') ++whole.end;
    if (whole.end < text.size()) ++whole.end;
    add("Remove the statement", whole, "");
  }

  bool is_list(const syntax::TextStatement& statement) const {
    const auto& tokens = document_.reading().tokens;
    int depth = 0;
    for (std::size_t i = statement.begin; i < statement.end; ++i) {
      depth += tokens[i].is("(") || tokens[i].is("[") ? 1 : tokens[i].is(")") || tokens[i].is("]") ? -1 : 0;
      if (depth == 0 && tokens[i].is(",")) return true;
    }
    return false;
  }

  /// Of `param m = 1 kg, k = 5 N/m` the one that holds the span, with a comma. In `coord x, y : length` the kind is
  /// that of both, and stays.
  void remove_of_list(const syntax::TextStatement& statement) {
    const auto& tokens = document_.reading().tokens;
    std::size_t first = statement.begin + 1, end = first;  // tokens of the item that holds the span
    int depth = 0;
    for (; end < statement.end; ++end) {
      depth += tokens[end].is("(") || tokens[end].is("[") ? 1 : tokens[end].is(")") || tokens[end].is("]") ? -1 : 0;
      if (depth != 0 || !tokens[end].is(",")) continue;
      if (tokens[end].span.begin >= span_.end) break;
      first = end + 1;
    }
    if (first >= end) return;
    const bool begins = first == statement.begin + 1, kind = first + 1 < end && tokens[first + 1].is(":");
    const bool shares = kind && !begins && (first - 3 == statement.begin || tokens[first - 3].is(","));
    const std::uint32_t from = begins ? tokens[first].span.begin : tokens[first - 2].span.end;
    const std::uint32_t to = !begins                   ? tokens[shares ? first : end - 1].span.end
                             : end + 1 < statement.end ? tokens[end + 1].span.begin
                                                       : tokens[end - 1].span.end;
    add(fmt::format("Remove {}", written()), {from, to, span_.source}, "");
  }

  bool ends_line() const {
    const std::string_view rest = document_.source().text().substr(span_.end);
    const std::size_t next = rest.find_first_not_of(" \t\r");
    return next == std::string_view::npos || rest[next] == '\n' || rest[next] == '#';
  }

  /// What a code asks for in words that are no text to put in.
  void of_code() {
    const std::string& code = diagnostic_.code;
    const std::string text(written());
    if (code == "E0104") sign_of_another_language(text);
    if (code == "E0110") no_statement(text);
    if (code == "E0111") something_else_expected(text);
    if (code == "E0115")  // sin^-1 x: what most readers take it for
      propose("a" + text.substr(0, text.find_first_of(" ^⁻")));
    if (code == "E0129" && diagnostic_.help.rfind("Write " + text + " : ", 0) == 0)
      for (const char* kind : {" : angle", " : length", " : charge", " : number"}) insert(kind);
    if (code == "E0210" && statement_begins_with("gravity") && text.front() != '(')  // (0 -g) lacks a comma
      for (const char* zeros : {"(0, -", "(0, 0, -"}) propose(zeros + text + ")");
    if (code == "E0304") bare_number();
    if (code == "E0306") turns_a_second();
  }

  void sign_of_another_language(const std::string& text) {
    static constexpr std::pair<std::string_view, std::string_view> signs[] = {{"%", "#"},  {"//", "#"},  {":=", "="},
                                                                              {"==", "="}, {"**", "^"},  {"{", "("},
                                                                              {"}", ")"},  {"&", "and"}, {"&&", "and"}};
    for (const auto& [theirs, ours] : signs)
      if (text == theirs) propose(std::string(ours));
    if (text != ";" || ends_line()) return;
    const Span with_blanks{span_.begin, skip_blanks(span_.end), span_.source};
    if (!is_in_brackets()) add("Write the statements on lines of their own", with_blanks, "\n");
    add("Write ,", span_, ",");
  }

  /// Whether a bracket is open that the line began before the words at fault.
  bool is_in_brackets() const {
    const std::string_view before = document_.source().text().substr(0, span_.begin);
    const std::string_view line = before.substr(before.rfind('\n') + 1);  // all of it where there is none
    return std::count(line.begin(), line.end(), '(') > std::count(line.begin(), line.end(), ')');
  }

  /// x(0) = 1 m, or an equation that could be several things.
  void no_statement(const std::string& text) {
    if (after().substr(text.size()).rfind("(0)", 0) == 0)
      return add("Write start " + text, {span_.begin, span_.end + 3, span_.source}, "start " + text);
    if (diagnostic_.help.find("A definition is") != 0) return;
    const Span at{span_.begin, span_.begin, span_.source};
    for (const char* word : {"let ", "param ", "start "})
      add("Begin it with " + std::string(word, std::strlen(word) - 1), at, word);
  }

  /// gravity = (0, -g); start x(0) = 1 m; constraint x^2 + y^2 - l^2
  void something_else_expected(const std::string& text) {
    if (const std::string word = did_you_mean(text, expected_words()); !word.empty()) propose(word);
    if (text == "=" && statement_begins_with("gravity"))
      add("Leave = out", {span_.begin, skip_blanks(span_.end), span_.source}, "");
    if (after().rfind("(0)", 0) == 0 && statement_begins_with("start"))
      add("Leave (0) out", {span_.begin, span_.begin + 3, span_.source}, "");
    if (diagnostic_.message.find("expected `=`") != std::string::npos && statement_begins_with("constraint"))
      insert_at_end(" = 0");
  }

  /// `stiffness or length` of "expected `stiffness or length`, found …".
  std::vector<std::string> expected_words() const {
    const std::string& message = diagnostic_.message;
    const std::size_t begin = message.find("expected `"), end = message.find('`', begin + 10);
    if (begin != 0 || end == std::string::npos) return {};
    std::vector<std::string> words{""};
    for (const char c : message.substr(10, end - 10)) {
      if (c == ' ' || c == ',')
        words.emplace_back();
      else
        words.back() += c;
    }
    return words;
  }

  /// 50 Hz, where an angular velocity is meant.
  void turns_a_second() {
    const syntax::TextStatement* statement = statement_at();
    if (!statement) return;
    const auto& tokens = document_.reading().tokens;
    for (std::size_t i = statement->begin; i < statement->end; ++i)
      if (tokens[i].unit && tokens[i].text == "Hz") add("Write rev/s", tokens[i].span, "rev/s");
  }

  /// The text from the words at fault on.
  std::string_view after() const { return document_.source().text().substr(span_.begin); }

  std::uint32_t skip_blanks(std::uint32_t offset) const {
    const std::string_view text = document_.source().text();
    while (offset < text.size() && text[offset] == ' ') ++offset;
    return offset;
  }

  void insert(const std::string& text) {
    add(fmt::format("Write {}{}", written(), text), {span_.end, span_.end, span_.source}, text);
  }

  bool statement_begins_with(std::string_view word) {
    const syntax::TextStatement* statement = statement_at();
    return statement && document_.reading().tokens[statement->begin].is(word);
  }

  /// dθ/dt, of which each half is a name that is not declared.
  bool quotient_of_leibniz() {
    const std::string text(written());
    if (diagnostic_.code != "E0201" || text.size() < 2 || text[0] != 'd') return false;
    const std::string_view quotient = after().substr(text.size());
    if (quotient.rfind("/dt", 0) != 0) return false;
    // dr/dt^2: the square of the velocity, or an acceleration with a d²r above it that was forgotten.
    if (quotient.size() > 3 && (quotient[3] == '^' || quotient[3] == '\xc2')) return true;
    const std::string derivative = text.substr(1) + "'";
    add(fmt::format("Write {}", derivative), {span_.begin, span_.end + 3, span_.source}, derivative);
    return true;
  }

  /// Whether the word may be the other one, misspelled. One letter is not another one: s is no m, but R may be r. The r
  /// of `7.67 km/s / r` is a name of the model, and no unit.
  bool may_be_misspelled(const std::string& other) {
    const std::string text(written());
    if (diagnostic_.code == "E0301" && document_.roles().find(text)) return false;
    const auto lower = [](std::string word) {
      for (char& c : word)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
      return word;
    };
    const auto letters =
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
    return letters > 1 || lower(text) == lower(other);
  }

  /// The unit that a bare number lacks: "the duration of a run is a time (s), this is a bare number", "Give `m` its
  /// unit where it is declared, such as kg; …".
  std::string missing_unit() const {
    const std::string &message = diagnostic_.message, &help = diagnostic_.help;
    const std::size_t close = message.find("), this is a bare number"), open = message.rfind('(', close);
    if (close != std::string::npos && open != std::string::npos) return message.substr(open + 1, close - open - 1);
    const std::string before = "its unit where it is declared, such as ";
    const std::size_t at = help.find(before), begin = at + before.size();
    return at == std::string::npos ? "" : help.substr(begin, help.find(';', begin) - begin);
  }

  /// The number with its unit, where it stands or where its name is declared.
  void bare_number() {
    if (missing_unit().empty()) return;
    const std::string unit = " " + missing_unit(), text(written());
    if (!text.empty() && text.find_first_not_of("0123456789.e+-") == std::string::npos) return insert(unit);
    // Or the parameter that the help names, where it is declared: `name = number`.
    const std::vector<std::string_view> named = after_word(diagnostic_.help, "Give ");
    if (named.empty()) return;
    const std::string name = without_ticks(named[0].substr(0, named[0].find(' ')));
    const auto& tokens = document_.reading().tokens;
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i)
      if (tokens[i].is(name) && tokens[i + 1].is("=") && tokens[i + 2].kind == syntax::TextToken::Kind::Number)
        add(fmt::format("Write {} = {}{}", name, tokens[i + 2].text, unit),
            {tokens[i + 2].span.end, tokens[i + 2].span.end, span_.source}, unit);
  }

  Document& document_;
  const Diagnostic& diagnostic_;
  Span span_;
  std::vector<Proposal> out_;
};

std::size_t count(const Diagnostics& diagnostics, Severity severity) {
  const auto items = diagnostics.items();
  return static_cast<std::size_t>(
      std::count_if(items.begin(), items.end(), [&](const Diagnostic& d) { return d.severity == severity; }));
}

std::size_t count(const Diagnostics& diagnostics, const std::string& code) {
  const auto items = diagnostics.items();
  return static_cast<std::size_t>(
      std::count_if(items.begin(), items.end(), [&](const Diagnostic& d) { return d.code == code; }));
}

/// What is read one after the other: the grammar (01), names (02), units (03), …
std::string_view stage_of(const std::string& code) { return std::string_view(code).substr(1, 2); }

/// Where the texts of the edits stand once they are carried out.
std::vector<Span> inserted(std::vector<TextEdit> edits) {
  std::sort(edits.begin(), edits.end(), [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
  std::vector<Span> out;
  std::int64_t shift = 0;
  for (const TextEdit& edit : edits) {
    const auto begin = static_cast<std::uint32_t>(edit.span.begin + shift);
    out.push_back({begin, begin + static_cast<std::uint32_t>(edit.text.size()), edit.span.source});
    shift += static_cast<std::int64_t>(edit.text.size()) - (edit.span.end - edit.span.begin);
  }
  return out;
}

/// Whether all errors that are new are of what is read after `code`, and none is of what was put in: a unit elsewhere
/// where a name was wrong.
bool are_read_later(const Diagnostics& before, const Diagnostics& after, const std::string& code,
                    const std::vector<Span>& written) {
  return std::all_of(after.items().begin(), after.items().end(), [&](const Diagnostic& d) {
    if (d.severity != Severity::Error || count(after, d.code) <= count(before, d.code)) return true;
    const bool of_fix = d.span && std::any_of(written.begin(), written.end(),
                                              [&](Span s) { return s.begin <= d.span->begin && d.span->end <= s.end; });
    return !of_fix && stage_of(d.code) > stage_of(code);
  });
}

/// Whether the text with the edits has this mistake no longer, and no new one.
bool mends(Document& document, const Diagnostic& diagnostic, const std::vector<TextEdit>& edits) {
  Document mended(SourceText(document.source().name(), edited(document.source().text(), edits)), document.interrupt());
  const Diagnostics& before = document.diagnostics();
  const Diagnostics& after = mended.diagnostics();
  if (count(after, diagnostic.code) >= count(before, diagnostic.code)) return false;
  const std::size_t errors = count(before, Severity::Error), left = count(after, Severity::Error);
  if (diagnostic.severity != Severity::Error)
    return left <= errors && count(after, Severity::Warning) <= count(before, Severity::Warning);
  // What stands behind a mistake is read for the first time when that is mended, and may have one of its own.
  const bool word = diagnostic.code == "E0110" && diagnostic.help.rfind("Did you mean", 0) == 0;
  return left <= errors && (word || are_read_later(before, after, diagnostic.code, inserted(edits)));
}

}  // namespace

std::vector<Fix> fixes_of(Document& document, const Diagnostic& diagnostic) {
  std::vector<Fix> out;
  if (!diagnostic.span || diagnostic.span->source != document.source().id()) return out;
  for (Proposal& proposal : Proposals(document, diagnostic).run()) {
    document.interrupt().throw_if_asked();
    const bool known = std::any_of(out.begin(), out.end(), [&](const Fix& f) {
      return f.edits[0].span == proposal.edits[0].span && f.edits[0].text == proposal.edits[0].text;
    });
    if (!known && mends(document, diagnostic, proposal.edits))
      out.push_back({std::move(proposal.title), diagnostic.code, *diagnostic.span, std::move(proposal.edits)});
  }
  return out;
}

std::vector<Fix> fixes(Document& document, Span span) {
  std::vector<Fix> out;
  for (const Diagnostic& d : document.diagnostics().items()) {
    if (!d.span || d.span->source != document.source().id() || d.span->end < span.begin || span.end < d.span->begin)
      continue;
    for (Fix& fix : fixes_of(document, d)) out.push_back(std::move(fix));
  }
  return out;
}

}  // namespace maupertuis::language
