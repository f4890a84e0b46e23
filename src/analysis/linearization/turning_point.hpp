#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <optional>
#include <vector>

namespace maupertuis {

/// A stretch of a branch of rests along one parameter, from a rest on it towards a value that it does not reach.
struct BranchEnd {
  OperatingPoint rest;
  std::size_t parameter = 0;
  double value = 0, beyond = 0;           // of the parameter: at the rest, and where the branch is no more
  std::vector<double> sizes;              // [n] typical ones, of the coordinates
  std::vector<Translation> translations;  // along these a rest stays where it is
};

struct TurningPoint {
  double value = 0;  // of the parameter
  OperatingPoint rest;
};

/// Where the curve of rests turns back: a fold (limit point, saddle-node), by continuation along the curve itself,
/// whose tangent has no part along the parameter there. Nothing where it does not turn before `beyond`, where another
/// branch passes through that point (a pitchfork), at kinks, and for systems with constraints on velocities or without
/// inertia. The parameter has another value afterwards.
std::optional<TurningPoint> turning_point(PointEquations::Impl& equations, const BranchEnd& end);

}  // namespace maupertuis
