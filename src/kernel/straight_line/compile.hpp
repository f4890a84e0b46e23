#pragma once
#include "kernel/straight_line/straight_line.hpp"

#include <maupertuis/kernel.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace maupertuis::straight {

/// Machine code of some straight lines: one function each, whose arguments are the line's arrays and last its scratch,
/// see scratch_size(). Arrays do not overlap, except those of guarded lines.
class Code {
 public:
  Code() = default;
  explicit operator bool() const { return memory_ != nullptr; }
  /// Precondition: as many arrays as line `index` has, and scratch.
  template <class... Arrays>
  void operator()(std::size_t index, Arrays... arrays) const {
    reinterpret_cast<void (*)(Arrays...)>(functions_[index])(arrays...);
  }
  /// The same of a guarded line: whether all went well. If not, nothing was stored.
  template <class... Arrays>
  bool guarded(std::size_t index, Arrays... arrays) const {
    return reinterpret_cast<bool (*)(Arrays...)>(functions_[index])(arrays...);
  }

 private:
  friend std::pair<Code, CompileReport> compile(const std::vector<StraightLine>& lines, const CompileOptions& options);
  std::vector<void*> functions_;
  std::shared_ptr<const void> memory_;
};

/// No code where there is no LLVM, or where the lines are too long; then the report says why in a sentence.
/// Cost: about 20 µs a node; from the cache below 1 ms.
std::pair<Code, CompileReport> compile(const std::vector<StraightLine>& lines, const CompileOptions& options);

}  // namespace maupertuis::straight
