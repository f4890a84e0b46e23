#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// UTF-8 and the few properties of characters that the model language needs.
namespace maupertuis::syntax {

struct CodePoint {
  char32_t value = 0;
  std::uint32_t length = 0;  // bytes
};

/// The character at `offset`; nothing where the bytes are not UTF-8 (overlong forms and surrogates included).
std::optional<CodePoint> decode(std::string_view text, std::size_t offset);
void append_utf8(std::string& text, char32_t c);
/// The number of characters of a valid UTF-8 text.
std::size_t length_in_characters(std::string_view text);

bool is_letter(char32_t c);
bool is_blank(char32_t c);           // blanks, tabs, and the spaces that come with copies from a typeset page
bool is_combining_mark(char32_t c);  // U+0300 … U+036F, and the three and four dots above
std::optional<int> subscript_digit(char32_t c);
std::optional<char> superscript_sign_or_digit(char32_t c);  // '0' … '9', '-', '+'

/// The letter with the mark as one character (NFC), or nothing if Unicode has none.
std::optional<char32_t> compose(char32_t letter, char32_t mark);
/// A letter with a dot or two above, as one character: its plain letter and the number of dots.
struct Dotted {
  char32_t letter;
  int dots;
};
std::optional<Dotted> decompose_dots(char32_t c);
int dots_of_mark(char32_t mark);  // ̇ 1, ̈ 2, ⃛ 3, ⃜ 4, else 0
/// One character for those that look and mean the same: µ → μ, ϕ → φ, Ω (ohm) → Ω, Å (ångström) → Å.
char32_t canonical_letter(char32_t c);

}  // namespace maupertuis::syntax
