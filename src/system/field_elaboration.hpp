#pragma once
#include <maupertuis/field_statements.hpp>
#include <maupertuis/field_system.hpp>

#include "system/elaboration.hpp"

#include <optional>

/// What the parts of a field's statements share: its space and names (fields.cpp), its density (field_density.cpp),
/// what acts at its ends (field_boundaries.cpp), its values (field_values.cpp).
namespace maupertuis::elaboration {

/// Calls `visit(clause, span of the statement)` on every field statement that says a `Clause`.
template <class Clause, class Visit>
void each_clause(const Elaboration& e, Visit visit) {
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* f = std::get_if<syntax::FieldStatement>(&s.body))
      if (const auto* clause = std::get_if<Clause>(&f->said->body)) visit(*clause, s.span);
}

inline FieldSystem& system_of(Elaboration& e) { return e.fields->system; }

/// The derivative of a field that a name or a value at a place means; nothing where it is none, or that of a given
/// field.
std::optional<FieldJet> jet_named(Elaboration& e, const syntax::Expression& x);
/// Inputs with a formula as that formula, and d/dt of what is known carried out.
Expr drives_as_formulas(Elaboration& e, Expr value);

/// density = …, dissipation density = …
void densities(Elaboration& e);
/// force density u = f
void force_density(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet);

/// boundary left u = 0, boundary = …
void boundaries(Elaboration& e);
/// E0285 where the density lets an end have one condition, and two are given. After densities and boundaries.
void refuse_slopes_beside_values(Elaboration& e);
/// force density u = f, force u(l) = F
void forces(Elaboration& e);

}  // namespace maupertuis::elaboration
