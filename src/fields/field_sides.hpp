#pragma once
#include <maupertuis/fields.hpp>

#include <vector>

/// What stands at the sides of a domain.
namespace maupertuis {

/// By the zero test.
bool vanishes_identically(Expr e);

std::vector<BoundaryCondition::Side> sides_across(std::size_t variable);

/// With the variable across a side at its value there.
Expr on_side(const FieldSystem& system, Expr e, BoundaryCondition::Side side);

/// Whether what is given at a side stands in the place of a natural condition.
bool is_given(const FieldSystem& system, const NaturalCondition& natural, BoundaryCondition::Side side);

/// Whether bodies take hold of a field at a side, so that their condition stands in the place of the natural one.
bool is_held_by_bodies(const FieldEquations& equations, const NaturalCondition& natural, BoundaryCondition::Side side);

/// What the forces at a side add to a natural condition there: p + F = 0 at the right and the top, p − F = 0 at the
/// left and the bottom, and likewise m.
Expr force_at(const FieldSystem& system, const NaturalCondition& natural, BoundaryCondition::Side side);

/// E0642 where a density holds second derivatives in space, its equation none above the second, and an end has two
/// conditions: the equation takes one at each end.
bool refuse_too_many_conditions(const FieldEquations& equations, Diagnostics& diagnostics);

}  // namespace maupertuis
