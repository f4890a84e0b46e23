#pragma once
#include <maupertuis/ensemble.hpp>
#include <maupertuis/simulation.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Many motions of one model through contacts, friction and events (docs/manual/library.md).
namespace maupertuis {

/// What one of them went through.
struct ThroughModes {
  std::string first_mode, last_mode;    // empty: free
  std::array<std::size_t, 8> counts{};  // by Happening::Kind
  std::size_t modes = 0;                // times that it came into another mode
  std::vector<Happening> happenings;    // the first ones, as many as were asked for
  std::optional<EnergyBooks> books{};   // where the model has contacts or friction
  std::vector<std::string> remarks;     // as in SimulationResult

  std::size_t count(Happening::Kind kind) const { return counts[static_cast<std::size_t>(kind)]; }
};

struct ThroughModesResult : EnsembleResult {
  std::vector<ThroughModes> through;  // [trajectories]
};

struct ThroughModesOptions : EnsembleOptions {  // width, energy_terms and expansion say nothing here: all go alone
  std::size_t happenings = 0;                   // kept of each trajectory; counts are of all
};

/// Advances every motion from its begin to its end, on all threads, as `simulate` does it: the same steps, modes,
/// impacts and books, to the bit, whatever the other trajectories and the number of threads. Programs of modes are made
/// once for all. An event that stops the run ends a motion; TrajectoryEnding::event is its number in
/// model.experiment.events. `run until` is not looked at. A start that violates a contact, and an instant that no mode
/// fits, end their own motion alone, with StepEnding::Paradox and the reason. Values that a model text may not have (a
/// restitution beyond 0 … 1, a negative coefficient of friction or mass) and starts off the constraints end it where it
/// starts, with StepEnding::Refused.
///
/// Nothing, with E0729 or E0730, where the program does not carry out impacts of this model.
/// Memory: the arrays of the result, and one run a thread.
/// Parameters are in the order of the system. Throws std::invalid_argument, which names the argument, where sizes are
/// not those that EnsembleStart says, times do not ascend, step_factors are given, or the model has no contacts,
/// friction or events. Precondition: nobody else works on the expressions of the model meanwhile (library.md: threads).
std::optional<ThroughModesResult> advance_ensemble(const Model& model, const EquationsOfMotion& equations,
                                                   const EnsembleStart& start, const ThroughModesOptions& options,
                                                   Diagnostics& diagnostics);

}  // namespace maupertuis
