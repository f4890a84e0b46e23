#pragma once
#include <maupertuis/integrator.hpp>

namespace maupertuis::taylor {

/// Which code a motion is expanded by, and when other code pays.
/// What runs already goes on where other code cannot be had.
class CodeChoice {
 public:
  /// Before the first step: what is there soonest.
  void compile_at_once(KernelWorkspace& work, const TaylorOptions& options);
  /// Looks where the number of steps doubles. `done`, `left`: time that they took, and that is left.
  void compile_if_it_pays(KernelWorkspace& work, const Kernel& kernel, const TaylorOptions& options, std::size_t steps,
                          double done, double left);
  const BackendUse& use() const { return use_; }

 private:
  enum class Length { Stage, WholeExpansion };
  void compile(KernelWorkspace& work, bool cache, Length length);

  BackendUse use_;
  bool runs_long_ = false;  // code was asked for that pays in long runs
};

}  // namespace maupertuis::taylor
