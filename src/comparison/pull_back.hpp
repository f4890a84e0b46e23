#pragma once
#include <maupertuis/comparison.hpp>

#include <string>
#include <utility>

namespace maupertuis::comparison {

/// Rebuilds expressions of one context in another, symbols replaced. Precondition: no TimeDerivative nodes, every
/// symbol has a replacement.
ExprVector carried_over(std::span<const Expr> roots, const ExprMap& replacements, Context& to);

/// A's functions along the mapped curve x = f(q, t): x, ẋ, ẍ replaced by f and its time derivatives, parameters by
/// their counterparts, so that what comes out is a function of B's q, q̇, q̈, t.
class PullBack {
 public:
  /// Parameters that differ in value are errors, those without a counterpart are notes.
  PullBack(const MechanicalSystem& a, const CoordinateMap& map, Diagnostics& diagnostics);

  ExprVector operator()(std::span<const Expr> of_a) const;
  Expr operator()(Expr of_a) const { return (*this)(std::span<const Expr>(&of_a, 1)).front(); }

  const ExprVector& positions() const { return positions_; }          // f [n_A]
  const ExprVector& velocities() const { return velocities_; }        // df/dt
  const ExprVector& accelerations() const { return accelerations_; }  // d²f/dt²

 private:
  const MechanicalSystem& a_;
  Context& context_;
  ExprVector positions_, velocities_, accelerations_;
  ExprMap replacements_;
};

/// What messages call two models: one without a name is the first or the second, and so are two of one name.
std::pair<std::string, std::string> names_of(const MechanicalSystem& a, const MechanicalSystem& b);

}  // namespace maupertuis::comparison
