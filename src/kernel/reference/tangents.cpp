#include "kernel/reference/tangents_code.hpp"

namespace maupertuis::reference {

template void tangents<1>(const Memory&, double*, std::span<const sparse::Edge>);
template void tangents<8>(const Memory&, double*, std::span<const sparse::Edge>);

}  // namespace maupertuis::reference
