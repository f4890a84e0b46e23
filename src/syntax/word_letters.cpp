#include "syntax/word_letters.hpp"

#include "syntax/unicode.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::syntax {
namespace {

bool is_ascii_digit(char32_t c) { return c >= '0' && c <= '9'; }

}  // namespace

bool WordLetters::add(char32_t c) {
  const char32_t letter = canonical_letter(c);
  if (is_combining_mark(c) && !letters_.empty()) {
    add_mark(letters_.back(), c);
  } else if (const auto dotted = decompose_dots(letter)) {
    letters_.push_back({dotted->letter, dotted->dots, {}});
  } else if (const auto digit = subscript_digit(c)) {
    letters_.push_back({static_cast<char32_t>('0' + *digit), 0, {}});
  } else if (is_letter(letter) || letter == '_' || is_ascii_digit(letter)) {
    letters_.push_back({letter, 0, {}});
  } else {
    return false;
  }
  return true;
}

void WordLetters::add_mark(Letter& letter, char32_t mark) {
  if (const int dots = dots_of_mark(mark)) {
    letter.dots += dots;
  } else if (const auto composed = compose(letter.base, mark)) {
    letter.base = *composed;
  } else {
    append_utf8(letter.marks, mark);
  }
}

// Two dots over a Latin letter that begins a longer word (über) belong to the spelling.
int WordLetters::take_dots() {
  Letter& first = letters_.front();
  const bool greek = first.base >= 0x370 && first.base < 0x400;
  const bool suffix =
      letters_.size() == 1 || letters_[1].base == '_' ||
      std::all_of(letters_.begin() + 1, letters_.end(), [](const Letter& l) { return is_ascii_digit(l.base); });
  if (first.dots > 0 && (greek || suffix || first.dots != 2)) return std::exchange(first.dots, 0);
  Letter& last = letters_.back();
  if (last.dots > 0 && is_ascii_digit(last.base)) return std::exchange(last.dots, 0);
  return 0;
}

std::string WordLetters::spelling() const {
  constexpr char32_t marks[] = {0, 0x307, 0x308, 0x20DB, 0x20DC};
  std::string word;
  for (const Letter& letter : letters_) {
    const char32_t mark = marks[std::min(letter.dots, 4)];
    const auto composed = mark ? compose(letter.base, mark) : std::nullopt;
    append_utf8(word, composed.value_or(letter.base));
    if (mark && !composed) append_utf8(word, mark);
    word += letter.marks;
  }
  return word;
}

}  // namespace maupertuis::syntax
