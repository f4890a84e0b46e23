#include "analysis/action/rule.hpp"

#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace maupertuis::action {
namespace {

/// What every action is summed with is computed with digits to spare, where the machine has them: then one rounding is
/// left.
using Wide = long double;

/// P_k(x) and P_k'(x).
std::pair<Wide, Wide> legendre_polynomial(Index k, Wide x) {
  Wide before = 1, here = x, slope_before = 0, slope = 1;
  if (k == 0) return {1, 0};
  for (Index j = 2; j <= k; ++j) {
    const Wide next = ((2 * j - 1) * x * here - (j - 1) * before) / j;
    const Wide next_slope = slope_before + (2 * j - 1) * here;
    before = std::exchange(here, next);
    slope_before = std::exchange(slope, next_slope);
  }
  return {here, slope};
}

void gauss_points(Index count, std::vector<Wide>& points, Vector& weights) {
  points.resize(static_cast<std::size_t>(count));
  weights.resize(count);
  for (Index i = 0; i < count; ++i) {
    Wide x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    for (int turn = 0; turn < 20; ++turn) {
      const auto [p, slope] = legendre_polynomial(count, x);
      x -= p / slope;
    }
    const Wide slope = legendre_polynomial(count, x).second;
    points[static_cast<std::size_t>(i)] = x;
    weights[i] = static_cast<double>(2 / ((1 - x * x) * slope * slope));
  }
}

/// The ends and the zeros of P_p', by Newton's method: (1 − x²) P'' = 2 x P' − p (p + 1) P.
Vector lobatto_nodes(Index p) {
  Vector nodes(p + 1);
  for (Index i = 0; i <= p; ++i) {
    Wide x = -std::cos(std::numbers::pi * i / p);
    for (int turn = 0; turn < 20 && i > 0 && i < p; ++turn) {
      const auto [value, slope] = legendre_polynomial(p, x);
      x -= slope * (1 - x * x) / (2 * x * slope - static_cast<Wide>(p * (p + 1)) * value);
    }
    nodes[i] = static_cast<double>(x);
  }
  return nodes;
}

}  // namespace

Rule::Rule(Index p, Flat flat) : degree(p), anchor(flat == Flat::AtEnd ? p : 0), nodes(lobatto_nodes(p)), flat_(flat) {
  if (flat == Flat::Nowhere) {
    flat_begin = std::make_shared<const Rule>(p, Flat::AtBegin);
    flat_end = std::make_shared<const Rule>(p, Flat::AtEnd);
  }
  std::vector<Wide> places;
  gauss_points(p + 2, places, weights);
  points.resize(p + 2);
  barycentric_ = Vector::Ones(p + 1);
  for (Index i = 0; i <= p; ++i)
    for (Index j = 0; j <= p; ++j)
      if (i != j) barycentric_[i] /= nodes[i] - nodes[j];
  value.resize(points.size(), p + 1);
  slope.resize(points.size(), p + 1);
  node_slope.resize(p + 1, p + 1);
  for (Index g = 0; g < points.size(); ++g) {
    const Wide x = places[static_cast<std::size_t>(g)];
    points[g] = static_cast<double>(x);
    value.row(g) = (flat == Flat::Nowhere ? wide_value(x) : value_at(points[g])).transpose();
    slope.row(g) = (flat == Flat::Nowhere ? wide_slope(x) : slope_at(points[g])).transpose();
  }
  Matrix basis(p + 1, p + 1);
  for (Index i = 0; i <= p; ++i) {
    node_slope.row(i) = slope_at(nodes[i]).transpose();
    for (Index k = 0; k <= p; ++k) basis(i, k) = static_cast<double>(legendre_polynomial(k, nodes[i]).first);
  }
  legendre = basis.partialPivLu().inverse();
  lumping = quadratic_form(value, Matrix(weights.asDiagonal()));
  for (Index i = 0; i <= p; ++i) lumping(i, i) -= 2 / (static_cast<double>(p * (p + 1)) * basis(i, p) * basis(i, p));
}

/// Π over j ≠ i (ξ − ξ_j)/(ξ_i − ξ_j) at a point that is no node.
Vector Rule::wide_value(long double xi) const {
  Vector out(degree + 1);
  for (Index i = 0; i <= degree; ++i) {
    Wide product = 1;
    for (Index j = 0; j <= degree; ++j)
      if (j != i) product *= (xi - nodes[j]) / (static_cast<Wide>(nodes[i]) - nodes[j]);
    out[i] = static_cast<double>(product);
  }
  return out;
}

Vector Rule::wide_slope(long double xi) const {
  Vector out(degree + 1);
  for (Index i = 0; i <= degree; ++i) {
    Wide product = 1, sum = 0;
    for (Index j = 0; j <= degree; ++j) {
      if (j == i) continue;
      const Wide factor = 1 / (static_cast<Wide>(nodes[i]) - nodes[j]);
      sum = (sum * (xi - nodes[j]) + product) * factor;
      product *= (xi - nodes[j]) * factor;
    }
    out[i] = static_cast<double>(sum);
  }
  return out;
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
