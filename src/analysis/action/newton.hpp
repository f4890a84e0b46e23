#pragma once
#include "analysis/action/directions.hpp"

#include <maupertuis/stop_flag.hpp>

namespace maupertuis::action {

struct NewtonOptions {
  int most_iterations = 60;
  const StopFlag* interrupt = nullptr;
};

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  double correction = 0;  // the last one, in units of the scale
};

/// Moves the nodes to where ∇(S + Σ λ (∫ G − value)) vanishes on the directions that φ = 0 allows. It is no descent: a
/// saddle is found as a minimum is. A step is shortened until the next simplified correction is shorter than the last
/// one (the natural monotonicity test of Deuflhard, which does not see units).
/// `scale` [n × nodes].
NewtonResult solve_stationarity(Functional& functional, Trial& trial, const FixedEnds& fixed, const Matrix& scale,
                                const NewtonOptions& options);

/// How large each coordinate of a path is: its range, but not less than `least` [n]. The same at all nodes.
Matrix even_scale(const Trial& trial, const Vector& least);
/// The same of a path that was found: Ostrogradsky's p, of which no end gives a size, by its largest value.
Matrix scale_of_found(const Trial& trial, const Vector& least, const OrderOfCoordinates& orders);
/// The same, but next to an end where L is infinite the distance from that end: there a small change is a large one.
Matrix path_scale(const Trial& trial, const Vector& least);

}  // namespace maupertuis::action
