#include "kernel/packed/engine.hpp"

#include "machine_code/processor.hpp"

#include <cmath>

namespace maupertuis::packed {

namespace baseline {
extern const Engine engine;
}
#ifdef MAUPERTUIS_X86_64
namespace avx2 {
extern const Engine engine;
}
namespace avx512 {
extern const Engine engine;
}
#endif

const Engine& engine() {
#ifdef MAUPERTUIS_X86_64
  if (vector_instructions() == VectorInstructions::Avx512) return avx512::engine;
  if (vector_instructions() == VectorInstructions::Avx2) return avx2::engine;
#endif
  return baseline::engine;
}

std::vector<Order> orders_of(double* rows, std::size_t stride, int count) {
  std::vector<Order> out;
  for (int number = 0; number < count; ++number) {
    const std::ptrdiff_t offset = number * static_cast<std::ptrdiff_t>(stride);
    const double k = number;
    const Reciprocal reciprocal = number == 0 ? Reciprocal{} : Reciprocal{1 / k, std::fma(-k, 1 / k, 1.0) / k};
    out.push_back({rows + offset, offset, {1, k + 1, (k + 1) * (k + 2)}, reciprocal, number});
  }
  return out;
}

}  // namespace maupertuis::packed
