#pragma once
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/integrator.hpp>

#include <limits>

/// What the parts of HybridMotion share.
namespace maupertuis {

using namespace hybrid;

/// To which what an event sets keeps constraints and contacts.
inline constexpr double digits_of_sets = 1e-9;

}  // namespace maupertuis
