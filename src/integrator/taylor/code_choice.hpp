#pragma once
#include <maupertuis/integrator.hpp>

namespace maupertuis::taylor {

/// Which code a motion is expanded by, and when other code pays.
class CodeChoice {
 public:
  /// What runs already goes on where other code cannot be had.
  void compile(KernelWorkspace& work, bool cache, bool long_run);
  /// Looks where the number of steps doubles. `done`, `left`: time that they took, and that is left.
  void compile_if_it_pays(KernelWorkspace& work, const TaylorOptions& options, std::size_t unknowns, std::size_t steps,
                          double done, double left);
  const BackendUse& use() const { return use_; }

 private:
  BackendUse use_;
  bool runs_long_ = false;  // code was asked for that pays in long runs
};

}  // namespace maupertuis::taylor
