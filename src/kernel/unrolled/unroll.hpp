#pragma once
#include "kernel/packed/layout.hpp"
#include "kernel/straight_line/straight_line.hpp"

namespace maupertuis::unrolled {

/// In the order of packed::CompiledExpand.
enum Array : std::uint32_t {
  Rows,       // [orders][stride]; q, q̇ and the leaves are set
  Positions,  // [n] q and q̇ where they were written first, which are there sooner
  Velocities,
  Coefficients,  // of PackedProgram::coefficients
  Constants,     // of Program::constants
  arrays
};

/// The whole expansion of a small packed program: stages, convolutions, M₀⁻¹, corrections. Packs are wide values, the
/// newest coefficients are added last, so that a stage waits for the one before as late as possible. It is sound where
/// pivots are large and all q̈ finite. Precondition: neither constraints nor selections.
straight::StraightLine unroll(const packed::PackedProgram& program, std::size_t stride, int order);

}  // namespace maupertuis::unrolled
