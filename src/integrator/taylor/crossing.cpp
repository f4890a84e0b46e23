#include "integrator/taylor/crossing_code.hpp"

namespace maupertuis::taylor {

template std::optional<double> first_crossing(std::span<const double>, int, const double&, const double&);

}  // namespace maupertuis::taylor
