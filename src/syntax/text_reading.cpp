#include <maupertuis/text_reading.hpp>

#include "syntax/declarations.hpp"
#include "syntax/lexer.hpp"
#include "syntax/statement_parser.hpp"

#include <algorithm>

namespace maupertuis::syntax {
namespace {

TextToken::Kind kind_of(const Token& token) {
  switch (token.kind) {
    case Token::Kind::Number:
      return TextToken::Kind::Number;
    case Token::Kind::Name:
      return TextToken::Kind::Name;
    case Token::Kind::String:
      return TextToken::Kind::String;
    case Token::Kind::Sign:
    case Token::Kind::End:
      break;
  }
  return token.unreadable() ? TextToken::Kind::Unreadable : TextToken::Kind::Sign;
}

/// What a statement declares, with the names of events, which stand in no formula.
std::vector<Name> declared_by(const TokenList& list, const StatementTokens& statement) {
  std::vector<Name> names = Declarations::of(list, statement);
  const bool named = list.tokens[statement.begin].is("event") || list.tokens[statement.begin].is("system");
  if (named && statement.begin + 1 < statement.end) {
    const Token& name = list.tokens[statement.begin + 1];
    if (name.kind == Token::Kind::Name) names.push_back({std::string(name.text), name.span});
  }
  return names;
}

constexpr std::size_t kMostBroken = 1000;  // statements; beyond them units are not marked

/// What the statements were read to hold as units.
std::vector<UnitExpression> units_of(const TokenList& list, const std::vector<StatementTokens>& statements,
                                     const SourceText& source) {
  Diagnostics unheard;
  const Declarations declarations(list, statements);
  std::vector<UnitExpression> units;
  const ParseContext context{list, source, declarations, unheard, &units};
  std::size_t broken = 0;
  for (const StatementTokens& statement : statements) {
    try {
      if (!statement.broken) StatementParser(context, statement).run();
    } catch (const Abandoned&) {  // `parse` tells it
      if (++broken == kMostBroken) break;
    }
  }
  return units;
}

/// A place that was read twice, once in vain, stands twice in `units`.
void mark_units(TextReading& reading, const std::vector<UnitExpression>& units) {
  const auto mark = [&](const UnitExpression::Factor& word) {
    const auto token = std::lower_bound(reading.tokens.begin(), reading.tokens.end(), word.span.begin,
                                        [](const TextToken& t, std::uint32_t place) { return t.span.begin < place; });
    if (token != reading.tokens.end() && token->span.begin == word.span.begin)
      token->unit = token->kind == TextToken::Kind::Name;
  };
  for (const UnitExpression& unit : units) {
    for (const UnitExpression::Factor& word : unit.factors) mark(word);
    if (reading.units.empty() || !(reading.units.back() == unit.span)) reading.units.push_back(unit.span);
  }
  bool inside = false;
  for (TextToken& token : reading.tokens) {
    if (token.is("[") || token.is("]")) inside = token.is("[");
    token.bracketed_unit = inside && token.kind == TextToken::Kind::Name;
    token.unit = token.unit || token.bracketed_unit;
  }
}

}  // namespace

TextReading read_text(const SourceText& source) {
  Diagnostics unheard;
  TextReading reading;
  const auto list = lex(source, unheard);
  if (!list) return reading;
  reading.comments = list->comments;
  reading.tokens.reserve(list->tokens.size());
  for (const Token& token : list->tokens) {
    TextToken copy;
    copy.kind = kind_of(token);
    copy.attached = token.attached;
    copy.span = token.span;
    copy.text = std::string(token.text);
    reading.tokens.push_back(std::move(copy));
  }
  const std::vector<StatementTokens> statements = split_statements(*list, source, unheard);
  for (const StatementTokens& statement : statements)
    reading.statements.push_back({statement.begin, statement.end, declared_by(*list, statement)});
  if (!statements.empty()) mark_units(reading, units_of(*list, statements, source));
  return reading;
}

}  // namespace maupertuis::syntax
