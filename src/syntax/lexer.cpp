#include "syntax/lexer.hpp"

#include "syntax/latex_habits.hpp"
#include "syntax/unicode.hpp"
#include "syntax/word_letters.hpp"
#include "syntax/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace maupertuis::syntax {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kMostTokens = 1'000'000;
constexpr std::size_t kMostMessages = 100;
constexpr std::size_t kLongestWord = 200;  // bytes of a name or number
constexpr int kMostNestedRoots = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether the leading digit stands between 1e-307 and 1e307; zero is fine.
bool within_range(const std::string& number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = std::min(number.find('.'), e);
  const std::size_t leading = number.find_first_of("123456789");
  if (leading >= e) return true;
  long exponent = 0;
  if (e < number.size()) {
    for (char c : number.substr(e + 1)) {
      if (is_digit(c)) exponent = std::min(exponent * 10 + (c - '0'), 100'000L);
    }
    if (number[e + 1] == '-') exponent = -exponent;
  }
  const long magnitude = exponent + static_cast<long>(point) - static_cast<long>(leading) - (leading < point ? 1 : 0);
  return magnitude >= -307 && magnitude < 308;
}

struct Fraction {
  char32_t sign;
  std::string_view numerator, denominator;
};
constexpr std::array kFractions = {
    Fraction{0xBC, "1", "4"},   Fraction{0xBD, "1", "2"},   Fraction{0xBE, "3", "4"},   Fraction{0x2153, "1", "3"},
    Fraction{0x2154, "2", "3"}, Fraction{0x2155, "1", "5"}, Fraction{0x2156, "2", "5"}, Fraction{0x2157, "3", "5"},
    Fraction{0x2158, "4", "5"}, Fraction{0x2159, "1", "6"}, Fraction{0x215A, "5", "6"}, Fraction{0x215B, "1", "8"},
    Fraction{0x215C, "3", "8"}, Fraction{0x215D, "5", "8"}, Fraction{0x215E, "7", "8"},
};

struct Spelling {
  std::string_view written, canonical;
};
// Longest first where one begins another. An empty canonical spelling: see complain_about_sign.
constexpr std::array kSigns = {
    Spelling{"+/-", "±"}, Spelling{"**", ""},   Spelling{":=", ""},   Spelling{"//", ""},   Spelling{"==", ""},
    Spelling{"!=", ""},   Spelling{"..", ".."}, Spelling{"+=", "+="}, Spelling{"<=", "<="}, Spelling{">=", ">="},
    Spelling{"≤", "<="},  Spelling{"≥", ">="},  Spelling{"−", "-"},   Spelling{"+", "+"},   Spelling{"-", "-"},
    Spelling{"*", "*"},   Spelling{"/", "/"},   Spelling{"^", "^"},   Spelling{"(", "("},   Spelling{")", ")"},
    Spelling{"[", "["},   Spelling{"]", "]"},   Spelling{",", ","},   Spelling{":", ":"},   Spelling{"=", "="},
    Spelling{"<", "<"},   Spelling{">", ">"},   Spelling{"'", "'"},   Spelling{"′", "'"},   Spelling{"’", "'"},
    Spelling{".", "."},   Spelling{"±", "±"},   Spelling{"·", "·"},   Spelling{"⋅", "·"},   Spelling{"\u0387", "·"},
    Spelling{"×", "×"},   Spelling{"∙", "·"},   Spelling{"∗", "*"},   Spelling{"÷", "/"},   Spelling{"∕", "/"},
    Spelling{"´", "'"},   Spelling{"ʹ", "'"},   Spelling{"‘", "'"},
};

// The mark that ends a text which begins with this one; empty for other characters.
constexpr std::string_view closing_mark(char32_t opening) {
  switch (opening) {
    case U'"':
      return "\"";
    case U'“':
    case U'”':
      return "”";
    case U'„':
      return "“";
    case U'«':
      return "»";
    default:
      return {};
  }
}

// ʹ is a letter to Unicode.
constexpr bool is_prime_letter(char32_t c) { return c == U'ʹ'; }

struct Advice {
  std::string_view written, message, help;
};
constexpr std::array kAdvice = {
    Advice{":=", "`:=` is not a sign of the language", "A definition is written with `=`: let a = …."},
    Advice{"%", "`%` is not a sign of the language", "A comment begins with `#`; the unit is percent."},
    Advice{"//", "`//` is not a sign of the language", "A comment begins with `#`."},
    Advice{"==", "`==` is not a sign of the language", "An equation is written with one `=`."},
    Advice{"!=", "`!=` is not a sign of the language", "Conditions use < <= > >= and or."},
    Advice{";", "`;` does not separate statements", "Write one statement a line."},
    Advice{"{", "`{` is not a sign of the language", "Group with round brackets; units stand in square ones."},
    Advice{"}", "`}` is not a sign of the language", "Group with round brackets; units stand in square ones."},
    Advice{"–", "`–` is a dash, not a minus sign", "Type `-`."},
    Advice{"—", "`—` is a dash, not a minus sign", "Type `-`."},
    Advice{"&", "`&` is not a sign of the language", "Conditions are joined by `and`."},
    Advice{"|", "`|` is not a sign of the language", "The absolute value is abs(x), the norm of a vector norm(u)."},
    Advice{"∂", "`∂` is not a sign of the language",
           "Derivatives of fields are written u_x, u_xx; those of L the tool takes itself."},
};

/// CR alone, VT, FF, NEL and the separators of lines and paragraphs of Unicode.
bool ends_lines_elsewhere(char32_t c) {
  return c == '\r' || c == 0x0B || c == 0x0C || c == 0x85 || c == 0x2028 || c == 0x2029;
}

class Lexer {
 public:
  Lexer(const SourceText& source, Diagnostics& diagnostics)
      : text_(source.text()), id_(source.id()), diagnostics_(diagnostics) {}

  std::optional<TokenList> run() {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") position_ = 3;  // byte order mark
    while (skip_blanks()) {
      read_token();
      if (list_.tokens.size() > kMostTokens) return too_many();
    }
    return std::move(list_);
  }

 private:
  // Moves to the next character of a token; false at the end of the text.
  bool skip_blanks() {
    while (position_ < text_.size()) {
      const CodePoint c = *decode(text_, position_);
      if (c.value == '\n') {
        line_start_ = true;
        text_on_line_ = false;
      } else if (c.value == '#') {
        read_comment();
        continue;
      } else if (!is_blank(c.value) &&
                 !(c.value == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n')) {
        return true;
      }
      position_ += c.length;
    }
    return false;
  }

  // A line ends in LF or CR LF. What else editors show as its end is no sign of the language, in comments neither: a
  // statement after it would be lost.
  void read_comment() {
    std::size_t end = position_;
    while (end < text_.size() && text_[end] != '\n') {
      const CodePoint c = *decode(text_, end);
      if (ends_lines_elsewhere(c.value) && text_.substr(end, 2) != "\r\n") break;
      end += c.length;
    }
    const std::size_t next = end;
    while (text_[end - 1] == ' ' || text_[end - 1] == '\t' || text_[end - 1] == '\r') --end;
    list_.comments.push_back({std::string(text_.substr(position_, end - position_)), span_from(position_, end)});
    position_ = next;
  }

  void read_token() {
    const CodePoint c = *decode(text_, position_);
    if (is_digit(text_[position_]) || (c.value == '.' && is_digit_at(position_ + 1))) return read_number();
    if (is_letter(c.value) && !is_prime_letter(c.value)) return read_name();
    if (const std::string_view closing = closing_mark(c.value); !closing.empty()) return read_string(closing, c.length);
    if (c.value == '\\') return read_latex();
    if (c.value == U'√') return read_root();
    if (c.value == U'°') return read_degree();
    if (superscript_sign_or_digit(c.value)) return read_superscript();
    if (c.value == U'″' || c.value == U'‴') return read_primes(c.value == U'″' ? 2 : 3, c.length);
    for (const Fraction& fraction : kFractions) {
      if (c.value == fraction.sign) return read_fraction(fraction, c.length);
    }
    read_sign(c);
  }

  // ---------------------------------------------------------------------------------------------------- words

  void read_name() {
    const std::size_t begin = position_;
    WordLetters letters;
    while (position_ < text_.size()) {
      const CodePoint c = *decode(text_, position_);
      if (!letters.add(c.value)) break;
      position_ += c.length;
    }
    if (position_ - begin > kLongestWord) return too_long("name", begin);
    const int dots = letters.take_dots();
    emit(Token::Kind::Name, normalize_name(letters.spelling()), begin);
    for (int i = 0; i < dots; ++i) emit(Token::Kind::Sign, "'", begin, true);
  }

  // -------------------------------------------------------------------------------------------------- numbers

  void read_number() {
    const std::size_t begin = position_;
    skip_digits();
    if (position_ < text_.size() && text_[position_] == '.' && !starts_with("..")) {
      ++position_;
      if (!is_digit_at(position_)) return malformed(begin, "A decimal point stands between digits: 5.0, or 5 alone.");
      skip_digits();
    }
    read_exponent();
    if (position_ < text_.size() && text_[position_] == '.' && is_digit_at(position_ + 1)) {
      while (position_ < text_.size() && (is_digit(text_[position_]) || text_[position_] == '.')) ++position_;
      return malformed(begin, "A number has one decimal point.");
    }
    if (position_ - begin > kLongestWord) return too_long("number", begin);
    std::string digits(text_.substr(begin, position_ - begin));
    if (digits.front() == '.') digits = "0" + digits;
    if (!within_range(digits)) {
      complain("E0105", begin, fmt::format("the number {} is beyond the range of computation", digits),
               "Numbers are carried as double precision values, between 1e-307 and 1e308 in magnitude.",
               "Choose units in which the quantity is of moderate size.");
      return emit_unreadable(begin);
    }
    emit(Token::Kind::Number, std::move(digits), begin);
  }

  void read_exponent() {
    if (position_ >= text_.size() || (text_[position_] != 'e' && text_[position_] != 'E')) return;
    const bool sign = position_ + 1 < text_.size() && (text_[position_ + 1] == '+' || text_[position_ + 1] == '-');
    const std::size_t digits = position_ + (sign ? 2 : 1);
    if (!is_digit_at(digits)) return;
    position_ = digits;
    skip_digits();
  }

  // ½ m reads 1/2 m, and x^½ reads x^(1/2): brackets where the fraction does not begin a product.
  void read_fraction(const Fraction& fraction, std::uint32_t length) {
    const std::size_t begin = position_;
    position_ += length;
    const Token* before = line_continues() ? &list_.tokens.back() : nullptr;
    if (before && before->kind == Token::Kind::Number && before->span.end == begin) {
      return malformed(begin, "A number stands directly before the fraction: write 2.5 or (2 + 1/2).");
    }
    const bool function = before && before->kind == Token::Kind::Name && find_function(before->text);
    const bool ends_operand =
        before && !function && !is_clause_word(before->text) &&
        (before->kind != Token::Kind::Sign || before->is(")") || before->is("]") || before->is("'"));
    const bool after_operator =
        before && (before->is("*") || before->is("/") || before->is("^") || before->is("·") || before->is("×"));
    const auto next = position_ < text_.size() ? decode(text_, position_)->value : U' ';
    const bool powered = next == '^' || superscript_sign_or_digit(next);
    const bool brackets = ends_operand || after_operator || powered;
    if (brackets) emit(Token::Kind::Sign, "(", begin);
    emit(Token::Kind::Number, std::string(fraction.numerator), begin);
    emit(Token::Kind::Sign, "/", begin, true);
    emit(Token::Kind::Number, std::string(fraction.denominator), begin, true);
    if (brackets) emit(Token::Kind::Sign, ")", begin, true);
  }

  void read_superscript() {
    const std::size_t begin = position_;
    std::string exponent;
    while (position_ < text_.size()) {
      const CodePoint c = *decode(text_, position_);
      const auto digit = superscript_sign_or_digit(c.value);
      if (!digit) break;
      exponent.push_back(*digit);
      position_ += c.length;
    }
    const bool sign = !is_digit(exponent.front());
    if (!std::all_of(exponent.begin() + (sign ? 1 : 0), exponent.end(), is_digit) ||
        exponent.size() == (sign ? 1u : 0u) || exponent.size() > 6) {
      return malformed(begin, "A raised exponent is a whole number: x², x⁻¹.");
    }
    emit(Token::Kind::Sign, "^", begin);
    if (exponent.front() == '-') emit(Token::Kind::Sign, "-", begin, true);
    emit(Token::Kind::Number, exponent.substr(sign ? 1 : 0), begin, true);
  }

  // --------------------------------------------------------------------------------------- strings and signs

  void read_string(std::string_view closing, std::size_t opening) {
    const std::size_t begin = position_;
    const bool attached = line_continues() && list_.tokens.back().span.end == begin;
    const bool inner_quote = attached && text_on_line_;
    const bool typed_as_prime = attached && !inner_quote;
    const std::size_t line_end = std::min(text_.find('\n', begin), text_.size());
    const std::size_t end = text_.find(closing, begin + opening);
    if (attached || end >= line_end) {
      position_ = begin + opening;
      complain("E0104", begin,
               inner_quote ? "a quotation mark stands inside a text" : "this text has no closing quotation mark",
               "A text stands between two \" on one line.",
               typed_as_prime ? "For a second time derivative type two primes: θ''."
               : inner_quote  ? "Use ' or “ ” inside the text."
                              : "Close it with \".");
      if (!typed_as_prime) position_ = line_end;
      return emit_unreadable(begin);
    }
    position_ = end + closing.size();
    text_on_line_ = true;
    emit(Token::Kind::String, std::string(text_.substr(begin + opening, end - begin - opening)), begin);
  }

  // √x is sqrt(x): the root covers one number, one name with its primes and fields, or a bracket.
  void read_root() {
    const std::size_t begin = position_;
    position_ += std::string_view("√").size();
    emit(Token::Kind::Name, "sqrt", begin);
    while (position_ < text_.size() && text_[position_] == ' ') ++position_;
    if (position_ >= text_.size() || text_[position_] == '(' || text_[position_] == '\n') return;
    if (++nested_roots_ > kMostNestedRoots) return too_many_roots(begin);
    emit(Token::Kind::Sign, "(", begin, true);
    read_token();
    while (position_ < text_.size() && (text_[position_] == '\'' || (text_[position_] == '.' && !starts_with(".."))) &&
           list_.tokens.back().kind != Token::Kind::Number) {
      read_token();
      if (list_.tokens.back().is(".") && position_ < text_.size()) read_token();
    }
    emit(Token::Kind::Sign, ")", begin, true);
    --nested_roots_;
  }

  void too_many_roots(std::size_t begin) {
    while (starts_with("√")) position_ += std::string_view("√").size();
    malformed(begin, "Write the root with brackets: √(x).");
  }

  // \theta, \frac{a}{b}: told with what to write; the rest of the statement is read as if it stood there.
  void read_latex() {
    const std::size_t begin = position_;
    const LatexCommand command = latex_command(text_.substr(begin));
    position_ += command.length;
    complain("E0104", begin, fmt::format("`{}` is a command of LaTeX", text_.substr(begin, command.length)),
             "A model is plain text.", command.help);
    if (command.tokens.empty()) return emit_unreadable(begin);
    for (std::size_t i = 0; i < command.tokens.size(); ++i)
      emit(command.tokens[i].kind, command.tokens[i].text, begin, i > 0);
  }

  // What stands around `**`, with the right sign: x^2.
  std::string power_here() const {
    const auto is_word = [](char c) {
      return is_digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80);
    };
    std::size_t next = position_;
    while (next < text_.size() && text_[next] == ' ') ++next;
    std::size_t end = next;
    while (end < text_.size() && is_word(text_[end])) ++end;
    const bool base = line_continues() && (list_.tokens.back().kind == Token::Kind::Name ||
                                           list_.tokens.back().kind == Token::Kind::Number);
    if (!base || end == next || end - next > kLongestWord) return "x^2";
    return fmt::format("{}^{}", list_.tokens.back().text, text_.substr(next, end - next));
  }

  bool at_line_end() const {
    const std::size_t next = text_.find_first_not_of(" \t\r", position_);
    return next == std::string_view::npos || text_[next] == '\n' || text_[next] == '#';
  }

  void read_degree() {
    const std::size_t begin = position_;
    position_ += std::string_view("°").size();
    if (position_ < text_.size() && (text_[position_] == 'C' || text_[position_] == 'F')) {
      ++position_;
      complain("E0104", begin, fmt::format("{} is not a unit of the language", text_.substr(begin, position_ - begin)),
               "Its zero is not the zero of temperature, so that it cannot stand in products.",
               "Write temperatures in K.");
      return emit_unreadable(begin);
    }
    emit(Token::Kind::Name, "deg", begin);
  }

  void read_primes(int count, std::uint32_t length) {
    const std::size_t begin = position_;
    position_ += length;
    for (int i = 0; i < count; ++i) emit(Token::Kind::Sign, "'", begin, i > 0);
  }

  /// `expect constraints : p_y ; z`: there alone `;` is a sign, between generations.
  bool separates_generations(std::size_t at) const {
    const std::size_t line = text_.rfind('\n', at) + 1;  // 0 where there is none
    const std::size_t first = text_.find_first_not_of(" \t", line);
    constexpr std::string_view word = "expect";
    if (text_.substr(first, word.size()) != word) return false;
    const std::size_t second = text_.find_first_not_of(" \t", first + word.size());
    constexpr std::string_view kind = "constraints";
    return second > first + word.size() && text_.substr(second, kind.size()) == kind;
  }

  void read_sign(CodePoint c) {
    const std::size_t begin = position_;
    if (text_[begin] == ';' && separates_generations(begin)) {
      ++position_;
      return emit(Token::Kind::Sign, ";", begin);
    }
    const auto sign =
        std::find_if(kSigns.begin(), kSigns.end(), [&](const Spelling& s) { return starts_with(s.written); });
    if (sign != kSigns.end() && !sign->canonical.empty()) {
      position_ += sign->written.size();
      return emit(Token::Kind::Sign, std::string(sign->canonical), begin);
    }
    position_ += sign != kSigns.end() ? sign->written.size() : c.length;
    complain_about_sign(begin);
    if (text_.substr(begin, 2) == "//" || (text_[begin] == '%' && !line_continues()))
      position_ = std::min(text_.find('\n', begin), text_.size());
    emit_unreadable(begin);
  }

  void complain_about_sign(std::size_t begin) {
    const std::string_view written = text_.substr(begin, position_ - begin);
    const bool repeated =
        !list_.tokens.empty() && list_.tokens.back().unreadable() && list_.tokens.back().span.end == begin;
    if (repeated) return;
    if (written == "**")
      return complain("E0104", begin, "`**` is not a sign of the language", "",
                      fmt::format("Write {}: a power has the sign `^`.", power_here()));
    if (written == ";" && at_line_end())
      return complain("E0104", begin, "`;` ends no statement", "", "Leave it out: one statement a line.");
    const auto advice =
        std::find_if(kAdvice.begin(), kAdvice.end(), [&](const Advice& a) { return a.written == written; });
    if (advice != kAdvice.end()) {
      complain("E0104", begin, std::string(advice->message), "", std::string(advice->help));
      return;
    }
    const char32_t c = decode(text_, begin)->value;
    if (ends_lines_elsewhere(c))
      return complain("E0104", begin, fmt::format("a line ends here with U+{:04X}", static_cast<std::uint32_t>(c)),
                      "Lines of a model end in LF or CR LF; others would join the next line to this one.",
                      "Save the file with such ends of lines.");
    const bool visible = c > 0x20 && c != 0x7F && !(c >= 0x80 && c < 0xA0) && !(c >= 0x200B && c <= 0x200F) &&
                         !(c >= 0x2028 && c <= 0x202E) && c != 0xFEFF && !is_combining_mark(c);
    const std::string code = fmt::format("U+{:04X}", static_cast<std::uint32_t>(c));
    complain("E0104", begin,
             visible ? fmt::format("unexpected character `{}` ({})", written, code)
                     : fmt::format("unexpected invisible character ({})", code),
             "It has no meaning in the model language.", "Remove it.");
  }

  // ------------------------------------------------------------------------------------------------- plumbing

  bool is_digit_at(std::size_t i) const { return i < text_.size() && is_digit(text_[i]); }
  bool starts_with(std::string_view sign) const { return text_.substr(position_, sign.size()) == sign; }
  void skip_digits() {
    while (is_digit_at(position_)) ++position_;
  }
  bool line_continues() const { return !line_start_ && !list_.tokens.empty(); }

  Span span_from(std::size_t begin, std::size_t end) const {
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), id_};
  }

  void emit(Token::Kind kind, std::string text, std::size_t begin, bool inside = false) {
    Token token;
    token.kind = kind;
    token.attached = inside || (!list_.tokens.empty() && list_.tokens.back().span.end == begin && !line_start_);
    token.line_start = std::exchange(line_start_, false);
    token.span = span_from(begin, position_);
    const std::string_view written = text_.substr(begin, position_ - begin);
    token.text = written == text ? written : std::string_view(list_.spellings.emplace_back(std::move(text)));
    list_.tokens.push_back(token);
  }

  void emit_unreadable(std::size_t begin) {
    Token token;
    token.kind = Token::Kind::Sign;
    token.line_start = std::exchange(line_start_, false);
    token.span = span_from(begin, position_);
    list_.tokens.push_back(token);
  }

  void complain(std::string code, std::size_t begin, std::string message, std::string reason, std::string help) {
    if (++messages_ > kMostMessages) return;
    diagnostics_.error(std::move(code), span_from(begin, position_), std::move(message), std::move(reason),
                       std::move(help));
  }

  void malformed(std::size_t begin, std::string reason) {
    std::string written(text_.substr(begin, std::min<std::size_t>(position_ - begin, 40)));
    complain("E0105", begin, fmt::format("`{}` is not a number", written), std::move(reason), "");
    emit_unreadable(begin);
  }

  void too_long(std::string_view what, std::size_t begin) {
    complain("E0101", begin, fmt::format("this {} has {} bytes", what, position_ - begin),
             fmt::format("Names and numbers may have {} bytes.", kLongestWord), "");
    emit_unreadable(begin);
  }

  std::nullopt_t too_many() {
    diagnostics_.error("E0101", span_from(position_, position_), "the model text is too large",
                       fmt::format("It has more than {} words and signs.", kMostTokens), "Split the model.");
    return std::nullopt;
  }

  std::string_view text_;
  SourceId id_;
  Diagnostics& diagnostics_;
  TokenList list_;
  std::size_t position_ = 0;
  std::size_t messages_ = 0;
  int nested_roots_ = 0;
  bool line_start_ = true;
  bool text_on_line_ = false;  // a text in quotes stands before, on the same line
};

}  // namespace

std::optional<TokenList> lex(const SourceText& source, Diagnostics& diagnostics) {
  if (!check_text(source, diagnostics)) return std::nullopt;
  return Lexer(source, diagnostics).run();
}

}  // namespace maupertuis::syntax
