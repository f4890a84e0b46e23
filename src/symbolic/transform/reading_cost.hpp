#pragma once
#include <maupertuis/expression.hpp>

#include <unordered_map>

namespace maupertuis::terms {

/// How much a reader has to take in: one for every name, a little for signs, exponents and numbers, more for brackets
/// and for angles with a multiple. So sin² θ is cheaper than 1/2 − 1/2 cos 2θ, 2 sin θ cos θ than sin 2θ, and
/// cos(θ1 − θ2) than the two products that make it.
class ReadingCost {
 public:
  double operator()(Expr e);

 private:
  double compute(Expr e);
  double of_power(Expr e);
  double of_product(Expr e);
  double of_circular(Expr e);

  std::unordered_map<NodeId, double> known_;
};

/// Digits that a reader sees: 3 of 9.81, 2 of 1/2, 9 of 0.00000005.
std::size_t digits_of(const Rational& value);

}  // namespace maupertuis::terms
