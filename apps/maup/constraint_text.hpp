#pragma once
#include "json.hpp"

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/simulation.hpp>

#include <functional>
#include <string>

namespace maupertuis::app {

/// Puts out one line of a summary: its head, and the text; an empty head continues the line before.
using SummaryLine = std::function<void(const char* head, const std::string& text)>;

/// The constraints with their classes, the freedoms, the multipliers that are not determined. Nothing of constraints
/// that cannot be met.
void summarise_constraints(const EquationsOfMotion& equations, const ConstraintAnalysis& analysis,
                           const SummaryLine& line);

/// What the constraints changed of the start, `x' = 0.4 m/s`; empty if nothing.
std::string moved_start(const MechanicalSystem& system, const ConsistentStart& start);

/// [{name, class, scleronomic, redundant, integral}]: integral as text, null where there is none.
Json constraints_to_json(const EquationsOfMotion& equations, const ConstraintAnalysis& analysis);

}  // namespace maupertuis::app
