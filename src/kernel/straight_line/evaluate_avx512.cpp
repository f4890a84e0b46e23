// Compiled with AVX-512 F, DQ, VL where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "kernel/straight_line/evaluate_code.hpp"

maupertuis::straight::Evaluate maupertuis::straight::avx512_evaluate() { return evaluate; }
#else
#include "kernel/straight_line/evaluate.hpp"

maupertuis::straight::Evaluate maupertuis::straight::avx512_evaluate() { return nullptr; }
#endif
