#include "integrator/taylor/roots_code.hpp"

namespace maupertuis::taylor {

template std::optional<double> touching(const ScaledPolynomial&, std::int8_t, bool);
template class RootSearchOf<double>;

}  // namespace maupertuis::taylor
