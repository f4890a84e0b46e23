#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What is told where events that act at one instant, in the order of the text, set one coordinate more than once;
/// empty where they do not.
std::string set_more_than_once(const MechanicalSystem& system, const std::vector<const ModelEvent*>& events, double t);

}  // namespace maupertuis
