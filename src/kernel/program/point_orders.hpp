#pragma once
#include "kernel/program/program.hpp"

#include <vector>

namespace maupertuis {

/// The highest order at which each instruction of section AtPoint is needed for the observables, which are read at
/// order 0 alone; −1: it is not, or it is of another section. Most are needed at order 0, what a derivative by t reads
/// at one more. [instructions]
std::vector<int> point_orders(const Program& program);

/// Whether unrolled code has the observables too: what they are made of follows from section Dynamics by instructions
/// that straight lines have.
bool are_points_unrolled(const Program& program);

}  // namespace maupertuis
