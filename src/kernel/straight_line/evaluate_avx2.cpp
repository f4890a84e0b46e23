// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX2__) && defined(__FMA__)
#include "kernel/straight_line/evaluate_code.hpp"

maupertuis::straight::Evaluate maupertuis::straight::avx2_evaluate() { return evaluate; }
#else
#include "kernel/straight_line/evaluate.hpp"

maupertuis::straight::Evaluate maupertuis::straight::avx2_evaluate() { return nullptr; }
#endif
