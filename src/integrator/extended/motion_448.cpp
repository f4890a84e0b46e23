#include "integrator/extended/motion_code.hpp"

namespace maupertuis::extended {
template ExtendedMotion run_motion<Real<448>>(const ExtendedProblem&, const ExtendedOptions&);
}
