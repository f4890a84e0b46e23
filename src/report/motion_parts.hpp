#pragma once
#include <maupertuis/report.hpp>

/// The parts of a report that need a run.
namespace maupertuis {

/// What is conserved and why; with a run, the values at its start and their drift. Without the result of a search the
/// momenta of cyclic coordinates stand for it.
void add_conserved(ReportContent& content, const EquationsOfMotion& equations, const ConservedQuantities& conserved,
                   const SimulationResult* run, const Invariants* invariants);

/// The integrals that a search found, with values and drift along a run, and what holds between them.
void add_invariants(ReportContent& content, const EquationsOfMotion& equations, const Invariants& found,
                    const SimulationResult* run);
/// The value of a function of q, q', t at the start of a run, and its largest change by its largest value.
void add_values_along_run(ReportContent::Conserved& row, const EquationsOfMotion& equations, Expr function,
                          const std::string& unit, const Trajectory& run);

/// Drawing, statistics and plots.
void add_motion(ReportContent& content, const Model& model, const EquationsOfMotion& equations, bool energy_conserved,
                const SimulationResult& run);

/// What was checked of the equations, line by line.
void add_certificate(ReportContent& content, const Certificate& certificate);

}  // namespace maupertuis
