#include "kernel/dynamics/evaluate.hpp"

#include "kernel/program/processor.hpp"

namespace maupertuis::dynamics {

Evaluate best_evaluate() {
  if (vector_instructions() >= VectorInstructions::Avx512 && avx512_evaluate()) return avx512_evaluate();
  if (vector_instructions() >= VectorInstructions::Avx2 && avx2_evaluate()) return avx2_evaluate();
  return baseline_evaluate();
}

}  // namespace maupertuis::dynamics
