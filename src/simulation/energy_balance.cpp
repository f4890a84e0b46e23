#include "simulation/energy_balance.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace maupertuis {

double EnergyBalance::energy_of(const Sample& sample) const {
  return std::accumulate(sample.observables.begin(), sample.observables.begin() + static_cast<std::ptrdiff_t>(terms_),
                         0.0);
}

void EnergyBalance::before_step(const Method& method) {
  on_switch_ = at_switch_ ? std::optional(method.sample(method.time())) : std::nullopt;
}

void EnergyBalance::after_step(const Method& method, const Step& step) {
  const bool moved = step.begin != step.end;
  // What is switched in time does work at once: the same state before and after.
  if (on_switch_ && moved) {
    const double work = energy_of(method.step_start()) - energy_of(*on_switch_);
    if (std::isfinite(work)) work_before_ += work;
  }
  at_switch_ = jumps_ && !step.switches.empty();
  if (moved && method.step_start().observables.size() >= terms_) add(method.step_start());
}

/// Of a Lagrangian of the first order no term knows a velocity, and h_E may be one term, which does not change: then
/// each counts that is no constant.
double EnergyBalance::change_of_term(std::size_t i, double value) const {
  if (of_places_.empty() || !of_places_[i]) return std::abs(value);
  if (knows_velocity_) return std::abs(value - first_terms_[i]);
  return value != first_terms_[i] ? std::abs(value) : 0;
}

void EnergyBalance::add(const Sample& sample) {
  double energy = 0, scale = 0;
  for (std::size_t i = 0; i < terms_; ++i) {
    energy += sample.observables[i];
    scale += std::abs(sample.observables[i]);
  }
  overflows_ = overflows_ || std::isinf(scale);
  if (!std::isfinite(energy))
    return;  // a point at which the formula has no value, though the motion passes it; or the ending tells
  if (!std::isfinite(work_of(sample))) {  // an integral never comes back from there
    overflows_ = true;
    return;
  }
  if (!begun_) {
    first_ = energy;
    first_terms_.assign(sample.observables.begin(), sample.observables.begin() + static_cast<std::ptrdiff_t>(terms_));
  }
  begun_ = true;
  double change = 0;
  for (std::size_t i = 0; i < terms_; ++i) change += change_of_term(i, sample.observables[i]);
  largest_change_ = std::max(largest_change_, change);
  largest_scale_ = std::max(largest_scale_, scale);
  largest_error_ = std::max(largest_error_, std::abs(energy - first_ - work_before_ - work_of(sample)));
}

double EnergyBalance::drift(double rounding) const {
  constexpr double sums = 16 * std::numeric_limits<double>::epsilon();  // rounding of h_E, by its terms
  if (std::max(largest_scale_, largest_error_) <= rounding || !(largest_scale_ > 0)) return 0;
  const double beyond = largest_error_ - sums * largest_scale_, of_terms = largest_error_ / largest_scale_;
  return beyond > 0 && largest_change_ > 0 ? std::max(of_terms, beyond / largest_change_) : of_terms;
}

}  // namespace maupertuis
