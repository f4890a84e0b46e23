#pragma once
#include <maupertuis/syntax_tree.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// A text as an editor sees it: words, signs and statements, whatever mistakes stand in it.
namespace maupertuis::syntax {

/// A word, number or sign in its canonical spelling: − is -, x² is x ^ 2 and ½ is 1 / 2, each of whose tokens has the
/// place of the one character.
struct TextToken {
  enum class Kind : std::uint8_t { Number, Name, String, Sign, Unreadable };
  Kind kind = Kind::Unreadable;
  bool attached = false;  // no blank between the token before and this one
  /// A Name that was read as a word of a unit. In a quantity place, `2 m`, it may still be the mass m: `system` decides
  /// by dimensions. Between square brackets it is a unit.
  bool unit = false, bracketed_unit = false;
  Span span;
  std::string text;

  bool is(std::string_view sign_or_word) const {
    return (kind == Kind::Sign || kind == Kind::Name) && text == sign_or_word;
  }
};

/// Tokens [begin, end), and the names that they declare.
struct TextStatement {
  std::size_t begin = 0, end = 0;
  std::vector<Name> declares;
};

struct TextReading {
  std::vector<TextToken> tokens;
  std::vector<TextStatement> statements;
  std::vector<Comment> comments;
  std::vector<Span>
      units;  // of the unit words of quantity places, all that follow one number; in the order of the text
};

/// Reads a text without a message about its mistakes, which `parse` tells. Empty where it is no text at all, or too
/// large. Cost: that of `parse`.
TextReading read_text(const SourceText& source);

}  // namespace maupertuis::syntax
