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
  sizes_.assign(2 * freedoms(), 0);
  units_.assign(2 * freedoms(), 1);
}

bool Motion::solve(double t, std::span<const double> y) {
  status = at_point.solve(t, q_of(y), v_of(y));
  return status == PointStatus::Ok;
}

void Motion::take_sizes(std::span<const double> y) {
  const std::size_t n = freedoms();
  sizes_.assign(2 * n, 0);
  units_.assign(2 * n, 1);
  if (options.kinds.size() != n) return;
  const std::span<const double> a = at_point.a();
  const auto largest = [&](std::span<const double> of, std::size_t kind) {
    double out = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (options.kinds[i] == kind) out = std::max(out, std::abs(of[i]));
    return out;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t kind = options.kinds[i];
    const double place = largest(q_of(y), kind), speed = largest(v_of(y), kind), force = largest(a, kind);
    if (place > 0) units_[i] = std::min(1.0, place);
    // At rest the velocity will be what the acceleration makes of it on a way as long as that.
    const double comes = speed > 0 ? speed : std::sqrt(place * force);
    if (comes > 0 && std::isfinite(comes)) units_[n + i] = std::min(1.0, comes);
  }
}

bool Motion::weigh(std::span<const double> y, std::span<double> weights) {
  constexpr double memory = 0.9;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sizes_[i] = std::max(memory * sizes_[i], std::abs(y[i]));
    weights[i] = 1 / allowed(i);
    if (!std::isfinite(weights[i])) return false;
  }
  return true;
}

}  // namespace maupertuis::stiff
