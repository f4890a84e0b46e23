#include "analysis/linearization/friction_sign.hpp"

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// By its form, where it has a value: even powers and even roots, and sums and products of what is never negative.
bool is_never_negative(Expr e) {
  if (e.is_number()) return e.number().to_double() >= 0;
  if (e.is(Kind::Sum) || e.is(Kind::Product)) {
    for (std::size_t i = 0; i < e.size(); ++i)
      if (!is_never_negative(e[i])) return false;
    return true;
  }
  if (e.is(Kind::Power)) {
    const Rational* exponent = e[1].number_or_null();
    const auto parts = exponent ? exponent->small() : std::nullopt;
    return is_never_negative(e[0]) || (parts && (parts->numerator % 2 == 0 || parts->denominator % 2 == 0));
  }
  return e.is(Kind::Pi) || e.is(Kind::Abs) || e.is(Kind::Exp) || e.is(Kind::Cosh);
}

bool is_constant_form(Expr power, const ExprVector& velocities) {
  const auto n = static_cast<Index>(velocities.size());
  Matrix form(n, n);
  const std::vector<Expr> slopes = gradient(power, velocities);
  for (Index i = 0; i < n; ++i) {
    const std::vector<Expr> row = gradient(slopes[static_cast<std::size_t>(i)], velocities);
    for (Index j = 0; j < n; ++j) {
      const Expr& entry = row[static_cast<std::size_t>(j)];
      if (!symbols_of({&entry, 1}).empty()) return false;
      form(i, j) = evaluate(entry, {});
    }
  }
  constexpr double rounding = 1e-14;
  const Vector values = symmetric_eigen(form).values;
  return values.minCoeff() >= -rounding * values.cwiseAbs().maxCoeff();
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
