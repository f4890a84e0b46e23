#pragma once
#include "kernel/packed/layout.hpp"
#include "kernel/straight_line/straight_line.hpp"

namespace maupertuis::unrolled {

/// The whole expansion of a small packed program: stages, convolutions, M₀⁻¹, corrections. Packs are wide values, the
/// newest coefficients are added last, so that a stage waits for the one before as late as possible.
///
/// Its arrays are those of packed::CompiledExpand: rows of `stride` doubles, whose leaves are set, q, q̇, the
/// coefficients of lanes, the constants. It is sound (straight::sound) where pivots are large and all q̈ finite.
/// Precondition: neither constraints nor selections.
straight::StraightLine unroll(const packed::PackedProgram& program, std::size_t stride, int order);

}  // namespace maupertuis::unrolled
