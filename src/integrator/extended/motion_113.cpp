#include "integrator/extended/motion_code.hpp"

namespace maupertuis::extended {
template ExtendedMotion run_motion<Real<113>>(const ExtendedProblem&, const ExtendedOptions&);
}
