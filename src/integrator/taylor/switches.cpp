#include "integrator/taylor/switches_code.hpp"

namespace maupertuis::taylor {

template struct ScaledPolynomialOf<double>;
template ScaledPolynomial judged(const ScaledPolynomial&);
template ScaledPolynomial switch_polynomial(const KernelWorkspace&, std::size_t, const double&);
template ScaledPolynomial event_polynomial(const KernelWorkspace&, std::size_t, const double&);
template std::optional<double> crossing(const ScaledPolynomial&, const Watched&);
template class SideChooserOf<KernelWorkspace>;

}  // namespace maupertuis::taylor
