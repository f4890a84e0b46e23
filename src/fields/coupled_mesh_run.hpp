#pragma once
#include "fields/semi_discrete.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/simulation.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// A run of fields with coordinates and bodies on one mesh.
struct CoupledRun {
  SimulationResult result;
  std::vector<double> answers;
  std::vector<std::vector<double>> near;  // [questions]: the same beside their places
  double energy = 0;
};

/// Answers are looked at beside their places too, in parts of `width`, that of the first mesh's cells. Nothing, and the
/// diagnostics, where there is no motion or an answer cannot be had.
std::optional<CoupledRun> run_once(const SemiDiscrete& mesh, const std::vector<FieldQuestion>& questions, double width,
                                   const FieldRunOptions& options, Diagnostics& diagnostics);

}  // namespace maupertuis
