#include <maupertuis/diagnostic.hpp>

#include <algorithm>

namespace maupertuis {

Diagnostic& Diagnostics::add(Severity severity, std::string code, std::optional<Span> span, std::string message,
                             std::string reason, std::string help) {
  items_.push_back({std::move(code), severity, span, std::move(message), std::move(reason), std::move(help)});
  return items_.back();
}

Diagnostic& Diagnostics::error(std::string code, std::optional<Span> span, std::string message, std::string reason,
                               std::string help) {
  return add(Severity::Error, std::move(code), span, std::move(message), std::move(reason), std::move(help));
}

Diagnostic& Diagnostics::warning(std::string code, std::optional<Span> span, std::string message, std::string reason,
                                 std::string help) {
  return add(Severity::Warning, std::move(code), span, std::move(message), std::move(reason), std::move(help));
}

Diagnostic& Diagnostics::note(std::string code, std::optional<Span> span, std::string message, std::string reason,
                              std::string help) {
  return add(Severity::Note, std::move(code), span, std::move(message), std::move(reason), std::move(help));
}

void Diagnostics::append(Diagnostic diagnostic) { items_.push_back(std::move(diagnostic)); }

void Diagnostics::append(const Diagnostics& others) {
  items_.insert(items_.end(), others.items_.begin(), others.items_.end());
}

bool Diagnostics::has_errors() const {
  return std::any_of(items_.begin(), items_.end(), [](const Diagnostic& d) { return d.severity == Severity::Error; });
}

void Diagnostics::sort_by_place() {
  const auto place = [](const Diagnostic& d) {
    return d.span ? (static_cast<std::uint64_t>(d.span->source) << 32) + d.span->begin : ~0ull;
  };
  std::stable_sort(items_.begin(), items_.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
}

}  // namespace maupertuis
