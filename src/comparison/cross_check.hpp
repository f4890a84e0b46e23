#pragma once
#include "comparison/motions.hpp"
#include "comparison/pull_back.hpp"

namespace maupertuis::comparison {

/// Runs of both models from common states, in numbers.
class CrossCheck {
 public:
  CrossCheck(const Model& a, const EquationsOfMotion& a_equations, const Model& b, const EquationsOfMotion& b_equations,
             const PullBack& pull_back, const Motions& motions, const SimulationOptions& options)
      : a_(a),
        b_(b),
        a_equations_(a_equations),
        b_equations_(b_equations),
        pull_back_(pull_back),
        motions_(motions),
        options_(options) {}

  /// Both from B's start over the shorter of their runs.
  maupertuis::CrossCheck run() const;
  /// The first state at which the accelerations differ clearly, else the one at which they differ most; nothing where
  /// they agree to rounding.
  std::optional<Disagreement> disagreement(const std::vector<MotionState>& further) const;

 private:
  double apart(std::size_t coordinate, double x, double y) const;
  bool run_from(const MotionState& start, maupertuis::CrossCheck& out) const;
  std::optional<SimulationResult> run_a(const MotionState& b_state, const SimulationOptions& options) const;
  std::optional<SimulationResult> run_b(const MotionState& state, const SimulationOptions& options) const;
  std::optional<double> duration() const;
  /// The largest size of each coordinate of A and those of the same dimension.
  std::vector<double> common_scale(std::vector<double> sizes) const;

  const Model& a_;
  const Model& b_;
  const EquationsOfMotion& a_equations_;
  const EquationsOfMotion& b_equations_;
  const PullBack& pull_back_;
  const Motions& motions_;
  const SimulationOptions& options_;
};

}  // namespace maupertuis::comparison
