#pragma once
#include "json.hpp"

#include <maupertuis/invariants.hpp>

#include <string>

namespace maupertuis::app {

/// What `maup invariants` prints: each integral with its name, symmetry and proof, then what holds between them.
std::string invariants_text(const Invariants& found, const EquationsOfMotion& equations, bool all);
/// Fills the document of `maup invariants --json`.
void add_invariants_json(Json& document, const Invariants& found, const EquationsOfMotion& equations);

}  // namespace maupertuis::app
