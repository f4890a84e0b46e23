#pragma once
#include <maupertuis/formula_document.hpp>
#include "json.hpp"
#include "open_study.hpp"

#include <maupertuis/field_run.hpp>

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

/// Study::field_motion, where the options allow it (E0809).
std::optional<FieldRunResult> run_of_fields(Study& study, const SimulationOptions& settings,
                                            const FieldMotionOptions& kept);
/// The dispersion relation; empty, and `trouble`, where there is none.
std::string dispersion_text(Study& study, std::string& trouble);
std::string field_run_text(const FieldRunResult& run, const MechanicalSystem& system);
Json field_run_json(const FieldRunResult& run, const MechanicalSystem& system);

}  // namespace maupertuis::app
