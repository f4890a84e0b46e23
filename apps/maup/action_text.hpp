#pragma once
#include "json.hpp"

#include <maupertuis/action.hpp>

#include <string>

/// What `maup action` says: text as a reader wants it, documents for programs.
namespace maupertuis::app {

std::string action_text(const PathSearch& search, const MechanicalSystem& system);
Json action_json(const PathSearch& search, const MechanicalSystem& system);

std::string action_text(const GivenPath& given, const MechanicalSystem& system);
Json action_json(const GivenPath& given, const MechanicalSystem& system);

std::string action_text(const MotionAction& motion, const MechanicalSystem& system);
Json action_json(const MotionAction& motion, const MechanicalSystem& system);

std::string action_text(const PeriodicAction& orbit, const MechanicalSystem& system);
Json action_json(const PeriodicAction& orbit, const MechanicalSystem& system);

}  // namespace maupertuis::app
