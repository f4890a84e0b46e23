// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX2__) && defined(__FMA__)
#include "kernel/dynamics/evaluate_code.hpp"

maupertuis::dynamics::Evaluate maupertuis::dynamics::avx2_evaluate() { return evaluate; }
#else
#include "kernel/dynamics/evaluate.hpp"

maupertuis::dynamics::Evaluate maupertuis::dynamics::avx2_evaluate() { return nullptr; }
#endif
