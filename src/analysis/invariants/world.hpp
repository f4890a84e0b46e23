#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <vector>

namespace maupertuis::invariants {

/// A place in space that moves with the system.
struct WorldPoint {
  ExprVector position;   // [axes]
  ExprVector velocity;   // [axes]
};

/// The points of a model, for names: how a symmetry moves them says whether it is a translation, a rotation, a boost.
/// Where a model gives its energies without points, coordinates that are called x, y, z (x1, y1, …) are taken as those of particles.
struct World {
  std::string axes;                 // "xy", "xyz"; of particles guessed from names those that occur
  std::vector<WorldPoint> points;
  bool from_names = false;
  // Of the masses: empty where the model has no points. Functions of q, q', t, whether conserved or not.
  ExprVector momentum;              // [axes] Σ m v
  ExprVector angular_momentum;      // [1 or 3] about O, bodies with their spin
  ExprVector mass_moment;           // [axes] Σ m r
};
World world_of(const EquationsOfMotion& equations);

}  // namespace maupertuis::invariants
