// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX2__) && defined(__FMA__)
#include "kernel/sparse/loops_code.hpp"

maupertuis::sparse::Loops maupertuis::sparse::avx2_loops() { return loops_of_this_file(); }
#else
#include "kernel/sparse/loops.hpp"

maupertuis::sparse::Loops maupertuis::sparse::avx2_loops() { return {}; }
#endif
