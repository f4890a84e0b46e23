#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <vector>

namespace maupertuis::invariants {

/// A place in space that moves with the system.
struct WorldPoint {
  ExprVector position;  // [axes]
  ExprVector velocity;  // [axes]
  Expr mass;            // empty: none of its own
};

/// One particle, or the relative motion r₁ − r₂ of two with the reduced mass: what has an angular momentum and a
/// Runge-Lenz vector of its own.
struct Orbit {
  ExprVector position, velocity;  // [axes]; empty: neither one nor two particles
  Expr mass;
  bool relative = false;
};

/// The points of a model, for names: how a symmetry moves them says whether it is a translation, a rotation, a boost.
/// Where a model gives its energies without points, coordinates that are called x, y, z (x1, y1, …) are taken as those
/// of particles.
struct World {
  std::string axes;  // "xy", "xyz"; of particles guessed from names those that occur
  std::vector<WorldPoint> points;
  bool from_names = false;
  // Of the masses: empty where the model has no points. Functions of q, q', t, whether conserved or not.
  ExprVector momentum;          // [axes] Σ m v
  ExprVector angular_momentum;  // [1 or 3] about O, bodies with their spin
  ExprVector mass_moment;       // [axes] Σ m r
};
World world_of(const EquationsOfMotion& equations);
Orbit orbit_of(const World& world);
/// a × b: one component in the plane, none on a line.
ExprVector cross(const ExprVector& a, const ExprVector& b);

}  // namespace maupertuis::invariants
