#pragma once
#include <span>
#include <string>
#include <string_view>

namespace maupertuis::syntax {

/// What a word that is no name was probably meant to be, and why it is not read so.
struct Spelling {
  std::string text;    // `m g l` for mgl, `sin θ` for sinθ, `θ'` for thetadot; empty: no reading was found
  std::string reason;  // a sentence
};

/// Readings of `word` that the names of the model allow: names and functions without blanks between them, derivatives
/// in words, functions of other languages. For messages; a word that is a name itself is none of its business.
Spelling right_spelling(std::string_view word, std::span<const std::string> names);

}  // namespace maupertuis::syntax
