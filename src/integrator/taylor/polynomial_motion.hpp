#pragma once
#include "integrator/taylor/step_size.hpp"
#include "disks/degrees.hpp"

#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Where every motion is a polynomial of second degree its steps need no error control, and no more orders than what is
/// followed along it: a flight under a constant force between two impacts. Else `usual`.
StepControl control_of(const Program& program, const StepControl& usual);

/// Which functions an expansion of this order knows wholly, since the motion and they are polynomials. [slots.size()]
std::vector<bool> functions_that_end(const Program& program, int order, std::span<const Slot> slots);

}  // namespace maupertuis::taylor
