#include "syntax/declarations.hpp"

#include <maupertuis/language_words.hpp>

#include <algorithm>

namespace maupertuis::syntax {
namespace {

using NameKind = Declarations::Kind;

struct Declared {
  Name name;
  NameKind kind;
};

Name name_of(const Token& token) { return {std::string(token.text), token.span}; }

// param, coord, let, rates: the names at depth 0 that stand before `=`, `:` or `,` and after the first word or a comma.
void scan_list(const TokenList& list, const StatementTokens& statement, NameKind kind, std::vector<Declared>& found) {
  int depth = 0;
  std::size_t unnamed = found.size();  // coord x, y : length — the kind comes after the names
  for (std::size_t i = statement.begin + 1; i < statement.end; ++i) {
    const Token& token = list.tokens[i];
    if (token.is("(") || token.is("[")) ++depth;
    if (token.is(")") || token.is("]")) --depth;
    const bool first = i == statement.begin + 1 || list.tokens[i - 1].is(",");
    if (depth == 0 && first && token.kind == Token::Kind::Name) found.push_back({name_of(token), kind});
    if (kind == NameKind::Coordinate && token.is(":")) {
      const bool angle = i + 1 < statement.end && list.tokens[i + 1].is("angle");
      for (; unnamed < found.size(); ++unnamed) found[unnamed].kind = angle ? NameKind::Angle : NameKind::Coordinate;
    }
  }
}

void scan(const TokenList& list, const StatementTokens& statement, std::vector<Declared>& found) {
  const Token& first = list.tokens[statement.begin];
  if (first.is("param")) return scan_list(list, statement, NameKind::Parameter, found);
  if (first.is("coord")) return scan_list(list, statement, NameKind::Coordinate, found);
  if (first.is("let") || first.is("rates")) return scan_list(list, statement, NameKind::Definition, found);
  const NameKind kind = first.is("input")                                            ? NameKind::Input
                        : first.is("frame") || first.is("point") || first.is("body") ? NameKind::Place
                        : first.is("field")                                          ? NameKind::Field
                        : first.is("independent")                                    ? NameKind::Parameter
                                                                                     : NameKind::None;
  if (kind == NameKind::None || statement.begin + 1 >= statement.end) return;
  const auto add = [&](std::size_t i) {
    if (i < statement.end && list.tokens[i].kind == Token::Kind::Name) found.push_back({name_of(list.tokens[i]), kind});
  };
  add(statement.begin + 1);
  if (kind != NameKind::Field) return;
  bool variables = false;  // field a(x), b(x, y) : …
  for (std::size_t i = statement.begin + 2; i < statement.end && !list.tokens[i].is(":"); ++i) {
    if (list.tokens[i].is("(") || list.tokens[i].is(")")) variables = list.tokens[i].is("(");
    if (list.tokens[i].kind != Token::Kind::Name) continue;
    found.push_back({name_of(list.tokens[i]), variables ? NameKind::Space : NameKind::Field});
  }
}

}  // namespace

Declarations::Declarations(const TokenList& list, const std::vector<StatementTokens>& statements) {
  std::vector<Declared> found;
  for (const StatementTokens& statement : statements) {
    scan(list, statement, found);
    const Token& first = list.tokens[statement.begin];
    dimensionless_ = dimensionless_ || first.is("dimensionless");
    for (std::size_t i = statement.begin + 1; first.is("field") && i < statement.end; ++i)
      complex_ = complex_ || (list.tokens[i].is("complex") && list.tokens[i - 1].is(":"));
    const Token* second = statement.begin + 1 < statement.end ? &list.tokens[statement.begin + 1] : nullptr;
    if (first.is("independent") && second && second->kind == Token::Kind::Name) independent_ = second->text;
  }
  for (Declared& declared : found) names_.emplace(std::move(declared.name.text), declared.kind);
}

Declarations::Kind Declarations::kind(std::string_view name) const {
  const auto found = names_.find(std::string(name));
  if (found != names_.end()) return found->second;
  // u_x, u_xx of a field u
  const std::size_t underscore = name.find('_');
  if (underscore == std::string_view::npos || underscore == 0) return NameKind::None;
  const auto field = names_.find(std::string(name.substr(0, underscore)));
  return field != names_.end() && field->second == NameKind::Field ? NameKind::Field : NameKind::None;
}

std::vector<std::string> Declarations::names() const {
  std::vector<std::string> out;
  for (const auto& [name, kind] : names_) out.push_back(name);
  std::sort(out.begin(), out.end());  // messages do not depend on the order of a hash table
  return out;
}

std::vector<Name> Declarations::of(const TokenList& list, const StatementTokens& statement) {
  std::vector<Declared> found;
  scan(list, statement, found);
  const Token& first = list.tokens[statement.begin];
  const bool reaction = first.is("reaction");
  if (reaction || first.is("constraint") || first.is("contact")) {  // names that stand in no formula
    std::size_t at = statement.begin + 1;
    while (!reaction && at < statement.end && !list.tokens[at - 1].is("name")) ++at;
    if (at < statement.end && list.tokens[at].kind == Token::Kind::Name)
      found.push_back({name_of(list.tokens[at]), NameKind::None});
  }
  // Of a statement whose word is none, as Param, or is missing, x = l sin θ, what it was meant to declare.
  if (first.kind == Token::Kind::Name && !is_statement_word(first.text)) {
    const bool definition = statement.begin + 1 < statement.end && list.tokens[statement.begin + 1].is("=");
    if (definition)
      found.push_back({name_of(first), NameKind::None});
    else
      scan_list(list, statement, NameKind::Definition, found);
  }
  std::vector<Name> names;
  for (Declared& declared : found) names.push_back(std::move(declared.name));
  return names;
}

std::vector<Name> Declarations::lost_with(const TokenList& list, const StatementTokens& statement) {
  std::vector<Name> names = of(list, statement);
  const Token& first = list.tokens[statement.begin];
  const bool no_statement = first.kind == Token::Kind::Name && !is_statement_word(first.text);
  if (!first.is("param") && !first.is("let") && !no_statement) return names;
  const auto is_new = [&](const Name& name) {
    return std::none_of(names.begin(), names.end(), [&](const Name& known) { return known.text == name.text; });
  };
  for (std::size_t at = statement.begin + 1; at + 1 < statement.end; ++at)
    if (list.tokens[at].kind == Token::Kind::Name && list.tokens[at + 1].is("="))
      if (Name name = name_of(list.tokens[at]); is_new(name)) names.push_back(std::move(name));
  return names;
}

}  // namespace maupertuis::syntax
