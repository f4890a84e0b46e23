#include "analysis/orbits/same_places.hpp"

#include <maupertuis/quaternion_coordinates.hpp>

#include <cmath>
#include <numbers>

namespace maupertuis::orbits {
namespace {

/// Whether −q is nearer to where it began than q.
bool has_other_sign(const std::array<std::size_t, 4>& four, const MotionState& from, const MotionState& to) {
  double product = 0;
  for (const std::size_t i : four) product += from.q[i] * to.q[i];
  return product < 0;
}

Eigen::VectorXd vector_of(const MotionState& s) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(2 * s.q.size()));
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = s.q[i];
    out[static_cast<Eigen::Index>(s.q.size() + i)] = s.v[i];
  }
  return out;
}

}  // namespace

SamePlaces::SamePlaces(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen)
    : system_(system) {
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    is_angle_.push_back(system.coordinates[i].kind == "angle" && repeats_in_angle(system, motion, seen, i));
  for (const Quaternion& four : quaternion_coordinates(system))
    if (repeats_with_other_sign(system, motion, seen, four)) quaternions_.push_back(four);
}

Eigen::VectorXd SamePlaces::gap(const MotionState& from, const MotionState& to, std::vector<int>* turns) const {
  constexpr double turn = 2 * std::numbers::pi;
  const std::size_t n = is_angle_.size();
  Eigen::VectorXd out = vector_of(to) - vector_of(from);
  if (turns) turns->assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_angle_[i]) continue;
    const double full = std::round(out[static_cast<Eigen::Index>(i)] / turn);
    out[static_cast<Eigen::Index>(i)] -= full * turn;
    if (turns) (*turns)[i] = static_cast<int>(full);
  }
  for (const Quaternion& four : quaternions_)
    if (has_other_sign(four, from, to))
      for (const std::size_t i : four)
        out[static_cast<Eigen::Index>(i)] -= 2 * to.q[i], out[static_cast<Eigen::Index>(n + i)] -= 2 * to.v[i];
  return out;
}

std::vector<std::string> SamePlaces::take_sign_of(const MotionState& from, TangentPoint& point) const {
  const std::size_t n = is_angle_.size(), width = point.width();
  std::vector<std::string> out;
  for (const Quaternion& four : quaternions_) {
    if (!has_other_sign(four, from, point.state)) continue;
    const std::string& name = system_.coordinates[four[0]].name;
    out.push_back(name.substr(0, name.rfind('.')));
    for (const std::size_t i : four) {
      point.state.q[i] = -point.state.q[i], point.state.v[i] = -point.state.v[i];
      for (std::size_t k = 0; k < point.directions.size(); k += width) {
        point.directions[k + i] = -point.directions[k + i];
        point.directions[k + n + i] = -point.directions[k + n + i];
      }
    }
  }
  return out;
}

}  // namespace maupertuis::orbits
