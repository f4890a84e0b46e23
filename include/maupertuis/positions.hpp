#pragma once
#include <maupertuis/source.hpp>

#include <cstdint>
#include <string_view>
#include <vector>

/// Places of a text as editors count them: lines and characters from 0, characters in units of an encoding.
namespace maupertuis::language {

enum class Encoding : std::uint8_t { Utf8, Utf16, Utf32 };

struct Position {
  std::uint32_t line = 0, character = 0;
  friend bool operator==(Position, Position) = default;
};
struct Range {
  Position start, end;
};

/// The lines of a text end by \n, \r\n or \r. Bytes that are not UTF-8 count as one character each.
/// A view; the text outlives it. Cost: a scan of the text once, of a thousand bytes at most a question.
class Positions {
 public:
  Positions(std::string_view text, Encoding encoding);

  Position at(std::uint32_t offset) const;
  Range of(Span span) const { return {at(span.begin), at(span.end)}; }
  /// Beyond the end of a line it is that end, beyond the last line the end of the text; within a character its
  /// beginning.
  std::uint32_t offset(Position position) const;
  std::uint32_t line_count() const { return static_cast<std::uint32_t>(starts_.size()); }
  /// Of a line, without what ends it.
  std::uint32_t line_end(std::uint32_t line) const;

 private:
  std::string_view text_;
  Encoding encoding_;
  /// What is known without counting: a place every thousand bytes of a long line.
  struct Mark {
    std::uint32_t offset;
    Position position;
  };
  std::vector<std::uint32_t> starts_;  // [lines]
  std::vector<Mark> marks_;            // in the order of the text; the beginning of each line is one
};

}  // namespace maupertuis::language
