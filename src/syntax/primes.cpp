#include "syntax/layout.hpp"
#include "syntax/words.hpp"

/// dot( ) of one argument in the canonical spelling.
namespace maupertuis::syntax {
namespace {

using Tokens = std::span<const Token>;

// The index of the bracket that closes the one at `open`; a comma at its level is noted.
std::size_t closing(Tokens tokens, std::size_t open, bool* comma = nullptr) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    if (tokens[i].is("(") || tokens[i].is("[")) ++depth;
    if (tokens[i].is(")") || tokens[i].is("]")) --depth;
    if (comma && depth == 1 && tokens[i].is(",")) *comma = true;
    if (depth == 0) return i;
  }
  return tokens.size();
}

// Name { "." name } { "'" }, or one bracket { "'" }.
bool takes_prime(Tokens tokens) {
  std::size_t i = 0;
  if (tokens[0].is("(")) {
    i = closing(tokens, 0) + 1;
  } else if (tokens[0].kind == Token::Kind::Name && !find_function(tokens[0].text)) {
    for (i = 1; i + 1 < tokens.size() && tokens[i].is("."); i += 2) continue;
  } else {
    return false;
  }
  while (i < tokens.size() && tokens[i].is("'")) ++i;
  return i == tokens.size();
}

Token sign(std::string_view text, Span span) {
  Token token;
  token.kind = Token::Kind::Sign;
  token.text = text;
  token.span = span;
  return token;
}

void rewrite(Tokens tokens, std::vector<Token>& result) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const bool dot =
        tokens[i].kind == Token::Kind::Name && tokens[i].is("dot") && i + 1 < tokens.size() && tokens[i + 1].is("(");
    bool comma = false;
    const std::size_t close = dot ? closing(tokens, i + 1, &comma) : tokens.size();
    if (!dot || comma || close == tokens.size()) {
      result.push_back(tokens[i]);
      continue;
    }
    std::vector<Token> inner;
    rewrite(tokens.subspan(i + 2, close - i - 2), inner);
    const bool named = takes_prime(inner);
    const std::size_t first = result.size();
    if (!named) result.push_back(sign("(", tokens[i].span));
    result.insert(result.end(), inner.begin(), inner.end());
    if (!named) result.push_back(sign(")", tokens[close].span));
    result.push_back(sign("'", tokens[close].span));
    result[first].line_start = tokens[i].line_start;
    i = close;
  }
}

}  // namespace

std::vector<Token> with_primes(Tokens tokens) {
  std::vector<Token> result;
  result.reserve(tokens.size());
  rewrite(tokens, result);
  return result;
}

}  // namespace maupertuis::syntax
