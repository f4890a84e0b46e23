#include "verification/combination.hpp"

#include <maupertuis/constraint_manifold.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// The nearest fraction with a small denominator; nothing where none is near. Ratios of the inertias of rolling bodies,
/// as 15/14 and 21/25, are among them.
std::optional<Rational> simple_fraction(double x) {
  constexpr int largest_denominator = 40;
  constexpr double near = 1e-7;
  for (int q = 1; q <= largest_denominator; ++q)
    if (const double p = std::round(x * q); std::abs(x * q - p) < near * q && std::abs(p) < 1000)
      return Rational(static_cast<int>(p), q);
  return std::nullopt;
}

/// Solves Aᵀ A x = Aᵀ b by elimination with pivots; nothing where columns depend on each other.
std::optional<std::vector<double>> least_squares(const std::vector<std::vector<double>>& a,
                                                 const std::vector<double>& b) {
  const std::size_t n = a.front().size();
  std::vector<std::vector<double>> m(n, std::vector<double>(n + 1, 0.0));
  for (std::size_t r = 0; r < a.size(); ++r)
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) m[i][j] += a[r][i] * a[r][j];
      m[i][n] += a[r][i] * b[r];
    }
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]);
    if (!(std::abs(m[k][k]) > 1e-11)) return std::nullopt;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j <= n; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  std::vector<double> x(n);
  for (std::size_t k = 0; k < n; ++k) x[k] = m[k][n] / m[k][k];
  return x;
}

}  // namespace

Expr RandomStates::settled(Expr e) const {
  return expand_time_derivatives(in_terms_of_motion(system_, {&e, 1}).front());
}

/// [rows × roots]; states at which something has no value are left out, after some tries all of them.
std::vector<std::vector<double>> RandomStates::values(const std::vector<Expr>& roots, std::size_t rows) {
  const std::vector<Expr> symbols = symbols_of(roots);
  std::uniform_real_distribution<double> positive(0.5, 1.5), any(-1.2, 1.2);
  std::vector<std::vector<double>> out;
  for (std::size_t tries = 0; out.size() < rows && tries < 4 * rows + 40; ++tries) {
    Bindings at;
    for (const Expr& s : symbols) {
      const bool constant = s.role() == Role::Parameter || s.role() == Role::Constant || s.role() == Role::Time;
      at[s] = constant ? positive(random_) : any(random_);
    }
    std::vector<double> row = evaluate(roots, at);
    if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); })) out.push_back(std::move(row));
  }
  return out.size() == rows ? out : std::vector<std::vector<double>>();
}

bool RandomStates::vanishes(Expr e) {
  const Expr plain = settled(e);
  if (plain.is_zero()) return true;
  constexpr double surely_not = 1e-6;
  for (const auto& row : values({plain}, 2))
    if (std::abs(row.front()) > surely_not) return false;
  return vanish_for_given_signs(system_, {&plain, 1}).verdict == Verdict::Zero;
}

std::optional<std::vector<Rational>> RandomStates::combination(Expr sum, const std::vector<Expr>& terms) {
  constexpr std::size_t most = 40;
  if (terms.empty() || terms.size() > most) return std::nullopt;
  std::vector<Expr> roots;
  for (const Expr& term : terms) roots.push_back(settled(term));
  roots.push_back(settled(sum));
  auto rows = values(roots, 3 * terms.size() + 6);
  if (rows.empty()) return std::nullopt;
  std::vector<double> right;
  for (auto& row : rows) {
    right.push_back(row.back());
    row.pop_back();
  }
  const auto found = least_squares(rows, right);
  if (!found) return std::nullopt;
  std::vector<Rational> out;
  Expr rest = sum;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto b = simple_fraction((*found)[k]);
    if (!b) return std::nullopt;
    out.push_back(*b);
    rest = rest - *b * terms[k];
  }
  return vanishes(rest) ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace maupertuis
