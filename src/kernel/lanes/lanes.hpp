#pragma once
#include "kernel/program/program.hpp"

#include <cstddef>
#include <span>

/// W motions side by side: every number of the reference interpreter becomes W numbers, one a motion. The same contract
/// for every backend that does this, interpreted or compiled, and for every W.
namespace maupertuis::lanes {

/// Doubles of a row: slots, rounded up so that consecutive orders of a slot do not fall into one cache set.
/// Independent of W; a row of W motions has stride · W doubles, those of slot s at [s · W].
std::size_t row_stride(const Program& program);

/// Doubles of scratch memory, to be multiplied by W.
std::size_t scratch_size(const Program& program);

/// The stages first_stage … stages − 1 of section Dynamics.
///   rows       [orders][stride][W]. In: slots of One and Time at all orders, q and q̇ in rows 0 and 1. Out: every
///              coefficient of the slots of Dynamics up to the order that the stages reach.
///   constants  [program.constants][W], evaluated: each lane may have its own parameters.
///   quality    [W] out: the smallest pivot of M₀, scaled to a unit diagonal, in units of the largest; NaN where
///              something is not finite. A motion of low quality is to be repeated by itself, with a solver that
///              pivots.
///   scratch    [scratch_size(program)][W]
/// All pointers are aligned to 64 bytes. The results of a lane depend neither on W nor on the other lanes, to the bit.
using Expand = void (*)(double* rows, const double* constants, double* quality, double* scratch, int stages);

}  // namespace maupertuis::lanes
