#pragma once
#include "kernel/program/graph.hpp"

namespace maupertuis::lowering {

/// The terms of a sum with α cos u · dʳ(sin u + x)/dtʳ − α sin u · dʳ(cos u + y)/dtʳ written as α dʳu/dtʳ + α cos u ·
/// dʳx/dtʳ − α sin u · dʳy/dtʳ, r = 1 or 2, where no more products are left: what a point that turns about another one
/// is accelerated across its radius. No sum over orders is needed for that. Cost about linear in the number of terms.
std::vector<Term> collect_rotations(Graph& graph, std::vector<Term> terms);

}  // namespace maupertuis::lowering
