#pragma once
#include "fields/field_method.hpp"
#include "fields/steepening.hpp"

#include <maupertuis/field_run.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// An answer as it is at one moment.
struct Look {
  double time = 0;
  std::vector<double> values = {};  // at its place, then beside it
};

/// A run on one mesh, and what it says of the questions.
struct OneRun {
  std::vector<double> answers;
  std::vector<std::vector<Look>> looks;           // [questions]: at their moments, of waves at earlier ones too
  std::vector<double> sizes;                      // [questions]: the largest anywhere along x, on the first mesh
  std::vector<double> felt;                       // [questions]: felt_rounding, on the first mesh
  std::vector<SteepeningWatch::Follows> follows;  // [questions]: whether the first mesh did
  std::size_t steps = 0;
  bool passes_by = false;  // something that acts for less than a step
  double h = 0, omega = 0, energy = 0, drift = 0;
  Trajectory trajectory;
  std::vector<FieldRunResult::Range> at_end;
  std::vector<FieldCharge> charges;
};

/// On one mesh: with rows and warnings the first, without the others, which are there for the error.
std::optional<OneRun> run_on(const FieldEquations& equations, FieldMethod& method, const Cells& cells,
                             const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                             const std::vector<std::vector<double>>& rows, bool first, Diagnostics& diagnostics);

/// The places of each direction that rows have values at: borders of cells, in the plane not more than some hundred,
/// and between them where those are few.
std::vector<std::vector<double>> places_of_rows(const FieldEquations& equations, const Cells& cells, int least);

}  // namespace maupertuis
