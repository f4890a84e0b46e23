#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// Which text a place is in: 0 is the model, others are texts beside it, such as an option of a command line.
using SourceId = std::uint32_t;

/// A half-open range of bytes of one source text.
struct Span {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  SourceId source = 0;

  friend bool operator==(Span, Span) = default;
};

/// The smallest span that covers both; the first where they are in two texts.
inline Span cover(Span a, Span b) {
  if (a.source != b.source) return a;
  return {a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end, a.source};
}

/// A place as an editor counts it: both from 1, the column in characters (UTF-8 code points).
struct LineColumn {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

/// A text with its name and the table of its lines: a model, or what was said beside one. Spans in it have its number.
class SourceText {
 public:
  SourceText(std::string name, std::string text, SourceId id = 0);

  const std::string& name() const { return name_; }
  SourceId id() const { return id_; }
  /// All of it.
  Span whole() const { return {0, static_cast<std::uint32_t>(text_.size()), id_}; }
  std::string_view text() const { return text_; }
  std::string_view slice(Span span) const;

  LineColumn locate(std::uint32_t offset) const;
  /// The text of a line (counted from 1) without its line break; empty beyond the last line.
  std::string_view line(std::uint32_t number) const;
  std::uint32_t line_count() const { return static_cast<std::uint32_t>(starts_.size()); }

 private:
  std::string name_;
  std::string text_;
  SourceId id_;
  std::vector<std::uint32_t> starts_;  // [lines] offset of the first byte of each line
};

/// The texts that the places of one study are in: that of the model, and those beside it, text k with the number k + 1.
/// A view; the texts outlive it.
class SourceTexts {
 public:
  SourceTexts(const SourceText& model, std::span<const SourceText> beside = {}) : model_(&model), beside_(beside) {}

  /// Precondition: the place is in one of them.
  const SourceText& of(Span span) const;
  const SourceText& model() const { return *model_; }
  std::string_view slice(Span span) const { return of(span).slice(span); }
  LineColumn locate(Span span) const { return of(span).locate(span.begin); }

 private:
  const SourceText* model_;
  std::span<const SourceText> beside_;
};

}  // namespace maupertuis
