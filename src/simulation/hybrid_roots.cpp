#include "simulation/hybrid_roots.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::hybrid {

double hidden_by_rounding(const ModeMotion& motion, const Met& met, double bound) {
  constexpr double simple = 1e-8, most = 5;
  if (met.left.empty() || met.changes_state()) return 0;
  const Outlook outlook = motion.stepper->outlook(bound);
  if (outlook.ending != StepEnding::None) return 0;
  double out = 0;
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    const Watch& w = motion.watches()[k];
    if (w.what != Watch::What::Hold && w.what != Watch::What::Force) continue;
    const bool ends = met.ends(w);
    const double hidden = std::abs(outlook.values[k] / outlook.slopes[k]);
    if (ends && hidden > simple * outlook.length && hidden < outlook.length) out = std::max(out, most * hidden);
  }
  return out;
}

double hides_gap(std::size_t contact, double length, const ModeMotion& motion, const State& here,
                 const UsualSizes& sizes) {
  constexpr double slow = 1e-4, slower = 2;
  const ContactValues& now = here.values();
  const double speed = std::abs(now.rate[contact]), most = std::abs(length);
  if (speed > slow * sizes.fastest(contact)) return 0;
  const double rounding = 8 * rest_unit * sizes.gap(contact, now);  // to which roots are searched
  std::vector<double> q = here.q, v = here.v;
  for (double hidden = rest_unit * std::max(std::abs(here.t), most); hidden < most; hidden *= 2) {
    const double before = length > 0 ? here.t - hidden : here.t + hidden;
    motion.stepper->state(before, q, v);
    const ContactValues& values = here.values_at(before, q, v);
    if (std::abs(values.gap[contact]) > rounding) return std::abs(values.rate[contact]) > slower * speed ? hidden : 0;
  }
  return most;
}

void meet_together(Met& met, const ModeMotion& motion, const MechanicalSystem& system, double bound) {
  const auto is_limit = [](const Watch& w) { return w.what == Watch::What::Hold || w.what == Watch::What::Force; };
  if (met.changes_state()) return;
  if (std::none_of(met.left.begin(), met.left.end(), is_limit)) return;
  const Outlook outlook = motion.stepper->outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  constexpr double falls = 1e-9;  // of the largest, over the length that is judged
  constexpr double left_open = 1e-10;
  const double digits = motion.given.is_preload ? left_open : rest_unit;  // a rest that is not determined ends early
  const auto& watches = motion.watches();
  double largest[2] = {0, 0};  // of forces, and of squares, which those of friction in space are
  const auto size_of = [&](std::size_t k) -> double& {
    return largest[watches[k].what == Watch::What::Hold && friction_of(system, watches[k].index).in_space()];
  };
  for (std::size_t k = 0; k < watches.size(); ++k)
    if (is_limit(watches[k])) size_of(k) = std::max(size_of(k), outlook.reach[k]);
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const Watch& w = watches[k];
    const bool is_met = met.ends(w);
    if (is_met || !is_limit(w) || !(outlook.slopes[k] * outlook.length < -falls * size_of(k))) continue;
    if (std::abs(outlook.values[k]) <= digits * (size_of(k) + std::abs(outlook.slopes[k] * motion.stepper->time())))
      met.left.push_back(w);
  }
}

}  // namespace maupertuis::hybrid
