#include "kernel/series/elementary_code.hpp"

namespace maupertuis::series {

template double elementary(Kind, const double&, const double&);
template double operation(Kind, std::span<const double>);

}  // namespace maupertuis::series
