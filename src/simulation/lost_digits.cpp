#include "simulation/lost_digits.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// Of the largest value among columns of one unit, those of points included: what is smaller is rounding noise about
/// zero, not a motion.
constexpr double noise_of_unit = 1e-6;

/// Of what a coordinate would have done along the run if the forces on it had not balanced.
constexpr double noise_of_balance = 1e-12;

/// An angle has a size of its own, a radian: where nothing turns by more than this, what turns less by far is noise.
constexpr double small_turn = 1e-6;

/// In all rows, and of the state between them.
double largest_of(const CompanionPlan& plan, std::size_t column) {
  double out = 0;
  const auto look = [&](double x) {
    if (std::isfinite(x)) out = std::max(out, std::abs(x));
  };
  const Trajectory& rows = plan.result.trajectory;
  for (std::size_t row = 0; row < rows.rows(); ++row) look(rows.at(row, column));
  const std::size_t state = 2 * plan.run.q.size();
  for (std::size_t i = column; column < state && i < plan.between.values.size(); i += state)
    look(plan.between.values[i]);
  return out;
}

}  // namespace

LostDigits::LostDigits(const CompanionPlan& plan) {
  const std::size_t n = plan.run.q.size();
  const auto& names = plan.result.trajectory.columns;
  // Of points, too: a shaft that is held lies still at 0, and its ends do not. Energies and forces are no sizes of
  // places, though numbers without units look alike.
  std::vector<double> largest;
  for (std::size_t c = 0; c < 2 * n + plan.observables.points; ++c) largest.push_back(largest_of(plan, c));
  sizes_.assign(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(2 * n));
  for (std::size_t c = 0; c < 2 * n; ++c) {
    double of_unit = names[c].unit == "rad" ? small_turn : 0;
    for (std::size_t other = 0; other < largest.size(); ++other)
      if (names[other].unit == names[c].unit) of_unit = std::max(of_unit, largest[other]);
    // What moves a coordinate along the whole run by less than its noise is noise too.
    if (const double length = std::abs(plan.run.end - plan.run.begin); c >= n && length > 0)
      of_unit = std::max(of_unit, of_unit_[c - n] / length);
    of_unit_.push_back(of_unit);
    const double length = std::abs(plan.run.end - plan.run.begin);
    const double speed = plan.accelerations.empty() ? 0 : noise_of_balance * plan.accelerations[c % n] * length;
    rounding_.push_back(c < n ? speed * length : speed);
  }
}

bool LostDigits::is_lost(std::size_t column, double error) const {
  return error > 0 && error >= saturated_error * sizes_[column] && error >= noise_of_unit * of_unit_[column] &&
         error >= rounding_[column];
}

LostCompanion::LostCompanion(const CompanionPlan& plan, double share)
    : plan_(plan), digits_(plan), share_(share), largest_(2 * plan.run.q.size(), 0) {}

bool LostCompanion::look(std::size_t g, const double* row) {
  bool everything = true;
  for (std::size_t c = 0; c < largest_.size(); ++c) {
    const double value = plan_.value(g, c), off = std::abs(row[c] - value);
    if (std::isfinite(off)) largest_[c] = std::max(largest_[c], off);
    // A column that never moves is known although all others are lost.
    everything = everything && digits_.size(c) > 0 && digits_.is_lost(c, share_ * largest_[c]);
  }
  return everything;
}

}  // namespace maupertuis
