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
  constexpr double memory = 0.9, none = 1e-30;
  // SUNDIALS takes the mean square over all components; those that do not count shall not thin it.
  const double share = std::sqrt(static_cast<double>(weights.size()) / static_cast<double>(sizes_.size()));
  std::fill(weights.begin(), weights.end(), none);
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sizes_[i] = std::max(memory * sizes_[i], std::abs(y[i]));
    weights[i] = share / (options.tolerance * sizes_[i] + options.absolute);
    if (!std::isfinite(weights[i])) return false;
  }
  return true;
}

}  // namespace maupertuis::stiff
