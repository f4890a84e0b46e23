#pragma once
#include "json.hpp"

#include <maupertuis/integrals_through_modes.hpp>
#include <maupertuis/invariants.hpp>

#include <string>

namespace maupertuis::app {

/// What `maup invariants` prints: each integral with its name, symmetry and proof, then what holds between them.
std::string invariants_text(const Invariants& found, const EquationsOfMotion& equations, bool all);
/// Fills the document of `maup invariants --json`.
void add_invariants_json(Json& document, const Invariants& found, const EquationsOfMotion& equations);

/// In which modes of contact and friction each integral holds, and which impacts keep it.
std::string through_modes_text(const Invariants& found, const std::vector<IntegralThroughModes>& through,
                               bool has_modes, bool all);
void add_through_modes_json(Json& document, const std::vector<IntegralThroughModes>& through);

}  // namespace maupertuis::app
