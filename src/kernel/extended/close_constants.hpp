#pragma once
#include "kernel/program/program.hpp"

#include <cstdint>
#include <span>

namespace maupertuis::extended {

/// The constants of a program [constants], right to some units in the last place of double also where terms cancel, as
/// in cos(1/1024) − 1 + 1/2097152. Parameters count as exact. In double, with the running error of each beside it; what
/// that spoils is computed with 448 bits from literals and parameters on, and rounded once.
void compute_close_constants(const Program& program, std::span<const double> parameters,
                             std::span<const std::int8_t> sides, std::span<double> constants);

}  // namespace maupertuis::extended
