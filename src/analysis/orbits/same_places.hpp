#pragma once
#include "analysis/orbits/drive.hpp"

#include <maupertuis/tangent.hpp>

#include <eigen3/Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace maupertuis::orbits {

/// States with other numbers that are one place: angles a whole turn apart where the equations do not see turns, and
/// quaternions q and −q, which are one orientation.
class SamePlaces {
 public:
  SamePlaces(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen);

  /// to − from [2n], without whole turns, which are counted, and with the sign of q that is nearer.
  Eigen::VectorXd gap(const MotionState& from, const MotionState& to, std::vector<int>* turns) const;
  /// What came back with the other sign of a quaternion, and its directions, as the one with the sign of the beginning.
  /// Returns the bodies.
  std::vector<std::string> take_sign_of(const MotionState& from, TangentPoint& point) const;

 private:
  using Quaternion = std::array<std::size_t, 4>;

  const MechanicalSystem& system_;
  std::vector<bool> is_angle_;           // [n] whose turns the equations do not see
  std::vector<Quaternion> quaternions_;  // at whose −q the equations are the same
};

}  // namespace maupertuis::orbits
