// Compiled for what every processor of the kind has.
#include "integrator/ensemble/lane_steps_code.hpp"

maupertuis::ensemble::LaneSteps maupertuis::ensemble::baseline_steps() { return steps_of_this_file(); }
