#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace maupertuis::syntax {

/// The letters of a name while it is read: composes marks (NFC), turns subscripts into digits, and tells the dots of
/// Newton's derivative from those of the spelling.
class WordLetters {
 public:
  /// Takes a character; false if it does not belong to a name.
  bool add(char32_t c);
  /// Removes the dots that mean a time derivative and returns their number: θ̇, ẍ_rod, φ̇s, θ1̇.
  int take_dots();
  std::string spelling() const;

 private:
  struct Letter {
    char32_t base;
    int dots = 0;
    std::string marks;  // other marks that do not compose
  };
  static void add_mark(Letter& letter, char32_t mark);
  std::vector<Letter> letters_;
};

}  // namespace maupertuis::syntax
