#include "comparison/text_edits.hpp"

#include <algorithm>

namespace maupertuis::comparison {

void TextEdits::remove_line(Span span) {
  const std::string_view text = source_.text();
  std::uint32_t begin = span.begin, end = span.end;
  while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
  if (end < text.size() && text[end] == '#')
    while (end < text.size() && text[end] != '\n') ++end;
  const bool alone = (begin == 0 || text[begin - 1] == '\n') && (end == text.size() || text[end] == '\n');
  if (alone && end < text.size()) ++end;
  edits_.push_back({alone ? begin : span.begin, alone ? end : span.end, ""});
}

void TextEdits::insert_below(Span span, const std::string& text) {
  const std::size_t found = source_.text().find('\n', span.end);
  const auto end = static_cast<std::uint32_t>(found == std::string_view::npos ? source_.text().size() : found);
  edits_.push_back({end, end, "\n" + text});
}

std::string TextEdits::applied() {
  std::stable_sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  std::string out;
  std::uint32_t at = 0;
  for (const Edit& e : edits_) {
    if (e.begin > at) out += source_.text().substr(at, e.begin - at);
    out += e.text;
    at = std::max(at, e.end);
  }
  out += source_.text().substr(at);
  if (!out.empty() && out.back() != '\n') out += '\n';
  return out + end_;
}

}  // namespace maupertuis::comparison
