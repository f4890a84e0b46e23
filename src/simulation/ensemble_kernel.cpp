#include <maupertuis/motion_kernel.hpp>

#include "simulation/energy_terms.hpp"
#include "simulation/motion_kernel.hpp"

namespace maupertuis {

MotionKernel motion_kernel(const EquationsOfMotion& equations, std::span<const Expr> events) {
  WantedFunctions wanted;
  wanted.events.assign(events.begin(), events.end());
  wanted.observables = energy_terms(equations);
  return {motion_kernel(equations, wanted), parameter_values(*equations.system), wanted.observables.size()};
}

}  // namespace maupertuis
