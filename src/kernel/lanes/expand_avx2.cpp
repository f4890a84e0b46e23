// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#include "kernel/lanes/plan.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#include "kernel/lanes/expand.hpp"

maupertuis::lanes::Expanders maupertuis::lanes::avx2_expanders() { return expanders_of_this_file(); }
#else
maupertuis::lanes::Expanders maupertuis::lanes::avx2_expanders() { return {}; }
#endif
