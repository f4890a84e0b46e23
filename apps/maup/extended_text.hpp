#pragma once
#include "json.hpp"

#include <maupertuis/extended_simulation.hpp>

#include <string>

namespace maupertuis::app {

/// The states of a run in many digits, one number a line, and what it cost.
std::string extended_text(const ExtendedResult& result);

/// The document of `maup simulate --precision … --json`: numbers are strings, with the count of their digits beside
/// them.
Json extended_document(const ExtendedResult& result, const std::string& precision, const MechanicalSystem& system);

}  // namespace maupertuis::app
