#include "integrator/stiff/motion.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::stiff {

Motion::Motion(const MotionFunctions& f, std::span<const double> values, const StiffOptions& o)
    : functions(f),
      options(o),
      parameters(values.begin(), values.end()),
      at_point(f, values),
      integrands_(f.integrands) {
  integrands_.set_parameters(values);
  if (options.absolute == 0) options.absolute = 1e-4 * options.tolerance;
  forget_sizes();
}

bool Motion::solve(double t, std::span<const double> y) {
  status = at_point.solve(t, q_of(y), v_of(y));
  return status == PointStatus::Ok;
}

bool Motion::weigh(std::span<const double> y, std::span<double> weights) {
  constexpr double memory = 0.9;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sizes_[i] = std::max(memory * sizes_[i], std::abs(y[i]));
    weights[i] = 1 / (options.tolerance * sizes_[i] + options.absolute);
    if (!std::isfinite(weights[i])) return false;
  }
  return true;
}

}  // namespace maupertuis::stiff
