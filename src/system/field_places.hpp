#pragma once
#include <maupertuis/field_statements.hpp>
#include <maupertuis/field_system.hpp>

#include "system/value.hpp"

#include <optional>
#include <string>

namespace maupertuis::elaboration {

struct Elaboration;

/// Whether coordinates, bodies, energies or constraints stand beside the fields.
bool couples_mechanics(Elaboration& e);
/// E0505 for statements that do not go with fields.
void refuse_beside_fields(Elaboration& e);
/// The coordinate of the mechanical system that is a jet of a field at a place, made where it is new.
Value coordinate_at_place(Elaboration& e, const syntax::Expression& x, const FieldJet& jet, Expr place);
/// u_x(l) of u_tx(l): what the symbols of a value at a place are called, the time derivatives being their order.
std::string name_of_place_value(Elaboration& e, const syntax::Expression& x, const FieldJet& jet);
/// Its symbol where it is known; nothing where no body takes hold of the field there.
std::optional<Expr> attached_symbol(Elaboration& e, const FieldJet& jet, Expr place);
/// The place in MechanicalSystem::coordinates of u(l) or u_x(l), which becomes one where it is new. Nothing after a
/// mistake, or where it is no value but a velocity.
std::optional<std::size_t> coordinate_of_place(Elaboration& e, const syntax::Expression& x);
/// force u(l) = F, of anything
void force_on_place(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet, Span span);
/// Clashes of places with boundary conditions; fields without a place, coordinates in densities. After all else.
void check_places(Elaboration& e);

}  // namespace maupertuis::elaboration
