#include "lsp/open_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::app::lsp {

OpenText::OpenText(std::string uri, std::string text, int version, language::Encoding encoding,
                   const std::atomic<bool>* stop)
    : uri_(std::move(uri)), text_(std::move(text)), version_(version), encoding_(encoding), stop_(stop) {}

void OpenText::forget() {
  positions_.reset();
  document_.reset();
}

bool OpenText::change(const Json& changes, int version) {
  if (!changes.is_array()) return false;
  for (const Json& change : changes) {
    if (!change.is_object() || !change.contains("text") || !change["text"].is_string()) return false;
    const std::string& text = change["text"].get_ref<const std::string&>();
    if (change.contains("range") && change["range"].is_object()) {
      const Span place = span(change["range"]);
      text_.replace(place.begin, place.end - place.begin, text);
    } else {
      text_ = text;
    }
    forget();
  }
  version_ = version;
  return true;
}

language::Document& OpenText::document() {
  if (!document_) {
    const std::size_t slash = uri_.find_last_of('/');
    std::string name = slash == std::string::npos ? uri_ : uri_.substr(slash + 1);
    document_.emplace(SourceText(std::move(name), too_large() ? std::string() : text_), Interrupt(stop_));
  }
  return *document_;
}

const language::Positions& OpenText::positions() {
  if (!positions_) positions_.emplace(text_, encoding_);
  return *positions_;
}

Diagnostics OpenText::diagnostics() { return too_large() ? lsp::too_large(*this) : document().diagnostics(); }

namespace {

Json position_json(language::Position position) { return {{"line", position.line}, {"character", position.character}}; }

std::uint32_t count_of(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return 0;
  const double value = object[key].get<double>();
  return value > 0 ? static_cast<std::uint32_t>(std::min(value, 4e9)) : 0;
}

}  // namespace

Json OpenText::range(Span span) {
  const language::Range range = positions().of(span);
  return {{"start", position_json(range.start)}, {"end", position_json(range.end)}};
}

std::uint32_t OpenText::offset(const Json& position) {
  return positions().offset({count_of(position, "line"), count_of(position, "character")});
}

Span OpenText::span(const Json& range) {
  if (!range.is_object() || !range.contains("start") || !range.contains("end")) return {};
  const std::uint32_t a = offset(range["start"]), b = offset(range["end"]);
  return {std::min(a, b), std::max(a, b), 0};
}

Diagnostics too_large(const OpenText& text) {
  Diagnostics diagnostics;
  diagnostics.warning(
      "W0818", Span{}, "this text is too large to be looked at while it is typed",
      fmt::format("It has {:.1f} MiB; up to 1 MiB every keystroke is followed by a reading of the whole.",
                  static_cast<double>(text.text().size()) / (1u << 20)),
      "`maup check` reads it from a file.");
  return diagnostics;
}

}  // namespace maupertuis::app::lsp
