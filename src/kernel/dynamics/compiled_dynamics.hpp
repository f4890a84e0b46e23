#pragma once
#include "kernel/dynamics/written_dynamics.hpp"
#include "kernel/straight_line/compile.hpp"

#include <span>

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
  bool accelerations(double t, std::span<const double> q, std::span<const double> v, std::span<double> a);
  void forces(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a, std::span<double> out);

 private:
  const Program& program_;
  std::vector<NumberSource> sources_;
  std::vector<double> numbers_;        // [sources]
  std::vector<std::uint32_t> live_;    // numbers that renew() computes
  std::vector<bool> live_constants_;   // for which they were found
  std::vector<double> scratch_;
  std::vector<double> result_, rest_;  // [unknowns]
  straight::Code code_;
  CompileReport report_;
};

}  // namespace maupertuis::dynamics
