#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

/// Physics lint: rules about a system whose text is in order. A rule is a function; each says one kind of thing.
namespace maupertuis::lint_rules {

/// What the rules share.
struct Subject {
  const Model& model;
  const MechanicalSystem& system;
  const SourceText& source;
  Diagnostics& diagnostics;
  ReadingOrder order;
  Expr lagrangian;        // in q, q', t; L + λ G where integrals are held
  ExprVector velocities;  // [n]
  ExprVector momenta;     // ∂L/∂q̇ [n]

  Subject(const Model& model, const SourceText& source, Diagnostics& diagnostics);
  std::size_t freedoms() const { return system.coordinates.size(); }
  /// A formula as a reader would write it; empty if it is too long for a message.
  std::string show(Expr e) const;
};

/// E0406: nothing depends on the coordinate. The coordinates that it named.
std::vector<bool> unused_coordinates(Subject& s);
/// E0407, E0408, E0409, E0417: M is singular wherever it is sampled, also on the directions that the constraints leave;
/// N0428: they make it regular; W0410: M is not positive definite; W0439: M is singular at the start alone. True after
/// an error.
bool mass_matrix_rules(Subject& s, const std::vector<bool>& unused);
/// A frame or body whose quaternion nothing holds at norm 1.
struct Stretched {
  std::string name;
  Span span;
};
std::optional<Stretched> stretched_rotation(const Subject& s);
/// W0434: an energy is nowhere a real number.
void values(Subject& s);
/// W0427: there is one.
void quaternion_norms(Subject& s);
/// E0411: `T = …` beside points says something else than the points. True where T or L is such a one: then what the
/// mass matrix lacks is no second mistake.
bool claims(Subject& s);
/// W0412: a term of L that is a total time derivative.
void total_derivatives(Subject& s);
/// W0413: weight enters by `gravity` and again by V.
void gravity_twice(Subject& s);
/// W0442: `T += …` or `V += …` says again what a point, a body or a spring gives.
void parts_twice(Subject& s);
/// W0421: T without a velocity; W0422: D without a velocity.
void energies_without_velocity(Subject& s);
/// W0419: the D that is written feeds energy in, wherever it was looked at.
void negative_dissipation(Subject& s);

/// W0438: two names, or a name and a momentum or the energy function, that formulas print as one symbol.
void names_printed_alike(Subject& s);

/// E0430, E0431, E0432: an energy, a position or a momentum that jumps at a switch.
void jumps(Subject& s);

/// A deterministic sample of the state near the start, with the values of the parameters. `attempt` varies it.
Bindings sample(const Subject& s, int attempt);

}  // namespace maupertuis::lint_rules
