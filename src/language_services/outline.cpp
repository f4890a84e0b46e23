#include <maupertuis/language_services.hpp>
#include <maupertuis/language_words.hpp>

#include "language_services/names_text.hpp"
#include "language_services/roles.hpp"

#include <fmt/format.h>

#include <algorithm>

/// What stands in a text as a whole: symbols, layout, tokens, folds.
namespace maupertuis::language {
namespace {

using syntax::TextToken;

SymbolKind kind_of_symbol(std::string_view word) {
  if (word == "system") return SymbolKind::System;
  if (word == "param") return SymbolKind::Parameter;
  if (word == "coord" || word == "independent" || word == "field") return SymbolKind::Coordinate;
  if (word == "let" || word == "rates" || word == "input") return SymbolKind::Definition;
  if (word == "frame" || word == "point" || word == "body") return SymbolKind::Place;
  if (word == "force" || word == "torque" || word == "spring" || word == "damper" || word == "gravity" ||
      word == "constraint" || word == "contact" || word == "friction")
    return SymbolKind::Force;
  return word == "event" ? SymbolKind::Event : SymbolKind::Statement;
}

/// The first line of a statement, shortened between characters.
std::string shortened(std::string_view text) {
  text = text.substr(0, text.find_first_of("\r\n"));
  constexpr std::size_t most = 60;
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  return std::string(text.substr(0, end)) + "…";
}

Span span_of(const syntax::TextReading& reading, const syntax::TextStatement& s) {
  return cover(reading.tokens[s.begin].span, reading.tokens[s.end - 1].span);
}

/// Of a list the part from this name to the next one.
Symbol symbol_of(const syntax::Name& name, const Symbol& statement, Document& document) {
  Symbol out;
  out.name = name.text;
  out.kind = statement.kind;
  out.name_span = out.span = name.span;
  if (const Declared* declared = document.roles().find(name.text); declared && declared->span == name.span)
    out.detail = shortened(item_of(*declared, document));
  return out;
}

TokenKind kind_of_name(NameKind kind) {
  switch (kind) {
    case NameKind::Parameter:
      return TokenKind::Parameter;
    case NameKind::Coordinate:
    case NameKind::Field:
    case NameKind::Space:
    case NameKind::Independent:
    case NameKind::Rate:
      return TokenKind::Coordinate;
    case NameKind::Definition:
    case NameKind::Input:
      return TokenKind::Definition;
    case NameKind::System:
    case NameKind::Frame:
    case NameKind::Point:
    case NameKind::Body:
    case NameKind::Constraint:
    case NameKind::Contact:
    case NameKind::Event:
    case NameKind::Reaction:
      return TokenKind::Place;
  }
  return TokenKind::Other;
}

TokenKind kind_of_token(const TextToken& token, std::size_t i, const Roles& roles) {
  if (token.kind == TextToken::Kind::Number) return TokenKind::Number;
  if (token.kind == TextToken::Kind::String) return TokenKind::String;
  if (token.kind == TextToken::Kind::Sign) return TokenKind::Operator;
  switch (roles.of(i)) {
    case WordRole::StatementWord:
    case WordRole::Word:
      return TokenKind::Keyword;
    case WordRole::Function:
      return TokenKind::Function;
    case WordRole::Predefined:
      return TokenKind::Definition;
    case WordRole::Unit:
      return TokenKind::Unit;
    case WordRole::Member:
      return TokenKind::Member;
    case WordRole::Name:
    case WordRole::Declaration:
      return kind_of_name(roles.declared(i)->kind);
    case WordRole::Unknown:
    case WordRole::Other:
      break;
  }
  return TokenKind::Other;
}

}  // namespace

std::vector<Symbol> symbols(Document& document) {
  const syntax::TextReading& reading = document.reading();
  std::vector<Symbol> out;
  for (const syntax::TextStatement& s : reading.statements) {
    if (s.begin == s.end) continue;
    Symbol symbol;
    symbol.kind = kind_of_symbol(reading.tokens[s.begin].text);
    symbol.span = span_of(reading, s);
    symbol.name = shortened(document.source().slice(symbol.span));
    symbol.name_span = reading.tokens[s.begin].span;
    if (s.declares.size() == 1) {
      symbol.detail = std::move(symbol.name);
      symbol.name = s.declares[0].text;
      symbol.name_span = s.declares[0].span;
    } else {
      for (const syntax::Name& name : s.declares) symbol.children.push_back(symbol_of(name, symbol, document));
    }
    out.push_back(std::move(symbol));
  }
  return out;
}

Formatting formatting(Document& document) {
  Diagnostics found;
  const syntax::SyntaxTree tree = syntax::parse(document.source(), found);
  for (const Diagnostic& d : found.items())
    if (d.severity == Severity::Error) return {{}, d};
  std::string text = syntax::format(tree, document.source());
  if (text == document.source().text()) return {};
  return {{{document.source().whole(), std::move(text)}}, std::nullopt};
}

std::vector<SemanticToken> semantic_tokens(Document& document) {
  const syntax::TextReading& reading = document.reading();
  const Roles& roles = document.roles();
  std::vector<SemanticToken> out;
  for (std::size_t i = 0; i < reading.tokens.size(); ++i) {
    const TextToken& token = reading.tokens[i];
    if (!out.empty() && token.span.begin < out.back().span.end) continue;  // the second token of θ̇ or of ½
    out.push_back({token.span, kind_of_token(token, i, roles), roles.of(i) == WordRole::Declaration});
  }
  for (const syntax::Comment& comment : reading.comments) out.push_back({comment.span, TokenKind::Comment, false});
  std::sort(out.begin(), out.end(),
            [](const SemanticToken& a, const SemanticToken& b) { return a.span.begin < b.span.begin; });
  return out;
}

std::vector<Span> folding(Document& document) {
  const syntax::TextReading& reading = document.reading();
  const SourceText& source = document.source();
  std::vector<Span> out;
  const auto add = [&](Span span) {
    if (source.locate(span.begin).line < source.locate(span.end).line) out.push_back(span);
  };
  for (const syntax::TextStatement& s : reading.statements)
    if (s.begin != s.end) add(span_of(reading, s));
  for (std::size_t i = 0; i < reading.comments.size();) {
    std::size_t end = i + 1;
    while (end < reading.comments.size() && source.locate(reading.comments[end].span.begin).line ==
                                                source.locate(reading.comments[end - 1].span.begin).line + 1)
      ++end;
    add(cover(reading.comments[i].span, reading.comments[end - 1].span));
    i = end;
  }
  std::sort(out.begin(), out.end(), [](Span a, Span b) { return a.begin < b.begin; });
  return out;
}

}  // namespace maupertuis::language
