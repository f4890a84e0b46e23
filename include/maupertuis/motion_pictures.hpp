#pragma once
#include <maupertuis/drawing.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/simulation.hpp>

#include <vector>

namespace maupertuis {

/// Impacts and events of a run as marks of its time plots, and a bar for each contact that is closed at some time and
/// for each dry friction (at most 12): closed, sticking, sliding. Nothing for a run without modes and events.
void show_happenings(PlotOptions& options, const SimulationResult& run, const MechanicalSystem& system);

/// The impulses of a run, for `evaluate_drawing`.
std::vector<ContactImpulse> impulses_of(const SimulationResult& run, const MechanicalSystem& system);

}  // namespace maupertuis
