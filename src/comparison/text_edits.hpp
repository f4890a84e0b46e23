#pragma once
#include <maupertuis/source.hpp>

#include <string>
#include <vector>

namespace maupertuis::comparison {

/// Changes of a text by spans of what it was.
class TextEdits {
 public:
  explicit TextEdits(const SourceText& source) : source_(source) {}

  void replace(Span span, std::string text) { edits_.push_back({span.begin, span.end, std::move(text)}); }
  /// The whole line, its comment too, where nothing else stands on it.
  void remove_line(Span span);
  /// A line of its own below the one that the span ends on.
  void insert_below(Span span, const std::string& text);
  /// A line at the end.
  void append(const std::string& line) { end_ += line + "\n"; }

  std::string applied();

 private:
  struct Edit {
    std::uint32_t begin, end;
    std::string text;
  };
  const SourceText& source_;
  std::vector<Edit> edits_;
  std::string end_;
};

}  // namespace maupertuis::comparison
