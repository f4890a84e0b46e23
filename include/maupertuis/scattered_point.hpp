#pragma once
#include <maupertuis/evaluate.hpp>

#include <span>

namespace maupertuis {

/// Numbers between 0.4 and 1.4 for symbols, by multiples of the golden ratio: a point at which nothing vanishes by
/// chance. Parameters and constants are the same at every `turn`, the others are not.
Bindings scattered_point(std::span<const Expr> symbols, int turn = 0);

}  // namespace maupertuis
