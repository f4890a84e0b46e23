#include "kernel/interpreter/elementary_code.hpp"

namespace maupertuis::interpreter {

template double elementary(Kind, const double&, const double&);
template double constant_operation(Kind, std::span<const double>);

}  // namespace maupertuis::interpreter
