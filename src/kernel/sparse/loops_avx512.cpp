// Compiled with AVX-512 F, DQ, VL where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "kernel/sparse/loops_code.hpp"

maupertuis::sparse::Loops maupertuis::sparse::avx512_loops() { return loops_of_this_file(); }
#else
#include "kernel/sparse/loops.hpp"

maupertuis::sparse::Loops maupertuis::sparse::avx512_loops() { return {}; }
#endif
