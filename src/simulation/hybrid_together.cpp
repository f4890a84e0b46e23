#include <algorithm>
#include <cmath>
#include "simulation/hybrid_parts.hpp"
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

}  // namespace maupertuis
