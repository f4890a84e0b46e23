#pragma once
#include <maupertuis/expression.hpp>

#include <span>
#include <vector>

namespace maupertuis {

/// Of each expression whether interval arithmetic excludes 0 at one of two random real points. All are evaluated
/// together, so that the cost is that of their common nodes; of those that are not seen, `zero_test` decides.
/// Precondition: no TimeDerivative nodes.
std::vector<bool> seen_nonzero(std::span<const Expr> expressions);

}  // namespace maupertuis
