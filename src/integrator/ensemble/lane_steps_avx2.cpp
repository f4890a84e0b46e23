// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#include "integrator/ensemble/lane_steps.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#include "integrator/ensemble/lane_steps_code.hpp"

maupertuis::ensemble::LaneSteps maupertuis::ensemble::avx2_steps() { return steps_of_this_file(); }
#else
maupertuis::ensemble::LaneSteps maupertuis::ensemble::avx2_steps() { return {}; }
#endif
