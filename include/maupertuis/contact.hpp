#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/source.hpp>
#include <maupertuis/units.hpp>

#include <string>
#include <vector>

/// Inequalities of a mechanical system, and what happens at instants (docs/theory/contacts.md).
namespace maupertuis {

/// Coulomb's friction along a slip velocity v_t: while it slides λ_t = −μ N v_t/|v_t|, while it sticks v_t = 0 and
/// |λ_t| ≤ μ_s N. N is the force of the contact that it belongs to, or what the model says.
struct Friction {
  std::string name;               // of the contact, or of the coordinate
  std::vector<Expr> slip;         // v_t in q, q', t: one component, or two in space; empty: without friction
  std::vector<Expr> multipliers;  // λ_t while it sticks, one a component
  Expr kinetic, static_;  // μ, μ_s: coefficients of N; or where there is no N the limits of the force themselves
  Expr per_multiplier;    // N/λ where the gap is no distance, in kinetic and static_ already; empty: 1
  Expr normal;            // N, of a coordinate; empty: the force of the contact, or 1
  bool sticking = false;  // it never slides while the contact is closed
  Span span;
  bool present() const { return !slip.empty(); }
  bool in_space() const { return slip.size() == 2; }
};

/// g(q, t) ≥ 0. While it is closed g = 0 and its force is +λ ∂g/∂q with λ ≥ 0.
struct Contact {
  std::string name;     // as written; empty if it has none
  Expr gap;             // g, SI; no TimeDerivative nodes
  Expr multiplier;      // λ, Role::Multiplier
  Expr reaction;        // symbol: what `reaction(name)` stands for
  Expr restitution;     // e in [0, 1], of parameters and numbers
  Friction friction;    // its slip is empty where there is none
  Dimension dimension;  // of g
  Span span;
};

/// How several contacts share an impact: one after the other, the fastest first, or all at once by complementarity.
enum class ImpactLaw { Sequential, Simultaneous };

/// event hit when F = 0 rising : set x' = -x'
struct ModelEvent {
  enum class Action { Record, Stop, Set };
  struct Assignment {
    std::size_t coordinate = 0;
    int order = 0;  // 0: q, 1: q'
    Expr value;     // in q, q', t as they are before the event
    Span span;
  };
  std::string name;
  Expr function;      // F, in q, q', q'', t, multipliers and reactions
  int direction = 0;  // 1: rising through 0, −1: falling, 0: both
  Action action = Action::Record;
  std::vector<Assignment> sets;
  Span span;
};

}  // namespace maupertuis
