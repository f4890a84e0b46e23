#pragma once
#include <maupertuis/syntax_tree.hpp>

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::syntax {

/// A word, number or sign of the text in its one canonical spelling: − is -, θ̇₁ is the name θ1 and the sign ',
/// x² is x ^ 2, ½ is 1 / 2 and √x is sqrt ( x ). `span` is where the original stands.
struct Token {
  enum class Kind : std::uint8_t { Number, Name, String, Sign, End };
  Kind kind = Kind::End;
  bool attached = false;    // no blank between the token before and this one
  bool line_start = false;  // first of its line
  bool field = false;       // names a field of the model: a bracket behind it opens a place. Known to printers alone
  Span span;
  std::string_view text;  // points into the source or into TokenList::spellings

  bool is(std::string_view sign_or_word) const {
    return (kind == Kind::Sign || kind == Kind::Name) && text == sign_or_word;
  }
  /// Stands for characters that cannot be read; the lexer has said so.
  bool unreadable() const { return kind == Kind::Sign && text.empty(); }
};

/// The tokens of one statement: [begin, end) of TokenList::tokens, and whether the lexer already complained about it.
struct StatementTokens {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool broken = false;
};

struct TokenList {
  std::vector<Token> tokens;
  std::vector<Comment> comments;
  std::deque<std::string> spellings;  // of tokens that differ from the source
};

}  // namespace maupertuis::syntax
