#include "report/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace maupertuis {

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '"') result += "&quot;";
    else if (c == '\0') result += "\uFFFD";
    else result += c;
  }
  return result;
}

std::string unit_html(std::string_view unit) {
  std::string result;
  for (std::size_t i = 0; i < unit.size();) {
    if (unit[i] != '^') {
      result += escape_html(unit.substr(i++, 1));
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
  std::string mantissa = escape_html(number.substr(0, plain ? number.size() : e));
  if (!mantissa.empty() && mantissa[0] == '-' && mantissa.size() > 1) mantissa.replace(0, 1, "−");
  if (plain) return mantissa;
  std::size_t end = e + 1;
  while (end < number.size() && (number[end] == '-' || number[end] == '+' || (number[end] >= '0' && number[end] <= '9'))) ++end;
  int exponent = 0;
  for (const char c : number.substr(e + 1, end - e - 1))
    if (c >= '0' && c <= '9') exponent = 10 * exponent + (c - '0');
  const std::string factor = mantissa == "1" ? "" : mantissa + " × ";
  return fmt::format("{}10<sup>{}{}</sup>{}", factor, number[e + 1] == '-' ? "−" : "", exponent, escape_html(number.substr(end)));
}

// ------------------------------------------------------------------------------------------------------ mathematics

namespace {

// The elements of a MathML fragment that stand side by side.
std::vector<std::string_view> children_of(std::string_view fragment) {
  std::vector<std::string_view> children;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t at = fragment.find('<'); at != std::string_view::npos; at = fragment.find('<', at + 1)) {
    const std::size_t end = fragment.find('>', at);
    if (end == std::string_view::npos) return {fragment};
    if (fragment[at + 1] == '/') --depth;
    else if (depth++ == 0) begin = at;
    if (fragment[end - 1] == '/') --depth;
    if (depth == 0) children.push_back(fragment.substr(begin, end + 1 - begin));
  }
  return children;
}

std::vector<std::string_view> terms_side_by_side(std::string_view fragment) {
  auto children = children_of(fragment);
  while (children.size() == 1 && children[0].rfind("<mrow>", 0) == 0)
    children = children_of(children[0].substr(6, children[0].size() - 13));
  return children;
}

bool is_sum_sign(std::string_view child) {
  if (child.rfind("<mo", 0) != 0) return false;
  const auto content = child.substr(child.find('>') + 1);
  return content == "+</mo>" || content == "−</mo>" || content == "-</mo>" || content == "&#x2212;</mo>" ||
         content == "&minus;</mo>";
}

// Terms with the sign in front of each.
std::vector<std::string> signed_terms(std::string_view fragment) {
  std::vector<std::string> terms;
  bool first = true;
  for (const std::string_view child : terms_side_by_side(fragment)) {
    const bool sign = is_sum_sign(child);
    if (first || sign) terms.emplace_back();
    if (sign && !first) terms.back() += "<mo form=\"infix\">" + std::string(child.substr(child.find('>') + 1));
    else terms.back() += child;
    first = false;
  }
  return terms;
}

constexpr std::size_t longest_in_one_piece = 3;  // terms

}  // namespace

std::string inline_math(std::string_view fragment) {
  return fragment.empty() ? std::string() : fmt::format("<math>{}</math>", fragment);
}

std::string display_math(std::string_view left, std::string_view right) {
  const std::string equals = left.empty() || right.empty() ? "" : "<mo>=</mo>";
  auto left_terms = signed_terms(left), right_terms = signed_terms(right);
  if (left_terms.size() + right_terms.size() <= longest_in_one_piece + 1)
    return fmt::format("<math displaystyle=\"true\"><mrow>{}{}{}</mrow></math>", left, equals, right);
  std::string html;
  const auto piece = [&](const std::string& content) {
    html += fmt::format("{}<math displaystyle=\"true\"><mrow>{}</mrow></math>", html.empty() ? "" : "<wbr>", content);
  };
  for (const auto& term : left_terms) piece(term);
  if (!right_terms.empty() && !equals.empty()) right_terms[0] = "<mo form=\"infix\">=</mo>" + right_terms[0];
  for (const auto& term : right_terms) piece(term);
  return html;
}

// ------------------------------------------------------------------------------------------------------------- text

std::string sentence_html(std::string_view sentence) {
  std::string html;
  bool code = false;
  for (std::size_t at = 0; at <= sentence.size();) {
    const std::size_t next = std::min(sentence.find('`', at), sentence.size());
    html += escape_html(sentence.substr(at, next - at));
    if (next == sentence.size()) break;
    html += code ? "</code>" : "<code>";
    code = !code;
    at = next + 1;
  }
  return code ? html + "</code>" : html;
}

namespace {

constexpr std::array statement_words{
    "system", "source", "dimensionless", "param", "coord", "let", "input", "frame", "point", "body", "gravity", "spring",
    "damper", "torsion", "force", "torque", "friction", "constraint", "reaction", "contact", "impact", "event", "start", "run",
    "output", "sweep", "draw", "independent", "path", "field", "density", "expect", "claim", "kinetic", "potential",
    "lagrangian", "dissipation", "T", "V", "U", "L", "D"};

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
  const bool known = std::find(statement_words.begin(), statement_words.end(), statement.substr(0, word)) != statement_words.end();
  std::string html = known ? fmt::format("<span class=\"word\">{}</span>", statement.substr(0, word)) : escape_html(statement.substr(0, word));
  html += escape_html(statement.substr(word));
  if (comment < line.size()) html += fmt::format("<span class=\"comment\">{}</span>", escape_html(line.substr(comment)));
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
