#include "syntax/layout.hpp"

#include "syntax/words.hpp"

#include <algorithm>
#include <array>

/// Where blanks stand: around + - = : and words, nowhere around * / ^ and inside brackets.
namespace maupertuis::syntax {
namespace {

using namespace std::string_view_literals;

template <std::size_t N>
bool one_of(const Token& token, const std::array<std::string_view, N>& signs) {
  return token.kind == Token::Kind::Sign && std::find(signs.begin(), signs.end(), token.text) != signs.end();
}

bool is_bare_function(const Token& token) {
  const Function* function = token.kind == Token::Kind::Name ? find_function(token.text) : nullptr;
  return function && function->bare;
}

bool ends_operand(const Token& token) {
  return token.kind == Token::Kind::Number || token.kind == Token::Kind::String || token.is(")") || token.is("]") ||
         token.is("'") || (token.kind == Token::Kind::Name && !is_clause_word(token.text));
}

// A sign before an operand: at the start, after an operator, and after a word that begins a formula.
bool is_unary(std::span<const Token> tokens, std::size_t i) {
  if (!tokens[i].is("-") && !tokens[i].is("+")) return false;
  if (i == 0 || !ends_operand(tokens[i - 1])) return true;
  const bool first_word =
      i == 1 && tokens[0].kind == Token::Kind::Name && is_statement_word(tokens[0].text) && !energy_of(tokens[0].text);
  constexpr std::array openings = {"conserved"sv, "equation"sv, "integral"sv};
  const bool opening = i == 2 && (tokens[0].is("expect") || tokens[0].is("claim") || tokens[0].is("constraint")) &&
                       std::find(openings.begin(), openings.end(), tokens[1].text) != openings.end();
  const bool flux = tokens[0].is("expect") && i > 2 && tokens[1].is("current") && tokens[i - 1].is("flux");
  return first_word || opening || flux;
}

// sin, or the 2 of sin^2: what follows is its argument.
bool ends_function_head(std::span<const Token> tokens, std::size_t i) {
  if (is_bare_function(tokens[i])) return true;
  return i >= 2 && tokens[i].kind == Token::Kind::Number && tokens[i - 1].is("^") && is_bare_function(tokens[i - 2]);
}

bool opens_arguments(std::span<const Token> tokens, std::size_t i) {
  const Token& before = tokens[i - 1];
  if (ends_function_head(tokens, i - 1)) return true;
  if (before.kind != Token::Kind::Name) return false;
  if (find_function(before.text) || before.field) return true;
  const bool inertia = i >= 2 && tokens[i - 2].is("inertia") && (before.is("diag") || before.is("full"));
  const auto declares = [](std::span<const Token> before_colon) {
    return std::none_of(before_colon.begin(), before_colon.end(), [](const Token& t) { return t.is(":"); });
  };
  const bool field = tokens[0].is("field") && declares(tokens.first(i));
  return inertia || field;
}

}  // namespace

bool blank_before(std::span<const Token> tokens, std::size_t i) {
  constexpr std::array tight = {"*"sv, "/"sv, "^"sv, "."sv};
  constexpr std::array closing = {")"sv, "]"sv, ","sv, "'"sv};
  const Token& before = tokens[i - 1];
  const Token& token = tokens[i];
  if (one_of(token, tight) || one_of(before, tight) || one_of(token, closing) || before.is("(") || before.is("["))
    return false;
  if (is_unary(tokens, i - 1)) return false;
  if (token.is("(")) return !opens_arguments(tokens, i);
  const bool number_of_argument = i >= 2 && before.kind == Token::Kind::Number && token.kind == Token::Kind::Name &&
                                  !is_clause_word(token.text) && ends_function_head(tokens, i - 2);
  return !number_of_argument;
}

std::string lay_out(std::span<const Token> tokens, std::size_t begin) {
  std::string text;
  for (std::size_t i = begin; i < tokens.size(); ++i) {
    if (i > begin && blank_before(tokens, i)) text += ' ';
    const bool quoted = tokens[i].kind == Token::Kind::String;
    // “a "word" here” keeps its outer marks, since " would end it early.
    const bool inner = quoted && tokens[i].text.find('"') != std::string_view::npos;
    if (quoted) text += inner ? "“" : "\"";
    text += tokens[i].text;
    if (quoted) text += inner ? "”" : "\"";
  }
  return text;
}

}  // namespace maupertuis::syntax
