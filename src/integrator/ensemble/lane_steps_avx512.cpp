// Compiled with AVX-512 F, DQ, VL where the compiler knows them (cmake/InstructionSets.cmake).
#include "integrator/ensemble/lane_steps.hpp"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "integrator/ensemble/lane_steps_code.hpp"

maupertuis::ensemble::LaneSteps maupertuis::ensemble::avx512_steps() { return steps_of_this_file(); }
#else
maupertuis::ensemble::LaneSteps maupertuis::ensemble::avx512_steps() { return {}; }
#endif
