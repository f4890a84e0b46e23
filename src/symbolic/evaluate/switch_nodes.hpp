#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <vector>

namespace maupertuis::evaluation {

/// g of a node that switches; an empty handle for all others.
Expr difference_of(Expr node);

/// −g, term by term where it is a sum: as b − a is written beside a − b.
Expr opposite(Expr g);

/// The branches of some functions that are in force at a point.
class Branches {
 public:
  explicit Branches(std::vector<Expr> functions);

  const std::vector<Expr>& functions() const { return functions_; }
  /// The functions between two points that lie close together: of what switches, branches that other sides would have
  /// are left out. What has not the same sign at both, or is 0 to within 1e-9 of the size of its terms, keeps both
  /// branches. Precondition: the points have every symbol. Cost: two evaluations in double; then what is in force alone
  /// is visited.
  std::vector<Expr> in_force(const Bindings& from, const Bindings& to) const;

 private:
  std::vector<Expr> functions_;
  Tape tape_;
  std::vector<bool> switching_;  // [positions] a node that switches stands there or below
};

}  // namespace maupertuis::evaluation
