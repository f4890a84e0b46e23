#include "analysis/linearization/friction_sign.hpp"

#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <utility>

namespace maupertuis {
namespace {

/// Of a symmetric matrix of numbers, by exact elimination: no pivot is negative, and a row whose pivot is 0 is 0.
bool has_no_negative_eigenvalue(std::vector<std::vector<Rational>> a) {
  const Rational zero(0);
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k][k] < zero) return false;
    for (std::size_t i = k + 1; i < a.size(); ++i) {
      if (a[k][k] == zero && a[i][k] != zero) return false;
      if (a[i][k] == zero) continue;
      const Rational part = a[i][k] / a[k][k];
      for (std::size_t j = k; j < a.size(); ++j) a[i][j] = a[i][j] - part * a[k][j];
    }
  }
  return true;
}

/// ½ q̇ᵀ A q̇ and nothing beside it, with numbers in A.
bool is_constant_form(Expr power, const ExprVector& velocities) {
  const std::vector<Expr> slopes = gradient(power, velocities);
  std::vector<std::vector<Rational>> form(velocities.size());
  Expr rest = power * Rational(2);
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    rest = rest - velocities[i] * slopes[i];  // Euler: 0 for the second degree
    for (const Expr& entry : gradient(slopes[i], velocities)) {
      if (!entry.is_number()) return false;
      form[i].push_back(entry.number());
    }
  }
  return zero_test({&rest, 1}).verdict == Verdict::Zero && has_no_negative_eigenvalue(std::move(form));
}

/// q̇·∂D/∂q̇ = k D (Euler), for the degrees of dry, viscous and quadratic friction.
bool is_homogeneous(Expr d, Expr power) {
  for (const int degree : {1, 2, 3}) {
    const Expr difference = power - d * Rational(degree);
    if (zero_test({&difference, 1}).verdict == Verdict::Zero) return true;
  }
  return false;
}

}  // namespace

bool friction_never_gives(const PointEquations::Impl& e) {
  const Expr given = e.system->dissipation_function();
  if (given.is_zero()) return true;
  const Expr d = substitute(expand_time_derivatives({&given, 1}), exact_parameters(e)).front();
  ExprVector velocities;
  for (const Coordinate& c : e.system->coordinates) velocities.push_back(c.velocity);
  const std::vector<Expr> forces = gradient(d, velocities);
  Expr power = e.system->context->number(0);
  for (std::size_t i = 0; i < forces.size(); ++i) power = power + velocities[i] * forces[i];
  if (is_never_negative(power)) return true;
  if (is_never_negative(d) && is_homogeneous(d, power)) return true;
  return is_constant_form(power, velocities);
}

}  // namespace maupertuis
