#pragma once
#include "kernel/program/program.hpp"

#include <vector>

namespace maupertuis {

/// Switch functions whose sides only events and other such switch functions depend on: the motion, its integrals and
/// what is observed of it are the same on both. [switches]
std::vector<bool> switches_of_events_alone(const Program& program);

/// Switch functions on whose sides the value of a slot depends at a given motion: its formula changes where they do.
/// Accelerations and multipliers depend on those of the equations. [switches]. Cost: the length of the program.
std::vector<bool> switches_read_by(const Program& program, Slot slot);

}  // namespace maupertuis
