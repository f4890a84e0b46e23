#include <maupertuis/require.hpp>
#include <maupertuis/source.hpp>

#include <algorithm>

namespace maupertuis {

SourceText::SourceText(std::string name, std::string text, SourceId id)
    : name_(std::move(name)), text_(std::move(text)), id_(id) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // no column of the first line
  starts_.push_back(text_.starts_with(byte_order_mark) ? static_cast<std::uint32_t>(byte_order_mark.size()) : 0);
  for (std::size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') starts_.push_back(static_cast<std::uint32_t>(i + 1));
}

std::string_view SourceText::slice(Span span) const {
  const std::size_t begin = std::min<std::size_t>(span.begin, text_.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text_.size());
  return std::string_view(text_).substr(begin, end - begin);
}

LineColumn SourceText::locate(std::uint32_t offset) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto line = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(after - starts_.begin()));
  const std::uint32_t begin = starts_[line - 1];
  const std::size_t end = std::min<std::size_t>(offset, text_.size());
  std::uint32_t column = 1;
  for (std::size_t i = begin; i < end; ++i)
    if ((static_cast<unsigned char>(text_[i]) & 0xC0u) != 0x80u) ++column;  // continuation bytes do not count
  return {line, column};
}

std::string_view SourceText::line(std::uint32_t number) const {
  if (number == 0 || number > starts_.size()) return {};
  const std::size_t begin = starts_[number - 1];
  std::size_t end = number < starts_.size() ? starts_[number] - 1 : text_.size();
  if (end > begin && text_[end - 1] == '\r') --end;
  return std::string_view(text_).substr(begin, end - begin);
}

const SourceText& SourceTexts::of(Span span) const {
  if (span.source == model_->id()) return *model_;
  MAUP_REQUIRE(span.source >= 1 && span.source <= beside_.size());
  return beside_[span.source - 1];
}

}  // namespace maupertuis
