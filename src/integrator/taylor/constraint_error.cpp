#include "integrator/taylor/constraint_error.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::taylor {
namespace {

double ratio(double value, double scale) { return value == 0 ? 0.0 : std::abs(value) / scale; }

}  // namespace

double constraint_error(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h) {
  double largest = 0;
  for (std::size_t j = 0; j < constraints; ++j) {
    double speed = 0, acceleration = 0;
    for (std::size_t i = 0; i < freedoms; ++i) {
      const double a = std::abs(work.constraint_matrix(j, i));
      speed += a * std::abs(work.coordinate(1)[i]);
      acceleration += a * std::abs(work.acceleration(i));
    }
    const double value_scale = work.constraint_scale(j) + h * (speed + h * acceleration);
    const double rate_scale = work.constraint_rate_scale(j) + h * acceleration;
    largest = std::max({largest, ratio(work.constraint_value(j), value_scale), ratio(work.constraint_rate(j), rate_scale)});
  }
  return largest;
}

}  // namespace maupertuis::taylor
