#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis {

/// Where h_E vanishes at every state its values along a run are rounding, and no drift.
void forget_drift_of_nothing(SimulationResult& result, const EquationsOfMotion& equations);

/// The result of a run of determined equations as one of the system itself: without the multipliers that stand for
/// what remains of replaced rows, and without what depends on the free functions, which a run had to choose (N0630).
void in_terms_of_system(SimulationResult& result, const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// E0631 where an event, the end of the run or a formula that was asked for depends on the free functions.
bool refuse_undetermined(const Experiment& experiment, const Probe* probe, const EquationsOfMotion& equations,
                         Diagnostics& diagnostics);

}  // namespace maupertuis
