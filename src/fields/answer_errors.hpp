#pragma once
#include "fields/mesh_run.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace maupertuis {

/// How far off an answer is, and the power of the width of cells by which it comes nearer; 0: not measured.
struct AnswerError {
  double size = std::numeric_limits<double>::infinity(), order = 0;
};

/// Whether a mesh follows the start: not where it has jumps or kinks, in part where it is too coarse, and by a lower
/// power of its cells where a derivative of the order `jump` runs in from a side that the start does not fit, or whose
/// motion switches.
struct Rough {
  enum { No, Coarse, Breaks } how = No;
  std::optional<int> jump;
  double tail = 0;  // as in SideFit
};
Rough roughness_of(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                   const FieldRunOptions& options, Diagnostics& diagnostics);

/// Of so many parts the cells of the first mesh.
Cells divided(const Cells& cells, int parts);

/// The other meshes, and how far off the answers on the first are.
///
/// Meshes and their steps are off by a power of the width of a cell, but never by less than rounding. Where a third
/// mesh shows that the difference falls more slowly, by that; of waves, which go through zero together at some moments
/// on two meshes, by what the third and the second differ where that is more, up to four times; where the start breaks,
/// by the first power; where it does not fit a side, by that of the derivative that jumps, and twice the difference
/// counts. Where slopes are about as steep as the mesh can follow the difference itself counts, and beyond there is no
/// estimate. Where the mesh follows the start in part alone, a mesh of twice the cells tells what both others miss.
/// Meshes of few cells may share a symmetry with the motion; there a third between both counts too, by the same power.
/// Tails of pulses that do not fit a side are jumps too, as far as they reach.
std::vector<AnswerError> errors_of(const OneRun& fine, const FieldEquations& equations, FieldMethod& method,
                                   const Cells& cells, const std::vector<FieldQuestion>& questions,
                                   const FieldRunOptions& options, Rough start, Diagnostics& diagnostics);

}  // namespace maupertuis
