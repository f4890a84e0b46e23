#pragma once
#include <maupertuis/integrator.hpp>

namespace maupertuis::taylor {

/// Which code a motion is expanded by, and when other code pays.
/// What runs already goes on where other code cannot be had.
class CodeChoice {
 public:
  /// Before the first step: what is there soonest.
  void compile_at_once(KernelWorkspace& work, const TaylorOptions& options);
  /// A motion begins at t, after so many steps of the one before. One that begins further on is a part of the same run,
  /// as the stretches of a motion through modes in one of them are: its steps count with those before.
  void begin(double t, std::size_t steps);
  /// Looks where the number of steps doubles. `steps`: since begin(); `t`, `bound`: where they have come to, and go to.
  void compile_if_it_pays(KernelWorkspace& work, const Kernel& kernel, const TaylorOptions& options, std::size_t steps,
                          double t, double bound);
  const BackendUse& use() const { return use_; }

 private:
  enum class Length { Stage, WholeExpansion };
  void compile(KernelWorkspace& work, bool cache, Length length);

  BackendUse use_;
  bool runs_long_ = false;  // code was asked for that pays in long runs
  double run_begin_ = 0, way_ = 0;
  std::size_t steps_before_ = 0;  // in the run
};

}  // namespace maupertuis::taylor
