#pragma once
#include "fields/coupled_mesh_run.hpp"
#include "fields/switching.hpp"

namespace maupertuis {

/// What was asked of fields with coordinates and bodies, and the mesh that was asked for.
struct CoupledProblem {
  const Model& model;
  const FieldEquations& equations;
  const std::vector<FieldQuestion>& questions;
  const FieldRunOptions& options;
  int cells = 0, order = 0;
  double width = 0;          // of a cell
  bool breaks = false;       // the start has jumps or kinks
  double gain_of_start = 0;  // gain_at_breaks
};

/// What halving the elements gains at least beside a break; 0 where there is none. A plucked string and one under a
/// moving load have kinks, a beam under a load a jump of its third derivative; of waves without bodies at their ends a
/// higher derivative may jump where the start does not fit them.
double gain_at_breaks(const FieldEquations& equations, const SemiDiscrete& mesh, bool start_breaks,
                      const std::optional<SwitchingBreak>& switching, double begin, double end);

/// How far off the answers of a run are, by runs on other meshes (docs/theory/fields.md); infinite where that is not
/// asked for, or the run does not go well. The errors of the moments of `happenings` are set.
std::vector<double> coupled_errors(const CoupledRun& fine, const SemiDiscrete& mesh, const CoupledProblem& problem,
                                   std::vector<Happening>& happenings, bool goes_well);

}  // namespace maupertuis
