#include "simulation/hybrid_checks.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::hybrid {

bool goes_on(const ModeMotion& motion, double bound) {
  const Outlook outlook = motion.stepper->outlook(bound);
  if (outlook.ending != StepEnding::None) return true;  // the next step says why it cannot be made
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if (motion.watches()[k].keeps_sign() && outlook.sides[k] < 0) return false;
  return true;
}

bool pulls(const ModeMotion& motion, std::size_t constraints, const UsualSizes& sizes) {
  constexpr double digits = 1e-9;
  const std::vector<double>& multipliers = motion.stepper->step_start().multipliers;
  for (std::size_t i = 0, k = 0; i < motion.mode.closed.size(); ++i) {
    if (!motion.mode.closed[i]) continue;
    const double force = multipliers[constraints + k] + motion.given.preload(k, motion.stepper->step_start().t);
    if (force < -digits * std::max(sizes.hardest(i), 1e-280)) return true;
    ++k;
  }
  return false;
}

std::optional<std::size_t> violated_contact(const ModeMotion& motion, double step, const State& here,
                                            UsualSizes& sizes) {
  constexpr double digits = 1e-10;
  const TaylorStepper& s = *motion.stepper;
  if (motion.mode.closed.empty()) return std::nullopt;
  const ContactValues& values = here.values_at(s.time(), s.q(), s.v());
  sizes.note_gaps(values);
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    if (motion.mode.closed[i] || values.gap[i] >= 0)
      continue;  // ∂g/∂q may have no value, as at the centre of √(x² + y²)
    double way = 0;
    for (const auto& [k, g] : values.normal[i]) way += std::abs(g) * sizes.acceleration(k) * step * step;
    if (!(values.gap[i] >= -digits * (sizes.gap(i, values) + way))) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> contact_violated_at_start(const ContactValues& values, const UsualSizes& sizes) {
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (values.gap[i] < -rest_unit * std::max(values.gap_scale[i], sizes.widest(i)) || !std::isfinite(values.gap[i]))
      return i;
  return std::nullopt;
}

std::vector<std::size_t> touching_contacts(const ContactMode& mode, const Met& met, const ContactValues& values,
                                           const UsualSizes& sizes) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    if (!met.sets.empty() && values.gap[i] > digits_of_sets * sizes.gap(i, values)) continue;
    const bool hit = std::find(met.hit.begin(), met.hit.end(), i) != met.hit.end();
    // What has come through zero by more than rounding, unseen, and does not come back by itself, is hit too.
    const bool through = values.gap[i] < 0 && values.rate[i] < -sizes.rest_speed(i, values);
    // Next to zero by the sizes of its coordinates: a body that lies at their zero has no other measure.
    constexpr double next_to_zero = 1e-3 * rest_unit;
    const bool lies = !(values.rate[i] > sizes.rest_speed(i, values)) &&
                      std::abs(values.gap[i]) <= next_to_zero * sizes.gap(i, values);
    if (hit || through || lies || mode.closed[i] || std::abs(values.gap[i]) <= rest_unit * sizes.widest(i))
      out.push_back(i);
  }
  return out;
}

std::optional<std::size_t> sliding_though_sticking(const std::vector<std::size_t>& touching,
                                                   const MechanicalSystem& system, const ContactValues& values,
                                                   const UsualSizes& sizes) {
  constexpr double digits = 1e-9;
  for (const std::size_t i : touching) {
    if (!system.contacts[i].friction.sticking || values.rate[i] > sizes.rest_speed(i, values)) continue;
    if (!(slip_speed(i, values) <= digits * sizes.fastest_slip(i))) return i;
  }
  return std::nullopt;
}

}  // namespace maupertuis::hybrid
