#include "kernel/lanes/lanes.hpp"

namespace maupertuis::lanes {

/// Odd: the orders of a slot are that many vectors apart, and so spread over all cache sets.
std::size_t row_stride(const Program& program) { return program.slots | 1; }

/// Room for a tangent of each slot in each direction, for the factors that make them, for M₀ and for what a stage
/// needs.
std::size_t scratch_size(const Program& program) {
  const std::size_t n = program.unknowns;
  return program.slots * (n + 2) + 2 * (program.terms.size() + program.instructions.size()) + n * n + 8 * n + 8;
}

}  // namespace maupertuis::lanes
