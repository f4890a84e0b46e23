#pragma once
#include <maupertuis/expression.hpp>

namespace maupertuis {

/// ∂f/∂(argument `index`) of one node, its arguments held as independent variables. Differentiation, the total time
/// derivative and the reverse sweep are three ways to chain these.
/// A condition has derivative 0; so have sign and step, whose jumps are switches of a run and not forces.
Expr partial_derivative(Expr node, std::size_t index);

}  // namespace maupertuis
