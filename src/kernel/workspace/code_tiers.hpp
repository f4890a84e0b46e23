#pragma once
#include "kernel/workspace/expansion_code.hpp"

#include <future>
#include <optional>

namespace maupertuis::workspace {

/// Code of a small program in two tiers. Both are the same operations in the same order, neither contracted nor
/// reordered, so that they give the same numbers to the bit and it does not matter when one follows the other:
///
///     expansions    0 ............... 2·10⁵ ................ the second is there ..........
///     runs          quickly compiled code (tier 1)           code with all passes (tier 2)
///     second thread                   compiles tier 2 ......
///
/// Tier 1 is there in a quarter of the time and takes up to twice as long an expansion.
class CodeTiers {
 public:
  /// `x` is read by the second thread as long as this lives: its program does not change.
  explicit CodeTiers(const packed::PackedProgram& program) : program_(program) {}

  std::pair<ExpansionCode, CompileReport> first(int order, std::size_t stride, const CompileOptions& options);
  /// To be asked before each expansion: tier 2, once, when it is there. Cost: a count.
  std::optional<ExpansionCode> next() { return waits_ && ++expansions_ % period == 0 ? look() : std::nullopt; }
  /// What may still be called by those who hold an address of the code before.
  void retire(std::shared_ptr<const void> memory) { retired_ = std::move(memory); }

 private:
  static constexpr std::size_t period = 512, enough = 200'000;
  std::optional<ExpansionCode> look();

  const packed::PackedProgram& program_;
  int order_ = 0;
  std::size_t stride_ = 0, expansions_ = 0;
  CompileOptions options_;
  bool waits_ = false;  // for tier 2
  std::shared_ptr<const void> retired_;
  std::future<ExpansionCode> second_;  // its end is waited for
};

}  // namespace maupertuis::workspace
