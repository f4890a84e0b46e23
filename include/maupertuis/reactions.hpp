#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// A force as an arrow: at a point, in world axes.
struct ForceArrow {
  std::string point;    // its name in the model
  ExprVector position;  // [dimension] m
  ExprVector force;     // [dimension] N
};

/// The force or torque with which a constraint holds, in words and in newtons or newton-metres.
struct Reaction {
  enum class Kind {
    Tension,      // in a rod between two points: positive when it pulls them together
    Contact,      // on one point, along ∇φ: positive towards increasing left − right
    Multiplier,   // λ itself, a force or a torque: positive towards increasing left − right
    Generalized,  // λ |∂φ/∂q| over the lengths, or over the angles: positive towards increasing left − right
    Released,     // of a parameter that is held: `reaction rod = release l1`
  };
  Kind kind = Kind::Multiplier;
  std::string name;      // as written, or the label of the constraint
  Expr symbol;           // what `reaction(name)` stands for
  Expr value;            // in q, q', q'', λ, u, t; empty where the model does not determine it: see `sentence`
  Dimension dimension;   // of the value
  std::string sentence;  // sign and meaning
  std::vector<ForceArrow> arrows;  // where it is known on which points it acts: the force on each of them
};

/// Of every constraint, in the order of the system, then of every contact with a name (in λ of the contact, which is 0
/// while it is open), then of every `reaction NAME = release PARAMETER`.
/// Signs: with φ = left − right the force on the coordinates is λ ∂φ/∂q. Whether φ fixes the distance d of two points
/// (∇φ parallel to ∇d²) is decided by the zero test; then the tension is −λ dφ/dd. A released parameter p is held by
/// Q = Σ m r̈·∂r/∂p + Σ d/dt(I ω)·∂θ/∂p + ∂V/∂p + ∂D/∂ṗ − Σ F·∂r/∂p − Σ τ·∂θ/∂p − λ·∂φ/∂p at constant p, which is
/// d/dt ∂L/∂ṗ − ∂L/∂p − (work of the forces) with p as a coordinate; the tension is −Q.
/// Cost: zero tests on the pairs of points that depend on the coordinates of φ and on no others.
std::vector<Reaction> reactions(const EquationsOfMotion& equations);

}  // namespace maupertuis
