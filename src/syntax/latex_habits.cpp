#include "syntax/latex_habits.hpp"

#include "syntax/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::syntax {
namespace {

bool is_ascii_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// \theta, \sin, \{ : the backslash and the letters after it, or one sign.
std::string_view command_at(std::string_view text) {
  std::size_t end = 1;
  while (end < text.size() && is_ascii_letter(text[end])) ++end;
  return text.substr(0, end == 1 ? std::min<std::size_t>(2, text.size()) : end);
}

/// {…} with its brackets; empty where none opens here, or none closes on this line.
std::string_view group_at(std::string_view text) {
  if (text.empty() || text[0] != '{') return {};
  int depth = 0;
  for (std::size_t i = 0; i < text.size() && text[i] != '\n'; ++i) {
    depth += text[i] == '{' ? 1 : text[i] == '}' ? -1 : 0;
    if (depth == 0) return text.substr(0, i + 1);
  }
  return {};
}

/// \varphi and \phi are one letter; empty where the word is no letter.
std::string letter_of(std::string_view word) {
  if (word.substr(0, 3) == "var") word.remove_prefix(3);
  const std::string name = normalize_name(std::string(word));
  return name == word && name != "pi" ? "" : name;
}

std::string without_commands(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view command = text[i] == '\\' ? command_at(text.substr(i)) : std::string_view();
    if (command.empty()) {
      if (text[i] != '{' && text[i] != '}') out += text[i];
      ++i;
      continue;
    }
    const std::string letter = letter_of(command.substr(1));
    out += letter.empty() ? std::string(command.substr(1)) : letter;
    i += command.size();
  }
  return out;
}

/// \dot{\theta}, \ddot x: primes after the name.
LatexCommand dotted(std::string_view text, std::string_view command, int order) {
  std::size_t at = command.size();
  while (at < text.size() && text[at] == ' ') ++at;
  const std::string_view rest = text.substr(at);
  std::string_view of = group_at(rest);
  if (of.empty() && !rest.empty())
    of = rest[0] == '\\' ? command_at(rest) : rest.substr(0, is_ascii_letter(rest[0]) ? 1 : 0);
  const std::string name = without_commands(of);
  LatexCommand out;
  out.length = at + of.size();
  out.help = fmt::format("Write {}{}.", name.empty() ? "θ" : name, std::string(static_cast<std::size_t>(order), '\''));
  if (name.empty()) return out;
  out.tokens.push_back({Token::Kind::Name, normalize_name(name)});
  for (int i = 0; i < order; ++i) out.tokens.push_back({Token::Kind::Sign, "'"});
  return out;
}

/// In brackets, unless it is one word or number.
std::string operand_of(std::string_view group) {
  const std::string text = without_commands(group);
  return text.find_first_of(" +-*/^()") == std::string::npos ? text : "(" + text + ")";
}

LatexCommand quotient(std::string_view text, std::string_view command) {
  const std::string_view above = group_at(text.substr(command.size()));
  const std::string_view below = group_at(text.substr(command.size() + above.size()));
  if (above.empty() || below.empty()) return {command.size(), "Write a quotient with `/`: (a + b)/(c d).", {}};
  return {command.size() + above.size() + below.size(),
          fmt::format("Write {}/{}.", operand_of(above), operand_of(below)),
          {}};
}

}  // namespace

LatexCommand latex_command(std::string_view text) {
  const std::string_view command = command_at(text);
  const std::string_view word = command.substr(1);
  if (word == "dot") return dotted(text, command, 1);
  if (word == "ddot") return dotted(text, command, 2);
  if (word == "frac" || word == "dfrac" || word == "tfrac") return quotient(text, command);
  if (word == "cdot" || word == "times")
    return {command.size(), "Leave a blank between the factors, or write *.", {{Token::Kind::Sign, "*"}}};
  if (word == "sqrt") return {command.size(), "Write sqrt(x).", {}};
  if (word == "left" || word == "right") return {command.size(), "Leave it out: brackets are plain.", {}};
  if (const std::string letter = letter_of(word); !letter.empty()) {
    const bool plain = word.substr(0, 3) != "var";
    return {command.size(),
            plain ? fmt::format("Write {} or {}.", letter, word) : fmt::format("Write {}.", letter),
            {{Token::Kind::Name, letter}}};
  }
  if (find_function(word))
    return {command.size(), fmt::format("Write {}.", word), {{Token::Kind::Name, std::string(word)}}};
  if (const std::string_view function = function_of_habit(word); !function.empty())
    return {command.size(), fmt::format("Write {}.", function), {{Token::Kind::Name, std::string(function)}}};
  return {command.size(), "Formulas are plain text: θ, sin θ, x^2, a/b.", {}};
}

}  // namespace maupertuis::syntax
