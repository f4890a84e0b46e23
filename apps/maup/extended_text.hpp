#pragma once
#include "json.hpp"

#include <maupertuis/extended_simulation.hpp>

#include <string>

namespace maupertuis::app {

/// The states of a run in many digits, one number a line, and what it cost.
std::string extended_text(const ExtendedResult& result, const MechanicalSystem& system);

/// An impulse of a contact with its unit: that of its force times s.
std::string impulse_text(const std::string& number, const std::string& contact, const MechanicalSystem& system);

/// The document of `maup simulate --precision … --json`: numbers are strings, with the count of their digits beside
/// them.
Json extended_document(const ExtendedResult& result, const std::string& precision, const MechanicalSystem& system);

}  // namespace maupertuis::app
