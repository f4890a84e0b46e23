#pragma once
#include "analysis/tangent/point_functions.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/orbits.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace maupertuis::orbits {

/// The part of a section that an energy allows, for two coordinates: the points (b, b') of one of them for which the
/// other's position follows from the section and its velocity from the energy and the direction of crossing.
struct SectionPlane {
  std::size_t along = 0, across = 1;  // the coordinate that the section fixes; the one that is free
  double energy = 0;                  // J
  std::vector<MotionState> starts;
  std::vector<std::pair<double, double>> outline;
};

/// `near`: a state of the motion on the section, in the connected part that is wanted; `sizes` [4] of the motion.
/// Nothing, with E1407, where the section depends on velocities or the energy does not reach it.
std::optional<SectionPlane> spread_starts(const EquationsOfMotion& equations, const SectionOptions& options,
                                          const MotionState& near, double energy, const std::vector<double>& sizes,
                                          Diagnostics& diagnostics);

}  // namespace maupertuis::orbits
