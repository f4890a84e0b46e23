#pragma once
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// The first variation δe of each root when symbols of order 0 vary as `variations` tells: δ(q) = δq, δ(q') = d/dt δq,
/// …, and δ(d/dt u) = d/dt(δu), d/dt kept as an operator. Symbols that are not listed, and t, stay as they are. Cost
/// O(nodes) for all roots together; functions with switches vary as the branch in force does.
std::vector<Expr> variation(std::span<const Expr> roots, const ExprMap& variations);

}  // namespace maupertuis
