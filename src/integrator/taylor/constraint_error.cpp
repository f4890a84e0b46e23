#include "integrator/taylor/constraint_error.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::taylor {
namespace {

double ratio(double value, double scale) { return value == 0 ? 0.0 : std::abs(value) / scale; }

/// |q̇| + h |q̈| of a coordinate: its speed in the course of a step.
double speed(const KernelWorkspace& work, std::size_t i, double h) {
  return std::abs(work.coordinate(1)[i]) + h * std::abs(work.acceleration(i));
}

/// A bound of |A q̇| over the step, by Cauchy and Schwarz in the metric of the diagonal of M, so that a motion along the
/// constraint counts; coordinates without inertia count by themselves.
double rate_bound(const KernelWorkspace& work, std::size_t row, std::size_t freedoms, double h) {
  double motion = 0, gradient = 0, rest = 0;
  for (std::size_t i = 0; i < freedoms; ++i) {
    const double a = work.constraint_matrix(row, i), v = speed(work, i, h), mass = work.mass(i, i);
    if (mass > 0) motion += mass * v * v, gradient += a * a / mass;
    else rest += std::abs(a) * v;
  }
  return std::sqrt(motion * gradient) + rest;
}

}  // namespace

double constraint_error(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h) {
  double largest = 0;
  for (std::size_t j = 0; j < constraints; ++j) {
    const double rate = rate_bound(work, j, freedoms, h);
    largest = std::max({largest, ratio(work.constraint_value(j), work.constraint_scale(j) + h * rate),
                        ratio(work.constraint_rate(j), work.constraint_rate_scale(j) + rate)});
  }
  return largest;
}

}  // namespace maupertuis::taylor
