#include <maupertuis/motion_kernel.hpp>

#include "simulation/energy_terms.hpp"
#include "simulation/motion_kernel.hpp"

namespace maupertuis {

MotionKernel motion_kernel(const EquationsOfMotion& equations) {
  WantedFunctions wanted;
  wanted.observables = energy_terms(equations);
  return {motion_kernel(equations, wanted), parameter_values(*equations.system), wanted.observables.size()};
}

}  // namespace maupertuis
