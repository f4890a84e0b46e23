#include "fields/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

/// The rates that belong to a state of a field: from momenta where a field has mass, from ω where it is of first order.
namespace maupertuis {

namespace {

double largest_entry(const MeshMatrix<double>& matrix) {
  double out = 0;
  for (const double value : matrix.values) out = std::max(out, std::abs(value));
  return out;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// v without its part along each of these unit vectors, one after the other.
void take_out(const std::vector<std::vector<double>>& units, std::vector<double>& v) {
  for (const std::vector<double>& unit : units) {
    const double part = dot(unit, v);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] -= part * unit[i];
  }
}

void make_unit(std::vector<double>& v) {
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x /= length;
}

}  // namespace

/// Where all fields are of first order: the null vectors of ω = G. A constant that ℒ does not see (a potential is given
/// by its derivatives) is fixed at the left end, which the other equations allow; what else ω does not move is a shape
/// that the mesh alone has, and is left out of the motion.
void CollocationMotion::find_null_vectors() {
  null_.clear();
  if (!all_first_order_) return;
  fix_constants();
  // (G + ε)⁻¹ makes what ω does not move large: its real part is ε, so that it exists.
  const double size = largest_entry(matrices_.g), epsilon = 1e-9 * size;
  MeshMatrix<double> shifted(mesh_.pattern());
  mesh_.pattern()->for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    if (!is_held_[i] && !is_held_[j]) shifted.values[k] = matrices_.g.values[k];
    if (i == j) shifted.values[k] += is_held_[i] ? size : epsilon;
  });
  if (!shifted.factor()) return;
  std::uint64_t seed = 1;
  constexpr int most = 4, rounds = 4;
  constexpr double rounding = 1e-11;
  for (int k = 0; k < most; ++k) {
    std::vector<double> v(mesh_.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      seed = seed * 6364136223846793005ull + 1442695040888963407ull;
      v[i] = is_held_[i] ? 0 : static_cast<double>(seed >> 33) / 4e9 - 0.5;
    }
    for (int round = 0; round < rounds; ++round) {
      shifted.solve(v.data());
      take_out(null_, v);
      make_unit(v);
    }
    if (!vanishes(matrices_.g, v, rounding)) return;
    if (!mesh_.is_rough(v, fixed_)) {
      trouble_ = "ends";
      return;
    }
    null_.push_back(std::move(v));
  }
}

void CollocationMotion::fix_constants() {
  constexpr double rounding = 1e-10;
  for (std::size_t f = 0; f < form_.smooth.size(); ++f) {
    const std::vector<double> constant = mesh_.constant(f);
    bool free = true;
    for (std::size_t i = 0; i < mesh_.size(); ++i) free = free && !(is_held_[i] && constant[i] != 0);
    if (!free || !vanishes(matrices_.g, constant, rounding) || !vanishes(matrices_.k, constant, rounding)) continue;
    is_held_[mesh_.side_coefficients(f, BoundaryCondition::Side::Left, false).front()] = true;
    fixed_.push_back(f);
  }
}

bool CollocationMotion::vanishes(const MeshMatrix<double>& matrix, const std::vector<double>& v,
                                 double rounding) const {
  const double size = largest_entry(matrix);
  std::vector<double> product(v.size(), 0);
  matrix.add_product(v.data(), product.data());
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!is_held_[i] && !(std::abs(product[i]) <= rounding * size)) return false;
  return true;
}

const CollocationMotion::RateMatrix& CollocationMotion::rate_matrix() const {
  if (rate_matrix_ && form_.steady && rate_matrix_->null_vectors == null_.size()) return *rate_matrix_;
  MeshMatrix<double> matrix(mesh_.pattern());
  mesh_.set(state_.c.data(), rates_.data(), t_);
  GalerkinMesh::Matrices now = mesh_.matrices();
  double largest = 0;
  mesh_.pattern()->for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    double& value = matrix.values[k];
    value = is_held_[i] || is_held_[j] ? (i == j ? 1.0 : 0.0) : !is_first_order_[i] ? now.m.values[k] : now.g.values[k];
    // Velocities of fields with mass do not depend on the others.
    if (!is_first_order_[i] && is_first_order_[j]) value = 0;
    largest = std::max(largest, std::abs(value));
  });
  // ω has no inverse on null vectors: a small part of the identity, and they are left out of what it gives.
  for (std::size_t j = 0; !null_.empty() && j < mesh_.size(); ++j) matrix.at(j, j) += 1e-9 * largest;
  const bool regular = matrix.factor();
  rate_matrix_.emplace(RateMatrix{std::move(matrix), std::move(now.a), regular, null_.size()});
  return *rate_matrix_;
}

void CollocationMotion::find_rates() const {
  if (rates_known_) return;
  rates_known_ = true;
  const RateMatrix& matrix = rate_matrix();
  const std::size_t n = mesh_.size();
  if (!matrix.regular) {
    std::fill(rates_.begin(), rates_.end(), std::nan(""));
    return;
  }
  for (const Held& held : held_)
    if (!held.force) impose(held, 1, t_, rates_);
  std::vector<double> p(n), f(n), r(n);
  constexpr int most_rounds = 12;
  constexpr double enough = 1e-15, settled = 1e-10;
  double before = 0;
  for (int round = 0; round < most_rounds; ++round) {
    mesh_.set(state_.c.data(), rates_.data(), t_);
    mesh_.momenta(p.data());
    mesh_.forces(f.data());
    add_end_forces(t_, f.data());
    std::vector<double> change_of_p(n, 0);  // of momenta that are functions of c
    matrix.a.add_product(rates_.data(), change_of_p.data());
    for (std::size_t i = 0; i < n; ++i)
      r[i] = is_held_[i] ? 0 : is_first_order_[i] ? change_of_p[i] - f[i] : (p[i] - state_.p[i]) - state_.p_lost[i];
    matrix.factored.solve(r.data());
    take_out(null_, r);
    double change = 0, size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
      rates_[i] -= r[i];
      change = std::max(change, std::abs(r[i])), size = std::max(size, std::abs(rates_[i]));
    }
    if (change <= enough * size) break;
    if (round > 0 && change > 0.3 * before && change <= settled * size) break;  // rounding
    before = change;
  }
}

}  // namespace maupertuis
