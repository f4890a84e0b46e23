#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>

#include <optional>
#include <string>

namespace maupertuis {

/// Equations in which distances that are |r| in a coordinate r are written as r or −r, as they are at a state. Beyond
/// r = 0 the same places are told by other coordinates, so that these are the equations of textbooks.
struct SignedDistances {
  EquationsOfMotion equations;
  std::vector<Expr> distances;  // r of |r|, greater than 0 at the state: perhaps −r of a coordinate r
  ExprMap roots;                // √(r² cos² φ + r² sin² φ) → r, as they stand in the energies
  std::string where;            // "r > 0"

  Expr with_signs(Expr e) const;
};

/// Distances are those between the ends of springs and dampers, and between points; other functions that switch stay.
/// Nothing where the energies hold none. Cost: a derivation.
std::optional<SignedDistances> signed_distances(const EquationsOfMotion& equations, const MotionState& state);

}  // namespace maupertuis
