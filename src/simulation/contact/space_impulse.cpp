#include "simulation/contact/space_impulse.hpp"

#include "linear_algebra/plane_impulse.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double accurate = 1e-13;

VectorXd solved(const MatrixXd& matrix, const VectorXd& right) {
  return Eigen::FullPivLU<MatrixXd>(matrix).solve(right);
}

/// What changes with the normal impulse.
struct State {
  Vector3d velocity = Vector3d::Zero(), impulse = Vector3d::Zero();
  double work = 0;  // of the normal force
};

class Course {
 public:
  explicit Course(const SpaceImpact& impact) : impact_(impact), scale_(impact.velocity.norm()) {
    state_ = {impact.velocity, Vector3d::Zero(), 0};
  }

  Vector3d follow() {
    if (!run([](const State& s) { return s.velocity(0); })) return Vector3d::Zero();  // jammed
    const double back = -impact_.restitution * impact_.restitution * state_.work;
    if (!(back > 0)) return state_.impulse;
    state_.work = 0;
    run([back](const State& s) { return s.work - back; });
    return state_.impulse;
  }

 private:
  /// The force for a unit of the normal one.
  Vector3d force(const State& s) const {
    const Vector2d slip = s.velocity.tail<2>();
    Vector3d out(1, 0, 0);
    out.tail<2>() = holds_ ? hold_ : Vector2d(-impact_.friction * (slip.norm() > 0 ? slip / slip.norm() : leaves_));
    return out;
  }

  State slope(const State& s) const {
    const Vector3d f = force(s);
    return {impact_.response * f, f, s.velocity(0)};
  }
  static State plus(const State& s, const State& d, double h) {
    return {s.velocity + h * d.velocity, s.impulse + h * d.impulse, s.work + h * d.work};
  }
  State step(const State& s, double h) const {
    const State a = slope(s), b = slope(plus(s, a, h / 2)), c = slope(plus(s, b, h / 2)), d = slope(plus(s, c, h));
    return {s.velocity + h / 6 * (a.velocity + 2 * b.velocity + 2 * c.velocity + d.velocity),
            s.impulse + h / 6 * (a.impulse + 2 * b.impulse + 2 * c.impulse + d.impulse),
            s.work + h / 6 * (a.work + 2 * b.work + 2 * c.work + d.work)};
  }

  /// A slip that has just left 0 is none that comes to rest.
  bool at_rest() const {
    const Vector2d slip = state_.velocity.tail<2>();
    return slip.norm() <= accurate * scale_ && (slip.norm() == 0 || slip.dot(slope(state_).velocity.tail<2>()) < 0);
  }

  /// At a slip of 0 friction holds it if it can; else it leaves where W_tt (−μ d) + w_tn points along d.
  void decide() {
    const Vector2d w = impact_.response.block<2, 1>(1, 0);
    const Matrix2d tangential = impact_.response.block<2, 2>(1, 1);
    state_.velocity.tail<2>().setZero();
    hold_ = -solved(tangential, w);
    holds_ = impact_.sticking || hold_.norm() <= impact_.static_friction;
    if (holds_) return;
    const auto along = direction_of_leaving<double>(
        {w(0), w(1)}, {tangential(0, 0), tangential(0, 1), tangential(1, 1)}, impact_.friction);
    leaves_ = {along[0], along[1]};
  }

  /// No step goes through a slip of 0, where the force turns round: at most half of the way there.
  double until_stop() const {
    const Vector2d slip = state_.velocity.tail<2>();
    const double rate = slope(state_).velocity.tail<2>().norm();
    return holds_ || slip.norm() == 0 || rate == 0 ? HUGE_VAL : 0.5 * slip.norm() / rate;
  }

  /// Until the function rises to 0. False: it does not.
  template <class Function>
  bool run(Function until) {
    double h = scale_ / impact_.response(0, 0) / 16;
    constexpr int most = 200'000;
    for (int turn = 0; turn < most; ++turn) {
      if (!holds_ && at_rest()) decide();
      if (until(state_) >= -accurate * accurate * scale_) return true;
      h = std::min(h, until_stop());
      const State whole = step(state_, h), half = step(step(state_, h / 2), h / 2);
      const double off = (whole.velocity - half.velocity).norm();
      if (off > accurate * scale_ && h > 1e-16 * scale_ / impact_.response(0, 0)) {
        h /= 2;
        continue;
      }
      if (until(half) > 0) {  // the root lies within the step
        h = root(until, h);
        state_ = step(step(state_, h / 2), h / 2);
        return true;
      }
      if (turn > 64 && state_.velocity(0) < 0 && half.velocity(0) < 4 * state_.velocity(0)) return false;
      state_ = half;
      if (off < accurate * scale_ / 64) h *= 2;
    }
    return false;
  }

  template <class Function>
  double root(Function until, double high) const {
    double low = 0;
    for (int turn = 0; turn < 100 && low < high; ++turn) {
      const double middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      (until(step(step(state_, middle / 2), middle / 2)) > 0 ? high : low) = middle;
    }
    return high;
  }

  const SpaceImpact& impact_;
  double scale_;
  State state_;
  bool holds_ = false;
  Vector2d hold_ = Vector2d::Zero(), leaves_ = Vector2d::UnitX();
};

}  // namespace

Vector3d impulse_in_space(const SpaceImpact& impact) {
  if (impact.sticking) {  // what never slides takes the slip at once
    Vector3d wanted = -impact.velocity;
    wanted(0) *= 1 + impact.restitution;
    return solved(impact.response, wanted);
  }
  return Course(impact).follow();
}

}  // namespace maupertuis
