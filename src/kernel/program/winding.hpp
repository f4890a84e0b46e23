#pragma once
#include "kernel/program/program.hpp"

namespace maupertuis {

/// Cost: linear.
Winding winding_of(const Program& program);

}  // namespace maupertuis
