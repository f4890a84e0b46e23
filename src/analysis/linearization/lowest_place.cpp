#include "analysis/linearization/lowest_place.hpp"

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/point_equations.hpp"
#include "linear_algebra/least_distance.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int most_steps_down = 100;
constexpr double longest_way = 1, shortest_way = 1e-12;  // of typical sizes
constexpr double no_gap_below = 1e-7;                    // of typical sizes
constexpr double least_damping = 1e-9;                   // of forces over typical sizes

ExprVector gaps_of(const MechanicalSystem& system) {
  ExprVector out;
  for (const Contact& c : system.contacts) out.push_back(c.gap);
  return out;
}

/// ½ dᵀ H d + fᵀ d is least under G d ≥ h: with H = L Lᵀ the w = Lᵀ d + L⁻¹ f is the shortest of those that may be.
std::optional<Vector> least_energy(const Matrix& h, const Vector& f, const Matrix& g, const Vector& least) {
  const auto factor = cholesky(h);
  if (!factor) return std::nullopt;
  const Vector there = -(factor->inverse * f);
  Matrix rows = g * factor->inverse.transpose();
  Vector bounds = least - rows * there;
  for (Index i = 0; i < rows.rows(); ++i) {
    const double size = rows.row(i).norm();
    if (!(size > 0)) continue;
    rows.row(i) /= size;
    bounds(i) /= size;
  }
  const auto w = least_distance(rows, bounds);
  return w ? std::optional(Vector(factor->inverse.transpose() * (*w + there))) : std::nullopt;
}

/// One place after the other.
class WayDown {
 public:
  WayDown(PointEquations::Impl& e, std::vector<double> sizes) : e_(e), sizes_(to_eigen(sizes)) {}

  OperatingPoint from(OperatingPoint place) {
    for (int step = 0; step < most_steps_down; ++step) {
      const auto by = step_at(place);
      if (!by || !(by->cwiseAbs().maxCoeff() > shortest_way)) break;
      for (std::size_t k = 0; k < e_.n; ++k) place.q[k] += sizes_(static_cast<Index>(k)) * (*by)(static_cast<Index>(k));
    }
    return place;
  }

  /// To the digits of such steps.
  std::vector<bool> touching(const OperatingPoint& place) {
    const RowsAtPoint gaps = e_.at(e_.outputs, place);
    const Matrix slopes = gaps.by_q * sizes_.asDiagonal();
    std::vector<bool> out;
    for (Index i = 0; i < gaps.value.size(); ++i) out.push_back(gaps.value(i) <= no_gap_below * slopes.row(i).norm());
    return out;
  }

 private:
  std::optional<Vector> step_at(const OperatingPoint& place) {
    const auto by_sizes = sizes_.asDiagonal();
    const RowsAtPoint balance = e_.at(e_.resting, place), gaps = e_.at(e_.outputs, place),
                      kept = e_.at(e_.positions, place);
    const Vector forces = by_sizes * balance.value;
    const Matrix stiffness = by_sizes * balance.by_q * by_sizes;
    Matrix rows(gaps.by_q.rows() + 2 * kept.by_q.rows(), gaps.by_q.cols());
    rows << gaps.by_q, kept.by_q, -kept.by_q;
    rows = rows * by_sizes;
    Vector least(rows.rows());
    least << -gaps.value, -kept.value, kept.value;
    if (!forces.allFinite() || !stiffness.allFinite() || !rows.allFinite() || !least.allFinite()) return std::nullopt;
    const double size = forces.cwiseAbs().maxCoeff();
    if (damping_ == 0) damping_ = std::max(size, 1e-300);
    for (damping_ = std::max(damping_ / 4, least_damping * size); std::isfinite(damping_); damping_ *= 4) {
      const Matrix h =
          0.5 * (stiffness + stiffness.transpose()) + damping_ * Matrix::Identity(forces.size(), forces.size());
      const auto by = least_energy(h, forces, rows, least);
      if (by && by->cwiseAbs().maxCoeff() <= longest_way) return by;
    }
    return std::nullopt;
  }

  PointEquations::Impl& e_;
  Vector sizes_;
  double damping_ = 0;
};

}  // namespace

OperatingPoint point_at_rest(const PointEquations& equations, const MotionState& start) {
  const PointEquations::Impl& e = equations.impl();
  return {start.t,
          start.q,
          std::vector<double>(e.n),
          std::vector<double>(e.n),
          std::vector<double>(e.m),
          equations.inputs_at(start.t)};
}

std::vector<bool> touching_at_lowest_place(const EquationsOfMotion& equations, const MechanicalSystem& with_contacts,
                                           const OperatingPoint& from) {
  const PointEquations points(equations, gaps_of(with_contacts));
  WayDown way(points.impl(), typical_sizes(with_contacts, {from.t, from.q, from.v}));
  return way.touching(way.from(from));
}

}  // namespace maupertuis
