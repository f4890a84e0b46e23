// Compiled with AVX-512 F, DQ, VL where the compiler knows them (cmake/InstructionSets.cmake).
#include "kernel/lanes/plan.hpp"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "kernel/lanes/expand.hpp"

maupertuis::lanes::Expanders maupertuis::lanes::avx512_expanders() { return expanders_of_this_file(); }
#else
maupertuis::lanes::Expanders maupertuis::lanes::avx512_expanders() { return {}; }
#endif
