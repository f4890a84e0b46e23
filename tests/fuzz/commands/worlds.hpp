#pragma once
#include "random.hpp"

#include <string>
#include <vector>

namespace maupertuis::fuzz {

/// A small model that holds together, and statements of any kind over any of what it has a name for: velocities,
/// accelerations, momenta, reactions, points, fields with and without a place. Without dimensions, so that what means
/// nothing is refused for what it means and not for its units.
std::string model_of_a_world(Random& random);
/// The models without further statements, in which there is no mistake.
std::vector<std::string> sound_worlds();

}  // namespace maupertuis::fuzz
