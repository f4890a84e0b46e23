#include "integrator/variational/tableau.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace maupertuis::variational {
namespace {

using Real = long double;

/// The Legendre polynomial P_k and its derivative at x.
std::pair<Real, Real> legendre(std::size_t k, Real x) {
  Real before = 1, now = x;
  if (k == 0) return {1, 0};
  for (std::size_t i = 2; i <= k; ++i)
    before = std::exchange(now, ((2 * Real(i) - 1) * x * now - (Real(i) - 1) * before) / Real(i));
  return {now, Real(k) * (x * now - before) / (x * x - 1)};
}

std::vector<Real> gauss_nodes(std::size_t s) {
  std::vector<Real> nodes;
  for (std::size_t i = 0; i < s; ++i) {
    Real x = -std::cos(std::numbers::pi_v<Real> * (Real(i) + 0.75L) / (Real(s) + 0.5L));
    for (int turn = 0; turn < 20; ++turn) {
      const auto [p, slope] = legendre(s, x);
      x -= p / slope;
    }
    nodes.push_back((1 + x) / 2);
  }
  return nodes;
}

/// The ends and the zeros of P'_{s−1}, by Newton with P'' from Legendre's equation.
std::vector<Real> lobatto_nodes(std::size_t s) {
  std::vector<Real> nodes{0};
  const Real k = Real(s) - 1;
  for (std::size_t i = 1; i + 1 < s; ++i) {
    Real x = -std::cos(std::numbers::pi_v<Real> * Real(i) / k);
    for (int turn = 0; turn < 20; ++turn) {
      const auto [p, slope] = legendre(s - 1, x);
      x -= slope * (1 - x * x) / (2 * x * slope - k * (k + 1) * p);
    }
    nodes.push_back((1 + x) / 2);
  }
  nodes.push_back(1);
  return nodes;
}

Tableau from_nodes(std::vector<Real> nodes) {
  Tableau t;
  t.stages = nodes.size();
  t.c = std::move(nodes);
  t.quadrature_nodes = gauss_nodes(t.stages);
  for (const Real node : t.quadrature_nodes) {
    const Real y = 2 * node - 1, slope = legendre(t.stages, y).second;
    t.quadrature_weights.push_back(1 / ((1 - y * y) * slope * slope));
  }
  for (std::size_t j = 0; j < t.stages; ++j) t.b.push_back(t.basis_integral(j, 1));
  for (std::size_t i = 0; i < t.stages; ++i)
    for (std::size_t j = 0; j < t.stages; ++j) t.a.push_back(t.basis_integral(j, t.c[i]));
  for (std::size_t i = 0; i < t.stages; ++i)
    for (std::size_t j = 0; j < t.stages; ++j) t.dual.push_back(t.b[j] * (1 - t.at(t.a, j, i) / t.b[i]));
  // The last column of IIIB and the first row of IIIA vanish, and the last row of IIIA is b: exactly.
  if (t.c.front() == 0)
    for (std::size_t i = 0; i < t.stages; ++i) {
      t.dual[i * t.stages + t.stages - 1] = 0;
      t.dual[i * t.stages] = t.b.front();
      t.a[(t.stages - 1) * t.stages + i] = t.b[i];
    }
  return t;
}

}  // namespace

long double Tableau::basis(std::size_t j, long double x) const {
  Real value = 1;
  for (std::size_t k = 0; k < stages; ++k)
    if (k != j) value *= (x - c[k]) / (c[j] - c[k]);
  return value;
}

long double Tableau::basis_integral(std::size_t j, long double x) const {
  // Gauss with s nodes is exact beyond the degree s − 1.
  Real sum = 0;
  for (std::size_t i = 0; i < stages; ++i) sum += quadrature_weights[i] * basis(j, x * quadrature_nodes[i]);
  return x * sum;
}

Tableau gauss(std::size_t stages) { return from_nodes(gauss_nodes(stages)); }
Tableau lobatto(std::size_t stages) { return from_nodes(lobatto_nodes(stages)); }

}  // namespace maupertuis::variational
