#pragma once
#include "json.hpp"

#include <maupertuis/interrupt.hpp>
#include <maupertuis/language_services.hpp>
#include <maupertuis/positions.hpp>

#include <atomic>
#include <optional>
#include <string>

namespace maupertuis::app::lsp {

/// A text that an editor holds open, in its present version.
class OpenText {
 public:
  /// `stop` ends the work on the text; it outlives it.
  OpenText(std::string uri, std::string text, int version, language::Encoding encoding, const std::atomic<bool>* stop);

  const std::string& uri() const { return uri_; }
  const std::string& text() const { return text_; }
  int version() const { return version_; }
  /// Beyond this size a text is not looked at while it is typed.
  bool too_large() const { return text_.size() > largest; }
  static constexpr std::size_t largest = 1u << 20;

  /// The contentChanges of textDocument/didChange, one after the other. False where they are none.
  bool change(const Json& changes, int version);

  language::Document& document();
  const language::Positions& positions();
  /// What is known at once: syntax, names, units, physics lint.
  Diagnostics diagnostics();

  Json range(Span span);
  std::uint32_t offset(const Json& position);
  Span span(const Json& range);

 private:
  void forget();

  std::string uri_, text_;
  int version_;
  language::Encoding encoding_;
  const std::atomic<bool>* stop_;
  std::optional<language::Positions> positions_;
  std::optional<language::Document> document_;
};

/// W0818, for a text that is too large.
Diagnostics too_large(const OpenText& text);

}  // namespace maupertuis::app::lsp
