#include "kernel/workspace/code_tiers.hpp"

#include <chrono>
#include <system_error>

namespace maupertuis::workspace {

std::pair<ExpansionCode, CompileReport> CodeTiers::first(int order, std::size_t stride, const CompileOptions& options) {
  order_ = order, stride_ = stride, options_ = options;
  auto made = compile(program_, order, stride, options);
  waits_ = options.in_tiers && made.first.memory && !made.second.is_final;
  expansions_ = 0;
  return made;
}

/// Without a second thread tier 1 goes on.
std::optional<ExpansionCode> CodeTiers::look() {
  if (expansions_ < enough) return std::nullopt;
  if (!second_.valid()) {
    CompileOptions options = options_;
    options.in_tiers = false;
    try {
      second_ = std::async(std::launch::async, [=, this] { return compile(program_, order_, stride_, options).first; });
    } catch (const std::system_error&) {
      waits_ = false;
    }
    return std::nullopt;
  }
  if (second_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  waits_ = false;
  ExpansionCode code = second_.get();
  return code.memory ? std::optional(std::move(code)) : std::nullopt;
}

}  // namespace maupertuis::workspace
