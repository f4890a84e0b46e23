#include "kernel/sparse/loops.hpp"

#include "machine_code/processor.hpp"

namespace maupertuis::sparse {
namespace {

Loops best_loops() {
  if (vector_instructions() >= VectorInstructions::Avx512 && avx512_loops().factor) return avx512_loops();
  if (vector_instructions() >= VectorInstructions::Avx2 && avx2_loops().factor) return avx2_loops();
  return baseline_loops();
}

}  // namespace

const Loops& loops() {
  static const Loops best = best_loops();
  return best;
}

}  // namespace maupertuis::sparse
