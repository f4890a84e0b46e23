#pragma once
#include "analysis/invariants/motion_sampler.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace maupertuis::invariants {

/// number · root · Π parameters^exponents · numerator/denominator: a coefficient as a function of the parameters.
struct Coefficient {
  Rational number = 1;
  Expr root;                        // √3; empty: 1
  std::vector<Rational> exponents;  // [parameters], halves
  Expr numerator, denominator;      // polynomials of parameters; empty: 1
  bool is_monomial() const { return !numerator; }
};
Expr expression(const Coefficient& c, const std::vector<Expr>& parameters, Context& context);

/// A root of a number, with its image in the field.
struct NumberRoot {
  Expr root;
  Value image = 0;
};

/// Finds functions of the parameters from their values over a prime field.
///
/// A coefficient that is multiplied by a power of 2 when the root of a parameter is doubled (of 3 when tripled, …) is
/// homogeneous in that parameter; one that is so in all of them is a number times a monomial. What is left is a
/// fraction of two polynomials in the other parameters, found by linear algebra at random points, by rising degree.
class ParameterFit {
 public:
  /// The coefficients of all vectors at these parameters; nothing where no points were found.
  using Solver = std::function<std::optional<std::vector<std::vector<Value>>>(const ParameterRoots&)>;
  /// `roots`: numbers in homogeneous coefficients may be multiples of one of them.
  ParameterFit(MotionSampler& sampler, Solver solver, std::vector<NumberRoot> roots = {})
      : sampler_(sampler), solver_(std::move(solver)), roots_(std::move(roots)) {}

  /// Entry `entry` of vector `vector`, or nothing where it is too long.
  std::optional<Coefficient> find(std::size_t vector, std::size_t entry);
  /// Whether the values at the parameters could be computed at all.
  bool prepare();

 private:
  struct Point {
    ParameterRoots roots;
    std::vector<std::vector<Value>> values;
  };
  std::optional<Point> point_at(ParameterRoots roots);
  bool scale_parameter(std::size_t i);
  const Point* random_point(std::size_t index);
  std::optional<int> power_of(int base, Value ratio) const;
  Value monomial(const std::vector<int>& exponents, const ParameterRoots& roots) const;
  std::optional<Coefficient> fit_monomial(const std::vector<int>& exponents, std::size_t vector, std::size_t entry);
  std::optional<Coefficient> fit_fraction(const std::vector<int>& exponents, const std::vector<std::size_t>& others,
                                          int degree, std::size_t vector, std::size_t entry);
  Coefficient with_powers(const std::vector<int>& exponents) const;
  std::optional<Expr> polynomial(const std::vector<std::vector<int>>& powers, const std::vector<Value>& coefficients,
                                 const std::vector<std::size_t>& others) const;

  MotionSampler& sampler_;
  Solver solver_;
  std::vector<NumberRoot> roots_;
  std::optional<Point> base_;
  std::vector<Point> scaled_;  // [parameters] the root of one multiplied by factors_
  std::vector<int> factors_;   // [parameters] 2, or another square modulo p where roots have no value then
  std::vector<Point> random_;
};

}  // namespace maupertuis::invariants
