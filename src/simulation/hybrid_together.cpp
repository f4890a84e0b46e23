#include "simulation/hybrid_parts.hpp"

#include <algorithm>
#include <cmath>

/// Conditions of a mode that come to their ends together, as those of a symmetric motion do.
namespace maupertuis {

/// Forces come to their limits at one instant where rounding alone tells their times apart: the first that is located
/// ends the step, and the others count as met with it. A mode that was chosen for the first alone would hold the others
/// beyond their limits, unseen.
void HybridMotion::meet_together(double bound) {
  const auto is_limit = [](const Watch& w) { return w.what == Watch::What::Hold || w.what == Watch::What::Force; };
  if (!pending_->hit.empty() || !pending_->sets.empty() || !forwards_) return;
  if (std::none_of(pending_->left.begin(), pending_->left.end(), is_limit)) return;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  constexpr double falls = 1e-9;  // of the largest, over the length that is judged
  constexpr double left_open = 1e-10;
  const double digits =
      motions_.now().given.is_preload ? left_open : rest_unit;  // a rest that is not determined ends early
  const auto& watches = motions_.now().watches();
  double largest[2] = {0, 0};  // of forces, and of squares, which those of friction in space are
  const auto size_of = [&](std::size_t k) -> double& {
    return largest[watches[k].what == Watch::What::Hold && friction_of(problem_.system, watches[k].index).in_space()];
  };
  for (std::size_t k = 0; k < watches.size(); ++k)
    if (is_limit(watches[k])) size_of(k) = std::max(size_of(k), outlook.reach[k]);
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const Watch& w = watches[k];
    const bool is_met = std::any_of(pending_->left.begin(), pending_->left.end(), [&](const Watch& x) {
      return x.what == w.what && x.index == w.index && x.lower == w.lower;
    });
    if (is_met || !is_limit(w) || !(outlook.slopes[k] * outlook.length < -falls * size_of(k))) continue;
    if (std::abs(outlook.values[k]) <= digits * (size_of(k) + std::abs(outlook.slopes[k] * here_.t)))
      pending_->left.push_back(w);
  }
}

/// The mode in which all that has come to its limit gives way and all else stays: forces go on in it, or a rest ends in
/// it that was not determined, so that it is the one where no more than one fits. Of many contacts that the motion does
/// not need it is far from what their forces together point to. Those that carried nothing at the end of a rest that
/// was not determined open.
std::optional<HybridMotion::Found> HybridMotion::mode_that_goes_on(const std::vector<std::size_t>& touching,
                                                                   double bound) {
  const ContactValues& values = here_.values();
  const bool ends_rest = motions_.now().given.is_preload;
  Found out{motions_.now().mode, {}, {}};
  if (pending_->left.size() < 2 || problem_.in_space) return std::nullopt;
  if (ends_rest) open_idle(out.mode);
  for (const Watch& w : pending_->left) {
    if (w.what == Watch::What::Hold)
      out.mode.friction[w.index] = w.lower ? FrictionState::Forward : FrictionState::Backward;
    if (w.what == Watch::What::Force) out.mode.closed[w.index] = false;
  }
  for (std::size_t i = 0; i < out.mode.closed.size(); ++i)
    if (!out.mode.closed[i]) out.mode.friction[i] = FrictionState::None;
  if ((!ends_rest && !changes_no_force(out.mode, values)) || may_be_several(out.mode, values)) return std::nullopt;
  // A contact that a solution of dependent equations leaves without force needs not be closed, but may.
  const Leniency leniency = ends_rest ? Leniency::Forces : Leniency::None;
  // Where a rest ends that was not determined, kinetic friction may take the place of more static friction.
  const bool is_right = fits(out, touching, bound, leniency) && (ends_rest || accelerations_go_on(out.accelerations));
  return is_right ? std::optional(out) : std::nullopt;
}

/// Closed contacts with the forces that the rest was given here, 0 to rounding.
void HybridMotion::open_idle(ContactMode& mode) const {
  constexpr double idle = 1e-12;
  std::vector<double> forces;
  double largest = 0;
  for (std::size_t i = 0, k = 0; i < mode.closed.size(); ++i) {
    if (mode.closed[i]) forces.push_back(motions_.now().given.preload(k++, here_.t));
    if (mode.closed[i]) largest = std::max(largest, std::abs(forces.back()));
  }
  for (std::size_t i = 0, k = 0; i < mode.closed.size(); ++i)
    if (mode.closed[i]) mode.closed[i] = std::abs(forces[k++]) > idle * largest;
}

}  // namespace maupertuis
