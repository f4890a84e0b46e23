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

/// The pair of places of which φ is the distance or its square, but for sign and constant; else the only one with ∇φ
/// parallel to ∇d², proved by the zero test. Nothing where there is none, or several that are neither.
std::optional<RodConstraint> find_rod(const MechanicalSystem& system, const Constraint& constraint);

}  // namespace maupertuis
