#include "analysis/action/rule.hpp"

#include <eigen3/Eigen/LU>

#include <cmath>
#include <numbers>
#include <utility>

namespace maupertuis::action {
namespace {

/// P_k(x) and P_k'(x).
std::pair<double, double> legendre_polynomial(Index k, double x) {
  double before = 1, here = x, slope_before = 0, slope = 1;
  if (k == 0) return {1, 0};
  for (Index j = 2; j <= k; ++j) {
    const double next = ((2.0 * j - 1) * x * here - (j - 1.0) * before) / j;
    const double next_slope = slope_before + (2.0 * j - 1) * here;
    before = std::exchange(here, next);
    slope_before = std::exchange(slope, next_slope);
  }
  return {here, slope};
}

void gauss_points(Index count, Vector& points, Vector& weights) {
  points.resize(count);
  weights.resize(count);
  for (Index i = 0; i < count; ++i) {
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    for (int turn = 0; turn < 20; ++turn) {
      const auto [p, slope] = legendre_polynomial(count, x);
      x -= p / slope;
    }
    const double slope = legendre_polynomial(count, x).second;
    points[i] = x;
    weights[i] = 2 / ((1 - x * x) * slope * slope);
  }
}

/// The ends and the zeros of P_p', by Newton's method: (1 − x²) P'' = 2 x P' − p (p + 1) P.
Vector lobatto_nodes(Index p) {
  Vector nodes(p + 1);
  for (Index i = 0; i <= p; ++i) {
    double x = -std::cos(std::numbers::pi * i / p);
    for (int turn = 0; turn < 20 && i > 0 && i < p; ++turn) {
      const auto [value, slope] = legendre_polynomial(p, x);
      x -= slope * (1 - x * x) / (2 * x * slope - static_cast<double>(p * (p + 1)) * value);
    }
    nodes[i] = x;
  }
  return nodes;
}

}  // namespace

Rule::Rule(Index p, Flat flat) : degree(p), nodes(lobatto_nodes(p)), flat_(flat) {
  if (flat == Flat::Nowhere) {
    flat_begin = std::make_shared<const Rule>(p, Flat::AtBegin);
    flat_end = std::make_shared<const Rule>(p, Flat::AtEnd);
  }
  gauss_points(p + 2, points, weights);
  barycentric_ = Vector::Ones(p + 1);
  for (Index i = 0; i <= p; ++i)
    for (Index j = 0; j <= p; ++j)
      if (i != j) barycentric_[i] /= nodes[i] - nodes[j];
  value.resize(points.size(), p + 1);
  slope.resize(points.size(), p + 1);
  node_slope.resize(p + 1, p + 1);
  for (Index g = 0; g < points.size(); ++g) {
    value.row(g) = value_at(points[g]).transpose();
    slope.row(g) = slope_at(points[g]).transpose();
  }
  Matrix basis(p + 1, p + 1);
  for (Index i = 0; i <= p; ++i) {
    node_slope.row(i) = slope_at(nodes[i]).transpose();
    for (Index k = 0; k <= p; ++k) basis(i, k) = legendre_polynomial(k, nodes[i]).first;
  }
  legendre = basis.partialPivLu().inverse();
}

/// q(ξ) = q₀ + Σ (q_j − q₀) ((1 + ξ)/(1 + ξ_j))² ℓ_j(ξ) over the nodes j ≥ 1 and their Lagrange polynomials ℓ_j; at the
/// other end the mirror image.
Rule::Basis Rule::flat_basis(double xi) const {
  if (flat_ == Flat::AtEnd) {
    const Basis mirror = flat_begin_of(-xi);
    return {mirror.value.reverse(), -mirror.slope.reverse()};
  }
  return flat_begin_of(xi);
}

Rule::Basis Rule::flat_begin_of(double xi) const {
  Basis out{Vector::Zero(degree + 1), Vector::Zero(degree + 1)};
  for (Index j = 1; j <= degree; ++j) {
    const double from = 1 + nodes[j], root = (1 + xi) / from;
    double lagrange = 1, lagrange_slope = 0;
    for (Index k = 1; k <= degree; ++k) {
      if (k == j) continue;
      const double factor = 1 / (nodes[j] - nodes[k]);
      lagrange_slope = (lagrange_slope * (xi - nodes[k]) + lagrange) * factor;
      lagrange *= (xi - nodes[k]) * factor;
    }
    out.value[j] = root * root * lagrange;
    out.slope[j] = 2 * root / from * lagrange + root * root * lagrange_slope;
  }
  out.value[0] = 1 - out.value.sum();
  out.slope[0] = -out.slope.sum();
  return out;
}

Vector Rule::value_at(double xi) const {
  if (flat_ != Flat::Nowhere) return flat_basis(xi).value;
  Vector out = Vector::Zero(degree + 1);
  for (Index i = 0; i <= degree; ++i)
    if (xi == nodes[i]) return Vector::Unit(degree + 1, i);
  for (Index i = 0; i <= degree; ++i) out[i] = barycentric_[i] / (xi - nodes[i]);
  return out / out.sum();
}

Vector Rule::slope_at(double xi) const {
  if (flat_ != Flat::Nowhere) return flat_basis(xi).slope;
  // At a node by the differentiation matrix; elsewhere d/dξ of each basis polynomial ℓ_i = Π (ξ − ξ_j) b_i.
  Vector out = Vector::Zero(degree + 1);
  for (Index i = 0; i <= degree; ++i)
    for (Index left_out = 0; left_out <= degree; ++left_out) {
      if (left_out == i) continue;
      double product = barycentric_[i];
      for (Index j = 0; j <= degree; ++j)
        if (j != i && j != left_out) product *= xi - nodes[j];
      out[i] += product;
    }
  return out;
}

}  // namespace maupertuis::action
