#include <maupertuis/look_alikes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace maupertuis {
namespace {

struct LookAlike {
  char32_t letter;
  char latin;
};
constexpr LookAlike kLookAlikes[] = {
    // Greek; of the small letters omicron and lunate sigma alone, and the letter yot
    {0x37F, 'J'},
    {0x391, 'A'},
    {0x392, 'B'},
    {0x395, 'E'},
    {0x396, 'Z'},
    {0x397, 'H'},
    {0x399, 'I'},
    {0x39A, 'K'},
    {0x39C, 'M'},
    {0x39D, 'N'},
    {0x39F, 'O'},
    {0x3A1, 'P'},
    {0x3A4, 'T'},
    {0x3A5, 'Y'},
    {0x3A7, 'X'},
    {0x3BF, 'o'},
    {0x3F2, 'c'},
    {0x3F3, 'j'},
    {0x3F9, 'C'},
    // Cyrillic
    {0x405, 'S'},
    {0x406, 'I'},
    {0x408, 'J'},
    {0x410, 'A'},
    {0x412, 'B'},
    {0x415, 'E'},
    {0x41A, 'K'},
    {0x41C, 'M'},
    {0x41D, 'H'},
    {0x41E, 'O'},
    {0x420, 'P'},
    {0x421, 'C'},
    {0x422, 'T'},
    {0x423, 'Y'},
    {0x425, 'X'},
    {0x430, 'a'},
    {0x435, 'e'},
    {0x43E, 'o'},
    {0x440, 'p'},
    {0x441, 'c'},
    {0x443, 'y'},
    {0x445, 'x'},
    {0x455, 's'},
    {0x456, 'i'},
    {0x458, 'j'},
    {0x474, 'V'},
    {0x475, 'v'},
    {0x4AE, 'Y'},
    {0x4BA, 'h'},
    {0x4BB, 'h'},
    {0x4C0, 'I'},
    {0x4CF, 'l'},
    {0x501, 'd'},
    {0x50C, 'G'},
    {0x51A, 'Q'},
    {0x51B, 'q'},
    {0x51C, 'W'},
    {0x51D, 'w'},
};

struct Character {
  char32_t value;
  std::size_t length;  // bytes; 1 with value 0xFFFD for a byte that is no UTF-8
};

Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || at + length > text.size()) return {0xFFFD, 1};
  char32_t value = first & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0u) != 0x80u) return {0xFFFD, 1};
    value = (value << 6) | (byte(at + i) & 0x3Fu);
  }
  return {value, length};
}

/// Its Latin twin, or 0.
char latin_twin(char32_t c) {
  const auto* found =
      std::find_if(std::begin(kLookAlikes), std::end(kLookAlikes), [c](const LookAlike& l) { return l.letter == c; });
  return found == std::end(kLookAlikes) ? '\0' : found->latin;
}

bool turns_direction(char32_t c) {
  return c == 0x61C || c == 0x200E || c == 0x200F || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

bool is_control(char32_t c) { return (c < 0x20 && c != '\n' && c != '\t') || (c >= 0x7F && c < 0xA0); }

}  // namespace

std::string latin_look(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    const char twin = latin_twin(c.value);
    if (twin)
      out += twin;
    else
      out += text.substr(i, c.length);
    i += c.length;
  }
  return out;
}

std::string foreign_letter(std::string_view name) {
  const bool has_latin =
      std::any_of(name.begin(), name.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
  for (std::size_t i = 0; has_latin && i < name.size();) {
    const Character c = character_at(name, i);
    if (latin_twin(c.value))
      return fmt::format("`{}` (U+{:04X}) is a {} letter", name.substr(i, c.length),
                         static_cast<std::uint32_t>(c.value), c.value < 0x400 ? "Greek" : "Cyrillic");
    i += c.length;
  }
  return {};
}

std::string visible(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    if (c.value == 0xFFFD && c.length == 1)
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
    else if (is_control(c.value))
      out += fmt::format("\\x{:02x}", static_cast<std::uint32_t>(c.value));
    else if (turns_direction(c.value))
      out += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c.value));
    else
      out += text.substr(i, c.length);
    i += c.length;
  }
  return out;
}

}  // namespace maupertuis
