#include "fields/polynomial_division.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "fields/field_sides.hpp"

namespace maupertuis {
namespace {

/// From the lowest; nothing where e is no polynomial. The last is not 0.
std::optional<std::vector<Expr>> coefficients_of(Expr e, Expr x) {
  constexpr int most = 24;
  std::vector<Expr> out;
  const Expr zero = x.context().number(0);
  Rational factorial = 1;
  for (int n = 0; n <= most; ++n) {
    if (n > 0) factorial = factorial * Rational(n);
    const Expr flat = expand(e);
    if (flat) e = flat;
    out.push_back(substitute(e, {{x, zero}}) * (Rational(1) / factorial));
    if (vanishes_identically(e)) {
      while (!out.empty() && vanishes_identically(out.back())) out.pop_back();
      return out;
    }
    e = differentiate(e, x);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<Expr>> remainder_of_division(Expr dividend, Expr divisor, Expr x) {
  auto rest = coefficients_of(dividend, x);
  const auto by = coefficients_of(divisor, x);
  if (!rest || !by || by->size() < 2) return std::nullopt;
  while (rest->size() >= by->size()) {
    const Expr head = rest->back();
    const std::size_t shift = rest->size() - by->size();
    rest->pop_back();
    for (Expr& c : *rest) c = c * by->back();
    for (std::size_t i = 0; i + 1 < by->size(); ++i) (*rest)[shift + i] = (*rest)[shift + i] - head * (*by)[i];
    while (!rest->empty() && vanishes_identically(rest->back())) rest->pop_back();
  }
  if (rest->empty()) rest->push_back(x.context().number(0));
  return rest;
}

}  // namespace maupertuis
