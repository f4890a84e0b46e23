#include "syntax/unicode.hpp"

#include <algorithm>
#include <iterator>

namespace maupertuis::syntax {
namespace {

struct Composition {
  std::uint16_t letter, mark, composed;
};
constexpr Composition kCompositions[] = {
#include "syntax/compositions.inc"
};

struct Range {
  char32_t first, last;
};
// Letters of the alphabets in which names are written; the signs × ÷ and the like among them are left out.
constexpr Range kLetters[] = {
    {'A', 'Z'},       {'a', 'z'},       {0xAA, 0xAA},     {0xB5, 0xB5},     {0xC0, 0xD6},     {0xD8, 0xF6},
    {0xF8, 0x2AF},    {0x370, 0x373},   {0x376, 0x377},   {0x37B, 0x37D},   {0x37F, 0x37F},   {0x386, 0x386},
    {0x388, 0x3FF},   {0x400, 0x481},   {0x48A, 0x52F},   {0x531, 0x556},   {0x561, 0x587},   {0x5D0, 0x5EA},
    {0x620, 0x64A},   {0x1E00, 0x1FFF}, {0x210B, 0x210B}, {0x210F, 0x2113}, {0x2126, 0x2126}, {0x212A, 0x212C},
    {0x2130, 0x2131}, {0x2133, 0x2133}, {0x2206, 0x2206}, {0x3041, 0x30FF}, {0x4E00, 0x9FFF}, {0xAC00, 0xD7A3},
};

bool is_continuation(unsigned char byte) { return (byte & 0xC0) == 0x80; }

}  // namespace

std::optional<CodePoint> decode(std::string_view text, std::size_t offset) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[offset + i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return CodePoint{first, 1};
  const std::uint32_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || offset + length > text.size()) return std::nullopt;
  char32_t value = first & (0x7Fu >> length);
  for (std::uint32_t i = 1; i < length; ++i) {
    if (!is_continuation(byte(i))) return std::nullopt;
    value = (value << 6) | (byte(i) & 0x3Fu);
  }
  constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < smallest[length] || surrogate || value > 0x10FFFF) return std::nullopt;
  return CodePoint{value, length};
}

void append_utf8(std::string& text, char32_t c) {
  const auto put = [&](char32_t byte) { text.push_back(static_cast<char>(byte)); };
  if (c < 0x80) return put(c);
  if (c < 0x800) return put(0xC0 | (c >> 6)), put(0x80 | (c & 0x3F));
  if (c < 0x10000) return put(0xE0 | (c >> 12)), put(0x80 | ((c >> 6) & 0x3F)), put(0x80 | (c & 0x3F));
  put(0xF0 | (c >> 18)), put(0x80 | ((c >> 12) & 0x3F)), put(0x80 | ((c >> 6) & 0x3F)), put(0x80 | (c & 0x3F));
}

std::size_t length_in_characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(static_cast<unsigned char>(c)); }));
}

bool is_letter(char32_t c) {
  const auto* range = std::find_if(std::begin(kLetters), std::end(kLetters), [&](Range r) { return c <= r.last; });
  return range != std::end(kLetters) && c >= range->first && c != 0x387 && c != 0x3F6;
}

bool is_blank(char32_t c) {
  return c == ' ' || c == '\t' || c == 0xA0 || (c >= 0x2000 && c <= 0x200A) || c == 0x202F || c == 0x205F ||
         c == 0x3000;
}

bool is_combining_mark(char32_t c) { return (c >= 0x300 && c <= 0x36F) || c == 0x20DB || c == 0x20DC || c == 0x20D7; }

std::optional<int> subscript_digit(char32_t c) {
  if (c < 0x2080 || c > 0x2089) return std::nullopt;
  return static_cast<int>(c - 0x2080);
}

std::optional<char> superscript_sign_or_digit(char32_t c) {
  switch (c) {
    case 0xB9:
      return '1';
    case 0xB2:
      return '2';
    case 0xB3:
      return '3';
    case 0x207A:
      return '+';
    case 0x207B:
      return '-';
    default:
      break;
  }
  if (c == 0x2070 || (c >= 0x2074 && c <= 0x2079)) return static_cast<char>('0' + (c - 0x2070));
  return std::nullopt;
}

std::optional<char32_t> compose(char32_t letter, char32_t mark) {
  const auto* found = std::lower_bound(std::begin(kCompositions), std::end(kCompositions),
                                       Composition{static_cast<std::uint16_t>(std::min<char32_t>(letter, 0xFFFF)),
                                                   static_cast<std::uint16_t>(std::min<char32_t>(mark, 0xFFFF)), 0},
                                       [](const Composition& a, const Composition& b) {
                                         return a.letter != b.letter ? a.letter < b.letter : a.mark < b.mark;
                                       });
  if (found == std::end(kCompositions) || found->letter != letter || found->mark != mark) return std::nullopt;
  return found->composed;
}

std::optional<Dotted> decompose_dots(char32_t c) {
  if (c < 0xC0) return std::nullopt;
  for (const Composition& entry : kCompositions) {
    if (entry.composed == c && dots_of_mark(entry.mark) > 0) return Dotted{entry.letter, dots_of_mark(entry.mark)};
  }
  return std::nullopt;
}

int dots_of_mark(char32_t mark) {
  switch (mark) {
    case 0x307:
      return 1;
    case 0x308:
      return 2;
    case 0x20DB:
      return 3;
    case 0x20DC:
      return 4;
    default:
      return 0;
  }
}

char32_t canonical_letter(char32_t c) {
  switch (c) {
    case 0xB5:
      return 0x3BC;  // micro sign
    case 0x3D5:
      return 0x3C6;  // phi symbol
    case 0x2126:
      return 0x3A9;  // ohm sign
    case 0x212A:
      return 'K';  // kelvin sign
    case 0x212B:
      return 0xC5;  // ångström sign
    case 0x2206:
      return 0x394;  // increment
    default:
      return c;
  }
}

}  // namespace maupertuis::syntax
