#pragma once
#include "console.hpp"
#include "exit_code.hpp"
#include "open_study.hpp"
#include "section_budget.hpp"

#include <maupertuis/simulation.hpp>

#include <optional>
#include <string>

namespace maupertuis::app {

/// The page of a study of fields, its sections within the budget; nothing where it cannot be had, and the diagnostics
/// say why. Precondition: no stage after the tree was asked for.
std::optional<std::string> page_of_fields(Study& study, const SimulationOptions& settings, bool with_run,
                                          SectionBudget& budget);

/// E0809 for sections that pages of fields do not have.
void check_field_sections(const std::vector<std::string>& chosen, Diagnostics& diagnostics);

}  // namespace maupertuis::app
