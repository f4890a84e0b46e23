#include "analysis/linearization/shared_forces.hpp"

#include "analysis/linearization/dense.hpp"
#include "linear_algebra/resting_forces.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double dependent_forces = 1e-10;

}  // namespace

SharedForces::SharedForces(const MechanicalSystem& system, const ContactMode& mode, const EquationsOfMotion& equations,
                           PointEquations::Impl& points, const OperatingPoint& point,
                           const std::vector<double>& limits) {
  sort_multipliers(system, mode, equations, limits);
  if (within_limits_.empty()) return;
  OperatingPoint without = point;
  std::fill(without.multipliers.begin(), without.multipliers.end(), 0.0);
  pose(points.at(points.resting, without));
}

void SharedForces::sort_multipliers(const MechanicalSystem& system, const ContactMode& mode,
                                    const EquationsOfMotion& equations, const std::vector<double>& limits) {
  const ExprVector& all = equations.multipliers;
  std::vector<bool> is_taken(all.size(), false);
  const auto take = [&](const Expr& multiplier, bool is_normal) {
    const auto k = std::find(all.begin(), all.end(), multiplier) - all.begin();
    is_taken[static_cast<std::size_t>(k)] = true;
    within_limits_.push_back(k);
    is_normal_.push_back(is_normal);
  };
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool is_contact = i < mode.closed.size();
    if (is_contact && !mode.closed[i]) continue;
    const Friction& f = friction_of(system, i);
    const bool rubs = mode.friction[i] == FrictionState::Stick && !f.sticking && std::isfinite(limits[i]);
    if (is_contact) {
      take(system.contacts[i].multiplier, true);
      problem_.contacts.push_back({rubs ? static_cast<int>(f.multipliers.size()) : 0, rubs ? limits[i] : 0});
    }
    if (!rubs) continue;
    for (const Expr& m : f.multipliers) take(m, false);
    if (!is_contact) problem_.limits.push_back(limits[i]);
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!is_taken[k]) others_.push_back(static_cast<Index>(k));
}

/// W λ = −free says that forces balance beside those of constraints, which may be any. Rows are of one size first:
/// forces and moments do not compare.
void SharedForces::pose(const RowsAtPoint& balance) {
  rows_ = balance.value, by_multipliers_ = balance.by_multipliers;
  if (!rows_.allFinite() || !by_multipliers_.allFinite()) return;
  for (Index i = 0; i < rows_.size(); ++i) {
    const double size = by_multipliers_.row(i).cwiseAbs().maxCoeff();
    if (!(size > 0)) continue;
    rows_(i) /= size;
    by_multipliers_.row(i) /= size;
  }
  const KernelFirst beside = kernel_first(Matrix(by_multipliers_(Eigen::all, others_)).transpose(), dependent_forces);
  const Matrix free_ways = beside.basis.leftCols(beside.kernel).transpose();
  const Matrix columns = free_ways * by_multipliers_(Eigen::all, within_limits_);
  open_ = least_squares(columns, free_ways * rows_, dependent_forces).rank < columns.cols();
  problem_.response = columns.transpose() * columns;
  problem_.free = columns.transpose() * (free_ways * rows_);
}

std::optional<std::vector<double>> SharedForces::pressing_by(double least) const {
  Vector given = Vector::Zero(problem_.free.size());
  for (Index k = 0; k < given.size(); ++k)
    if (is_normal_[static_cast<std::size_t>(k)]) given(k) = least;
  ConeProblem more = problem_;
  more.free += problem_.response * given;
  const auto found = resting_forces(more);
  if (!found) return std::nullopt;
  Vector all = Vector::Zero(by_multipliers_.cols());
  all(within_limits_) = *found + given;
  if (!others_.empty())
    all(others_) =
        least_squares(by_multipliers_(Eigen::all, others_), -(rows_ + by_multipliers_ * all), dependent_forces).x;
  return to_list(all);
}

}  // namespace maupertuis
