#pragma once
#include "simulation/hybrid_problem.hpp"
#include "simulation/hybrid_state.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/function_kernel.hpp>

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::hybrid {

class UsualSizes;

/// The energy, the constraints and what events set, at states.
class StateFunctions {
 public:
  explicit StateFunctions(const Problem& problem) : problem_(problem) {}

  double energy(double t, std::span<const double> q, std::span<const double> v) { return energy_and_sets(t, q, v)[0]; }
  double energy(const State& s) { return energy(s.t, s.q, s.v); }
  /// h_E, then the values that events set, one after the other.
  std::vector<double> energy_and_sets(double t, std::span<const double> q, std::span<const double> v);
  /// A constraint that is off by more than these digits of the sizes that the motion has had.
  std::optional<std::size_t> violated_constraint(const MotionState& state, double digits, const UsualSizes& sizes);

 private:
  const Problem& problem_;
  std::optional<FunctionWorkspace> sets_, constraints_;
};

}  // namespace maupertuis::hybrid
