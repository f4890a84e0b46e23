#pragma once
#include "analysis/orbits/survey.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/orbits.hpp>

#include <eigen3/Eigen/Core>
#include <optional>

namespace maupertuis::orbits {

/// A closed motion with the derivative of its return map.
struct Closed {
  PeriodicMotion motion;
  TangentPoint begin, end;     // all directions that the constraints allow, and what a period makes of them
  Eigen::VectorXd flow;        // [2n] (q̇, q̈) at the start
  std::vector<double> sizes;   // [2n] of the orbit
  bool through_modes = false;  // with impacts, friction, events
  bool keeps_energy = false;
  std::optional<double> log_volume;  // log of what its jumps multiply volumes by; nothing where none is known
};

/// The periodic motion next to the start of the model; the diagnostics are those of `floquet`.
std::optional<Closed> close_motion(const Model& model, const EquationsOfMotion& equations,
                                   const FloquetOptions& options, Diagnostics& diagnostics);

/// What dΦ_T is on the directions that the constraints allow [d × d], in orthonormal directions U of the state measured
/// by `sizes`; dΦ_T of the state is sizes · U (monodromy) Uᵀ / sizes.
struct ReturnMap {
  Eigen::MatrixXd directions;  // U [2n × d]
  Eigen::MatrixXd monodromy;   // [d × d]
};
ReturnMap return_map(const TangentPoint& begin, const TangentPoint& end, const std::vector<double>& sizes);

}  // namespace maupertuis::orbits
