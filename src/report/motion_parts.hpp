#pragma once
#include <maupertuis/report.hpp>

/// The parts of a report that need a run.
namespace maupertuis {

/// What is conserved and why; with a run, the values at its start and their drift.
void add_conserved(ReportContent& content, const EquationsOfMotion& equations, const ConservedQuantities& conserved,
                   const SimulationResult* run);

/// Drawing, statistics and plots.
void add_motion(ReportContent& content, const Model& model, const EquationsOfMotion& equations, bool energy_conserved,
                const SimulationResult& run);

}  // namespace maupertuis
