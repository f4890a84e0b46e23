#pragma once
#include "json.hpp"
#include "notation.hpp"
#include "open_study.hpp"

#include <string>
#include <vector>

namespace maupertuis::app {

/// What `maup derive` says of fields: density, equations, natural conditions, energy, certificate.
std::string fields_lecture(Study& study, bool with_steps);
/// The equations alone, then the natural conditions.
std::vector<FormulaLine> field_lines(Study& study, bool with_steps);
Json fields_json(Study& study);
/// The summary of `maup check`.
std::string fields_summary(Study& study);
/// Conservation laws: `maup invariants`.
std::string currents_text(Study& study);
Json currents_json(Study& study);

}  // namespace maupertuis::app
