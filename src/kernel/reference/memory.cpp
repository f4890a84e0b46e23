#include "kernel/reference/memory_code.hpp"

namespace maupertuis::reference {

template struct MemoryOf<double>;
template double compute_constant(const Program&, std::size_t, std::span<const double>, std::span<const std::int8_t>,
                                 std::span<const double>, std::vector<double>&);
template void compute_constants(const Program&, std::span<const double>, std::span<const std::int8_t>,
                                std::span<double>);
template void set_leaves(Memory&, const double&, int);
template double term_size(const Memory&, const Instruction*, Slot);

}  // namespace maupertuis::reference
