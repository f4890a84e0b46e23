#include "syntax/expression_parser.hpp"

#include <fmt/format.h>

/// The cursor of a statement: reading tokens, and saying what was expected.
namespace maupertuis::syntax {

ExpressionParser::ExpressionParser(const ParseContext& context, const StatementTokens& statement)
    : context_(context), begin_(statement.begin), index_(statement.begin), end_(statement.end) {
  const Span last = context.list.tokens[end_ - 1].span;
  end_token_.span = {last.end, last.end, last.source};
}

const Token& ExpressionParser::peek(std::size_t ahead) const {
  return index_ + ahead < end_ ? context_.list.tokens[index_ + ahead] : end_token_;
}

const Token& ExpressionParser::next() {
  const Token& token = peek();
  if (!at_end()) ++index_;
  return token;
}

bool ExpressionParser::accept(std::string_view sign_or_word) {
  if (!peek().is(sign_or_word)) return false;
  ++index_;
  return true;
}

const Token& ExpressionParser::expect(std::string_view sign_or_word, std::string_view after) {
  if (!peek().is(sign_or_word)) fail_expected(fmt::format("`{}` after {}", sign_or_word, after));
  return next();
}

// 9,81: a comma between digits, without blanks, where no list of numbers can stand.
void ExpressionParser::refuse_decimal_comma() {
  const bool comma = peek().is(",") && peek().attached && previous().kind == Token::Kind::Number &&
                     peek(1).kind == Token::Kind::Number && peek(1).attached;
  if (!comma) return;
  const Span span = cover(previous().span, peek(1).span);
  fail("E0105", span, fmt::format("`{}` is not a number", text_of(span)),
       "Numbers are written with a decimal point; a comma separates.",
       fmt::format("Write {}.{}.", previous().text, peek(1).text));
}

void ExpressionParser::expect_end() {
  if (at_end()) return;
  refuse_decimal_comma();
  const Token& token = peek();
  std::string help;
  if (token.is("[")) help = "A unit in square brackets stands directly after a number or a vector of numbers: 3 [J].";
  if (token.is("=")) help = "A statement has one `=`.";
  if (token.is("in") && previous().kind == Token::Kind::Number) help = "The unit is written `inch`.";
  if (token.is("<") || token.is(">") || token.is("<=") || token.is(">="))
    help = "Comparisons stand in piecewise( ) and contact.";
  if (token.line_start) help = "A continued line goes on where the line before ended; a new statement is not indented.";
  fail("E0111", token.span, fmt::format("the statement should end before {}", describe(token)), "", std::move(help));
}

std::string ExpressionParser::item_text(std::size_t ahead) const {
  int depth = 0;
  std::size_t last = index_ + ahead;
  if (last >= end_) return "…";
  for (std::size_t i = last; i < end_; ++i) {
    const Token& token = context_.list.tokens[i];
    if (depth == 0 && token.is(",")) break;
    depth += token.is("(") || token.is("[") ? 1 : token.is(")") || token.is("]") ? -1 : 0;
    last = i;
  }
  return text_of(cover(peek(ahead).span, context_.list.tokens[last].span));
}

std::string ExpressionParser::describe(const Token& token) {
  switch (token.kind) {
    case Token::Kind::End:
      return "the end of the statement";
    case Token::Kind::Number:
      return fmt::format("the number {}", token.text);
    case Token::Kind::String:
      return "a text in quotes";
    case Token::Kind::Name:
    case Token::Kind::Sign:
      break;
  }
  if (token.kind == Token::Kind::Name && is_clause_word(token.text)) return fmt::format("the word `{}`", token.text);
  return fmt::format("`{}`", token.text);
}

void ExpressionParser::fail(std::string code, Span span, std::string message, std::string reason, std::string help) {
  context_.diagnostics.error(std::move(code), span, std::move(message), std::move(reason), std::move(help));
  throw Abandoned{};
}

void ExpressionParser::fail_expected(std::string_view what, std::string help) {
  refuse_decimal_comma();
  fail("E0111", peek().span, fmt::format("expected {}, found {}", what, describe(peek())), "", std::move(help));
}

void ExpressionParser::warn(std::string code, Span span, std::string message, std::string reason, std::string help) {
  warnings_.push_back(
      {std::move(code), Severity::Warning, span, std::move(message), std::move(reason), std::move(help)});
}

void ExpressionParser::flush_warnings() {
  for (Diagnostic& w : warnings_) context_.diagnostics.warning(w.code, w.span, w.message, w.reason, w.help);
  warnings_.clear();
}

Name ExpressionParser::new_name(std::string_view what) {
  const Token& token = peek();
  if (token.kind != Token::Kind::Name) fail_expected(what);
  const bool function = find_function(token.text) != nullptr;
  const bool time = token.is("t") && context_.declarations.independent() == "t";
  if (function || is_clause_word(token.text) || time || token.is("pi")) {
    fail("E0112", token.span, fmt::format("`{}` cannot be a name", token.text),
         function         ? "It is a function of the language."
         : time           ? "It is the time."
         : token.is("pi") ? "It is the number π."
                          : "It is a word of the language that separates the parts of a statement.",
         fmt::format("Choose another name, for example {}1 or {}_0.", token.text, token.text));
  }
  if (peek(1).is("'")) {
    if (previous().is("system") && !peek(1).attached)
      fail("E0111", peek(1).span, "a prime opens no title", "A title stands between two \" on one line.",
           "Write system NAME \"Title\".");
    fail("E0111", cover(token.span, peek(1).span), fmt::format("`{}'` cannot be declared", token.text),
         "A prime is the time derivative of a name that is declared elsewhere.",
         fmt::format("Declare {}.", token.text));
  }
  next();
  return {std::string(token.text), token.span};
}

Name ExpressionParser::used_name(std::string_view what, std::string help) {
  const Token& token = peek();
  if (token.kind != Token::Kind::Name || is_clause_word(token.text)) fail_expected(what, std::move(help));
  next();
  return {std::string(token.text), token.span};
}

}  // namespace maupertuis::syntax
