#pragma once
#include "kernel/program/program.hpp"

#include <vector>

namespace maupertuis {

/// Switch functions whose sides only events and other such switch functions depend on: the motion, its integrals and
/// what is observed of it are the same on both. [switches]
std::vector<bool> switches_of_events_alone(const Program& program);

}  // namespace maupertuis
