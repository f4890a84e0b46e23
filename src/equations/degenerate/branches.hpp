#pragma once
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// A value with all put in that relations say about single states: z x' + (1 + z²) y with y = 0 is z x', where x' = 0
/// and z = 0 are two branches, which meet where the sum has no sign of them.
Expr with_known_states(Expr value, ExprVector relations, const ExprVector& states);

/// The factors of a product that can vanish, each once; the value itself where it is none.
ExprVector vanishing_factors(Expr value, const ExprVector& states);

/// Whether it is 0 there beside what changes of the states by their own sizes make of it.
bool is_zero_at(Expr value, const ExprVector& states, const Bindings& point);

}  // namespace maupertuis
