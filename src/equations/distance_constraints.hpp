#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <optional>
#include <string>

namespace maupertuis {

/// A place that a rod can end at: a point or a body of the model, or the origin O.
struct RodEnd {
  std::string name;
  ExprVector position;
  bool fixed = false;  // in space: no coordinate and no time in its position
};

/// φ is a function of the distance d of two places alone.
struct RodConstraint {
  RodEnd from, to;
  Expr distance;  // d; a constant length where φ = k (d² − l²) shows it
  Expr slope;     // dφ/d(d²)
};

/// Nothing if no pair of places has ∇φ parallel to ∇d², proved by the zero test.
std::optional<RodConstraint> find_rod(const MechanicalSystem& system, const Constraint& constraint);

}  // namespace maupertuis
