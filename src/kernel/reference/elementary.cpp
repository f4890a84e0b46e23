#include "kernel/reference/elementary_code.hpp"

namespace maupertuis::reference {

template double elementary(Kind, const double&, const double&);
template double constant_operation(Kind, std::span<const double>);

}  // namespace maupertuis::reference
