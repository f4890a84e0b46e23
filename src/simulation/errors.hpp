#pragma once
#include "simulation/companions.hpp"

namespace maupertuis {

/// Where companions are compared with the run (CompanionPlan::grid): at all rows where each is to have its errors, else
/// at some hundreds, and at the states between few. A last row that a located event made is not among them: its
/// companions have it at times of their own.
std::vector<std::size_t> comparison_grid(const Trajectory& rows, const StatesBetween& between, const RunPlan& plan,
                                         ErrorEstimates wanted);

/// Fills in what the companions tell: the errors of states, of rows if plan.whole_rows, of the probe, and from when on
/// nothing is certain. `plan.result` is `result`.
void tell_errors(SimulationResult& result, Probe* probe, const CompanionPlan& plan, const Companions& companions,
                 const RoundedNumbers& numbers);

}  // namespace maupertuis
