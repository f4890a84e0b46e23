#pragma once
#include "integrator/point/point_solver.hpp"

#include <maupertuis/stiff.hpp>

#include <span>
#include <vector>

namespace maupertuis::stiff {

/// What the method asks of the motion that it follows. A state is q [n], v [n], integrals [w].
class Motion {
 public:
  Motion(const MotionFunctions& functions, std::span<const double> parameters, const StiffOptions& options);

  std::size_t freedoms() const { return functions.freedoms; }
  std::size_t states() const { return 2 * functions.freedoms + functions.integrands.outputs(); }
  std::span<const double> q_of(std::span<const double> y) const { return y.first(functions.freedoms); }
  std::span<const double> v_of(std::span<const double> y) const {
    return y.subspan(functions.freedoms, functions.freedoms);
  }

  /// Accelerations and multipliers at y; the status is kept for the reason of a failure.
  bool solve(double t, std::span<const double> y);
  /// Puts (q, v) onto the constraints, to rounding.
  bool project(double t, std::span<double> y) {
    return at_point.project(t, y.first(freedoms()), y.subspan(freedoms(), freedoms()));
  }
  /// At the point of the last solve.
  void integrand_values(std::span<double> out) { integrands_.evaluate(at_point.point(), out); }

  /// Begins at y, after solve(t, y): what is small then is measured by its like.
  void take_sizes(std::span<const double> y);
  /// The reciprocals of the errors that a step may make. Each coordinate and velocity is measured against its own size,
  /// which it keeps for a while when it passes through zero; whatever follows v in y has no part in the control of the
  /// error.
  bool weigh(std::span<const double> y, std::span<double> weights);
  /// What a step may err in velocity i.
  double velocity_error(std::size_t i) const { return allowed(freedoms() + i); }

  const MotionFunctions functions;
  StiffOptions options;
  const std::vector<double> parameters;
  PointSolver at_point;
  PointStatus status = PointStatus::Ok;  // of the last point that the method asked for

 private:
  double allowed(std::size_t i) const { return options.tolerance * sizes_[i] + options.absolute * units_[i]; }

  FunctionWorkspace integrands_;
  std::vector<double> sizes_, units_;  // [2n] of late; at the start
};

}  // namespace maupertuis::stiff
