#include "kernel/reference/memory_code.hpp"

namespace maupertuis::reference {

template struct MemoryOf<double>;
template void compute_constants(Memory&, std::span<const double>, std::span<const std::int8_t>);
template void prepare_terms(Memory&);
template void set_leaves(Memory&, const double&, int);
template double term_size(const Memory&, const Instruction*, Slot);

}  // namespace maupertuis::reference
