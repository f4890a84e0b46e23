#include <maupertuis/positions.hpp>

#include <algorithm>

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
  starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const bool pair = text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
    if (pair) ++i;
    if (pair || text_[i] == '\n' || text_[i] == '\r') starts_.push_back(static_cast<std::uint32_t>(i + 1));
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
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  Position position;
  position.line = static_cast<std::uint32_t>(after - starts_.begin()) - 1;
  const std::uint32_t end = std::min(offset, line_end(position.line));
  for (std::uint32_t i = starts_[position.line]; i < end;) {
    const std::uint32_t bytes = length_of(text_.substr(i));
    if (i + bytes > end) break;
    position.character += units_of(bytes, encoding_);
    i += bytes;
  }
  return position;
}

std::uint32_t Positions::offset(Position position) const {
  if (position.line >= starts_.size()) return static_cast<std::uint32_t>(text_.size());
  const std::uint32_t end = line_end(position.line);
  std::uint32_t counted = 0, i = starts_[position.line];
  while (i < end && counted < position.character) {
    const std::uint32_t bytes = length_of(text_.substr(i)), units = units_of(bytes, encoding_);
    if (counted + units > position.character) break;
    counted += units;
    i += bytes;
  }
  return i;
}

}  // namespace maupertuis::language
