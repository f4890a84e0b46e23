#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "linear_algebra/plane_impulse.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace maupertuis::extended {

/// An impact at one contact in space (space_impulse.cpp of simulation, over T): velocities (v_n, v_x, v_y) change along
/// its normal impulse p by W (1, f), where friction f = −μ (v_x, v_y)/|v_t| turns with the slip. Curves are followed by
/// Taylor polynomials in p; a slip that stays along one direction, or is held, is followed in closed form.
template <class T>
class SpaceImpact {
 public:
  using Three = std::array<T, 3>;
  using Two = std::array<T, 2>;

  SpaceImpact(std::array<Three, 3> response, Three velocity, T friction, T static_friction, T restitution)
      : w_(std::move(response)),
        v_(std::move(velocity)),
        friction_(std::move(friction)),
        static_(std::move(static_friction)),
        restitution_(std::move(restitution)),
        scale_(size_of(v_)),
        order_(static_cast<std::size_t>(std::ceil(0.5 * std::log(2.0) * std::numeric_limits<T>::digits)) + 2) {}

  /// Normal impulse and the two of friction, until the work of the normal force in restitution is e² times that in
  /// compression. Nothing where it does not come to an end, as where friction presses more than it gives way.
  std::optional<Three> follow() {
    if (!until([](const Three& v, const T&) { return v[0]; })) return std::nullopt;
    const T back = -restitution_ * restitution_ * work_;
    work_ = T(0);
    if (back > 0 && !until([&](const Three&, const T& work) { return T(work - back); })) return std::nullopt;
    return impulse_;
  }

 private:
  /// v and the impulses as polynomials of what the normal impulse grows by.
  struct Course {
    std::array<std::vector<T>, 3> v, impulse;
    std::vector<T> work;
  };

