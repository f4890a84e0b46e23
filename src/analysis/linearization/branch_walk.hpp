#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <optional>
#include <vector>

namespace maupertuis {

/// A stretch of a branch of rests along one parameter, from a rest on it towards another value.
struct BranchStretch {
  OperatingPoint rest;
  std::size_t parameter = 0;
  double value = 0, beyond = 0;           // of the parameter: at the rest, and where the stretch leads to
  std::vector<double> sizes;              // [n] typical ones, of the coordinates
  std::vector<Translation> translations;  // along these a rest stays where it is
};

struct RestAt {
  double value = 0;  // of the parameter
  OperatingPoint rest;
};

/// Where the curve of rests leads, followed along itself.
struct BranchWalk {
  enum class End { Arrived, Returned, Lost } end = End::Lost;  // at `beyond`; at `value` again, after a fold
  RestAt last;                                                 // Arrived, Returned: there
  std::vector<RestAt> folds;                                   // that it turns back at, in order
  std::vector<RestAt> arms;                                    // a place on the curve between each fold and the next
};

/// By continuation along the curve itself, whose tangent has no part along the parameter at a fold (limit point,
/// saddle-node). Through points where another branch crosses it goes straight on; where branches pass each other closer
/// than a step, by more than some 10⁻⁶ of typical sizes, it stays on its own. Lost where another branch is met at a
/// turn (a pitchfork), at kinks, and for systems with constraints on velocities or without inertia. The parameter has
/// another value afterwards.
BranchWalk walk_along(PointEquations::Impl& equations, const BranchStretch& stretch);

}  // namespace maupertuis
