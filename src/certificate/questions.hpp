#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include "symbolic/evaluate/leaves.hpp"

#include <array>
#include <optional>

namespace maupertuis::certification {

/// An expression whose value along a path a check asks for, by its place in `Questions::roots`.
using Root = std::size_t;
using Roots = std::vector<Root>;

struct ForceQuestion {
  AppliedForce::Kind kind;
  Roots components, lever;
  std::size_t coordinate = 0;
};
struct ParticleQuestion {
  Root mass;
  Roots position;
};
struct ConstraintQuestion {
  Constraint::Level level;
  Root value, multiplier;   // of the model: φ or ψ, λ
  Root rate, acceleration;  // claimed
  Roots row;                // claimed: of A; empty: not asked
  Root bias = 0;            // claimed, with `row`
};
struct BodyQuestion {
  Roots inertia, rotation;  // by rows
};

/// Everything that the checks look at, gathered once so that one evaluation serves them all. Expressions of the model
/// (L, D, forces, positions) stand beside those that the derivation claims (R, p, h_E, …).
struct Questions {
  explicit Questions(const EquationsOfMotion& equations, bool with_matrix);

  /// Which roots the checks multiply with each other; they are linear in all others.
  evaluation::Products products() const;
  /// The same questions about formulas, one answer to all of them after the other.
  Questions about(std::vector<Expr> formulas) const;
  std::size_t answers() const { return roots.size() / asked; }

  const MechanicalSystem& system;
  std::vector<Expr> roots;  // [answers × asked]
  std::size_t asked = 0;

  // what the model says
  Root lagrangian, dissipation;
  std::vector<ForceQuestion> forces;
  Roots velocities, accelerations;
  // the same mechanics without T: particles, bodies, and the energies that are given beside them
  bool has_matter = false;
  const Body* stretching = nullptr;  // a body_without_rotation: then nothing is asked about matter
  std::vector<ParticleQuestion> particles;
  std::vector<BodyQuestion> bodies;
  Roots gravity;
  Root given_energies = 0;  // L without what particles, bodies and gravity give

  // what the derivation claims
  Roots residual, momenta, generalized_forces, dissipative_terms;
  Root energy_function, power;
  Roots mass_matrix, bias;  // empty: not asked
  std::vector<ConstraintQuestion> constraints;
  Roots constraint_forces;                                   // empty without constraints
  std::vector<std::array<std::size_t, 4>> unit_quaternions;  // coordinates w, x, y, z whose constraint is their norm

  /// A body whose rotation matrix is none, since nothing keeps its quaternion at norm 1; null if there is none.
  const Body* body_without_rotation() const;

 private:
  Root ask(Expr e);
  Roots ask(const ExprVector& list);
  void ask_about_matter();
  void ask_about_constraints(const EquationsOfMotion& equations, bool with_matrix);
};

}  // namespace maupertuis::certification