  static T size_of(const Three& v) { return sqrt(T(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])); }
  static T at(const std::vector<T>& polynomial, const T& x) {
    T out = T(0);
    for (std::size_t k = polynomial.size(); k-- > 0;) out = out * x + polynomial[k];
    return out;
  }
  T slip() const { return sqrt(T(v_[1] * v_[1] + v_[2] * v_[2])); }

  /// Friction that holds, or keeps its direction: nothing turns.
  Course straight(const Two& force) const {
    Course out;
    for (std::size_t i = 0; i < 3; ++i) out.v[i] = {v_[i], T(w_[i][0] + w_[i][1] * force[0] + w_[i][2] * force[1])};
    out.impulse = {std::vector<T>{impulse_[0], T(1)}, {impulse_[1], force[0]}, {impulse_[2], force[1]}};
    out.work = {work_, out.v[0][0], T(out.v[0][1] / 2)};
    return out;
  }

  /// s² = v_x² + v_y² and f s = −μ v_t, order by order.
  Course curved() const {
    Course out;
    std::array<std::vector<T>, 2> f;
    std::vector<T> s;
    for (std::size_t i = 0; i < 3; ++i) out.v[i] = {v_[i]}, out.impulse[i] = {impulse_[i]};
    out.work = {work_};
    for (std::size_t k = 0; k < order_; ++k) {
      T square = T(0);
      for (std::size_t j = 0; j <= k; ++j) square += out.v[1][j] * out.v[1][k - j] + out.v[2][j] * out.v[2][k - j];
      for (std::size_t j = 1; j < k; ++j) square -= s[j] * s[k - j];
      s.push_back(k == 0 ? T(sqrt(square)) : T(square / (2 * s[0])));
      for (std::size_t i = 0; i < 2; ++i) {
        T rest = -friction_ * out.v[1 + i][k];
        for (std::size_t j = 0; j < k; ++j) rest -= f[i][j] * s[k - j];
        f[i].push_back(rest / s[0]);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const T slope = (k == 0 ? w_[i][0] : T(0)) + w_[i][1] * f[0][k] + w_[i][2] * f[1][k];
        out.v[i].push_back(slope / (k + 1));
        out.impulse[i].push_back((i == 0 ? T(k == 0 ? 1 : 0) : f[i - 1][k]) / (k + 1));
      }
      out.work.push_back(out.v[0][k] / (k + 1));
    }
    return out;
  }

  /// How far a curve is right to rounding: by its last two coefficients.
  T length_of(const Course& c) const {
    T out = T(HUGE_VAL);
    const T speed = slip();
    for (std::size_t k = order_ - 1; k <= order_; ++k) {
      const T last = std::max(T(abs(c.v[1][k])), T(abs(c.v[2][k])));
      if (last > 0) out = std::min(out, T(pow(T(epsilon<T>() * speed / last), T(1) / k)));
    }
    const T rate = sqrt(T(c.v[1][1] * c.v[1][1] + c.v[2][1] * c.v[2][1]));
    return rate > 0 ? std::min(out, T(speed / (2 * rate))) : out;  // not through a slip of 0
  }

  void move_to(const Course& c, const T& x) {
    for (std::size_t i = 0; i < 3; ++i) v_[i] = at(c.v[i], x), impulse_[i] = at(c.impulse[i], x);
    work_ = at(c.work, x);
  }

  /// At a slip of 0 friction holds it if it can; else it leaves where W_tt (−μ d) + w_tn points along d.
  Two force_at_rest() {
    std::vector<T> hold{T(-w_[1][0]), T(-w_[2][0])};
    LinearSolver<T> solver;
    solver.factor(std::vector<T>{w_[1][1], w_[1][2], w_[2][1], w_[2][2]}, 2, epsilon_to<T>(0.9));
    solver.solve(hold);
    const T needed = sqrt(T(hold[0] * hold[0] + hold[1] * hold[1]));
    if (needed <= static_) return {hold[0], hold[1]};
    const Two d = direction_of_leaving<T>({w_[1][0], w_[2][0]}, {w_[1][1], w_[1][2], w_[2][2]}, friction_);
    return {T(-friction_ * d[0]), T(-friction_ * d[1])};
  }

  /// Until the function of velocities and work rises to 0. False: it does not.
  template <class Function>
  bool until(Function function) {
    constexpr int most = 10'000;
    for (int turn = 0; turn < most; ++turn) {
      Stage stage = next_stage();
      const Course& course = stage.course;
      const auto value = [&](const T& x) {
        return function({at(course.v[0], x), at(course.v[1], x), at(course.v[2], x)}, at(course.work, x));
      };
      for (int doubled = 0; along_ && value(stage.length) < 0 && doubled < 64; ++doubled) stage.length *= 2;
      const bool ends = value(stage.length) >= 0;
      if (!ends && (along_ || !(stage.length > 0))) return false;
      move_to(course, ends ? root(value, stage.length) : stage.length);
      if (ends) return true;
      if (stage.stops) v_[1] = v_[2] = T(0);
    }
    return false;
  }

  struct Stage {
    Course course;
    T length;
    bool stops = false;  // the slip, at its end
  };

  /// A slip that is slow and falls goes straight on to where it stops: what it turns until then is rounding.
  Stage next_stage() {
    const T speed = slip();
    if (speed == 0 && !along_) along_ = force_at_rest();
    if (along_) return {straight(*along_), T(scale_ / w_[0][0])};
    const bool is_slow = speed <= epsilon_to<T>(0.55) * scale_;
    Course course = is_slow ? straight({T(-friction_ * v_[1] / speed), T(-friction_ * v_[2] / speed)}) : curved();
    const T falls = -(v_[1] * course.v[1][1] + v_[2] * course.v[2][1]) / speed;
    if (is_slow && falls > 0) return {std::move(course), T(speed / falls), true};
    if (is_slow) course = curved();
    const T length = length_of(course);
    return {std::move(course), length};
  }

  template <class Value>
  static T root(Value&& value, T high) {
    T low = T(0);
    for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
      const T middle = (low + high) / 2;
      if (middle == low || middle == high) break;
      (value(middle) >= 0 ? high : low) = middle;
    }
    return high;
  }

  std::array<Three, 3> w_;
  Three v_, impulse_{T(0), T(0), T(0)};
  T friction_, static_, restitution_, scale_, work_ = T(0);
  std::size_t order_;
  std::optional<Two> along_;  // the force of a slip that is held, or has left 0
};

}  // namespace maupertuis::extended
