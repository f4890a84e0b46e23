#pragma once
#include "kernel/dynamics/written_dynamics.hpp"
#include "kernel/straight_line/compile.hpp"

namespace maupertuis::dynamics {

/// Machine code for one plan of one program, with its numbers.
class CompiledDynamics {
 public:
  CompiledDynamics(const Program& program, WrittenDynamics written, const CompileOptions& options);

  const CompileReport& report() const { return report_; }

  /// After all constants changed. `usual_size`: [pivots] of the plan, in the order of its pivots.
  void set_constants(const std::vector<double>& constants, const sparse::LiftedSystem& system, const std::vector<sparse::Pivot>* pivots);
  /// After those changed that `live` constants stand in.
  void renew(const std::vector<double>& constants, const std::vector<bool>& live);

  /// False: a pivot is small, or a number infinite or undefined. The interpreter decides then; a is as it was.
  bool accelerations(double t, const double* q, const double* v, double* a) {
    return code_.guarded(0, &t, q, v, rest_.data(), numbers_.data(), a, scratch_.data());
  }
  /// a: null for 0
  void forces(double t, const double* q, const double* v, const double* a, double* out) {
    code_.guarded(1, &t, q, v, a ? a : rest_.data(), numbers_.data(), out, scratch_.data());
  }

 private:
  const Program& program_;
  std::vector<NumberSource> sources_;
  std::vector<double> numbers_;        // [sources]
  std::vector<std::uint32_t> live_;    // numbers that renew() computes
  std::vector<bool> live_constants_;   // for which they were found
  std::vector<double> scratch_;
  std::vector<double> rest_;           // [unknowns] zeros
  straight::Code code_;
  CompileReport report_;
};

}  // namespace maupertuis::dynamics
