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
  bool smooth() const { return how == No && !jump; }
};
Rough roughness_of(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                   const FieldRunOptions& options, Diagnostics& diagnostics);

/// Of so many parts the cells of the first mesh.
Cells divided(const Cells& cells, int parts);

/// The other meshes, and how far off the answers on the first are.
///
/// Of a smooth start by a run that is off by far less, on elements of higher order: by the difference to it. Tails of
/// pulses that do not fit a side are jumps too, as far as they reach.
///
/// Where the start breaks, where the mesh follows it in part, or where it does not fit a side, no order of elements
/// helps. Half the cells tell the error then, by the first power of their width where the start breaks, by that of the
/// derivative that jumps where it does not fit a side, and twice the difference counts; where slopes are about as steep
/// as the mesh can follow, the difference itself; beyond there is no estimate. Where the mesh follows the start in part
/// alone, a mesh of twice the cells tells what both others miss. Meshes of few cells may share a symmetry with the
/// motion; there a third between both counts too, by the same power.
std::vector<AnswerError> errors_of(const OneRun& fine, const FieldEquations& equations, FieldMethod& method,
                                   const Cells& cells, const std::vector<FieldQuestion>& questions,
                                   const FieldRunOptions& options, const Rough& start, Diagnostics& diagnostics);

}  // namespace maupertuis
