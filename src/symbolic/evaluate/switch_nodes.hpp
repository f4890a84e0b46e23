#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <memory>
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
  ~Branches();
  Branches(Branches&&) noexcept;
  Branches& operator=(Branches&&) noexcept;

  const std::vector<Expr>& functions() const { return functions_; }
  /// The functions between two points that lie close together: of what switches, branches that other sides would have
  /// are left out. What has not the same sign at both, or is 0 to within 1e-9 of the size of its terms, keeps both
  /// branches. Precondition: the points have every symbol. Cost: what is in force, and the conditions before it, are
  /// evaluated in double at both points.
  std::vector<Expr> in_force(const Bindings& from, const Bindings& to);

 private:
  std::vector<Expr> functions_;
  std::unique_ptr<const Tape> tape_;
  std::vector<bool> switching_;  // [positions] a node that switches stands there or below
  struct Points;
  std::unique_ptr<Points> points_;
};

}  // namespace maupertuis::evaluation
