#include <maupertuis/positions.hpp>

#include <algorithm>
#include <iterator>

namespace maupertuis::language {
namespace {

/// The bytes of the character that begins at `text`, 1 where they are not UTF-8.
std::uint32_t length_of(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::uint32_t wanted = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
  if (wanted == 0 || wanted > text.size()) return 1;
  for (std::uint32_t i = 1; i < wanted; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u) return 1;
  return wanted;
}

/// What a character of so many bytes counts.
std::uint32_t units_of(std::uint32_t bytes, Encoding encoding) {
  switch (encoding) {
    case Encoding::Utf8:
      return bytes;
    case Encoding::Utf16:
      return bytes == 4 ? 2 : 1;
    case Encoding::Utf32:
      return 1;
  }
  return 1;
}

}  // namespace

Positions::Positions(std::string_view text, Encoding encoding) : text_(text), encoding_(encoding) {
  constexpr std::uint32_t distance = 1000;  // bytes between marks
  const auto size = static_cast<std::uint32_t>(text_.size());
  Mark here{0, {}};
  starts_.push_back(0), marks_.push_back(here);
  while (here.offset < size) {
    const std::string_view rest = text_.substr(here.offset);
    const bool pair = rest.substr(0, 2) == "\r\n";
    if (pair || rest[0] == '\n' || rest[0] == '\r') {
      here = {here.offset + (pair ? 2 : 1), {here.position.line + 1, 0}};
      starts_.push_back(here.offset), marks_.push_back(here);
      continue;
    }
    if (here.offset >= marks_.back().offset + distance) marks_.push_back(here);
    const std::uint32_t bytes = length_of(rest);
    here.offset += bytes, here.position.character += units_of(bytes, encoding_);
  }
}

std::uint32_t Positions::line_end(std::uint32_t line) const {
  if (line >= starts_.size()) return static_cast<std::uint32_t>(text_.size());
  std::uint32_t end = line + 1 < starts_.size() ? starts_[line + 1] : static_cast<std::uint32_t>(text_.size());
  if (line + 1 == starts_.size()) return end;
  if (text_[end - 1] == '\n') --end;
  if (end > starts_[line] && text_[end - 1] == '\r') --end;
  return end;
}

Position Positions::at(std::uint32_t offset) const {
  offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
  auto [i, position] = *std::prev(std::upper_bound(marks_.begin(), marks_.end(), offset,
                                                   [](std::uint32_t x, const Mark& m) { return x < m.offset; }));
  const std::uint32_t end = std::min(offset, line_end(position.line));
  while (i < end) {
    const std::uint32_t bytes = length_of(text_.substr(i));
    if (i + bytes > end) break;
    position.character += units_of(bytes, encoding_);
    i += bytes;
  }
  return position;
}

std::uint32_t Positions::offset(Position wanted) const {
  if (wanted.line >= starts_.size()) return static_cast<std::uint32_t>(text_.size());
  const std::uint32_t end = line_end(wanted.line);
  const auto is_before = [](Position x, const Mark& m) {
    return x.line != m.position.line ? x.line < m.position.line : x.character < m.position.character;
  };
  auto [i, position] = *std::prev(std::upper_bound(marks_.begin(), marks_.end(), wanted, is_before));
  while (i < end && position.character < wanted.character) {
    const std::uint32_t bytes = length_of(text_.substr(i)), units = units_of(bytes, encoding_);
    if (position.character + units > wanted.character) break;
    position.character += units;
    i += bytes;
  }
  return i;
}

}  // namespace maupertuis::language
