#include "simulation/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

constexpr std::size_t window = 400;   // steps
constexpr double far_shorter = 1e-4;  // than the time scale of the motion: the stiff method makes 10² to 10⁴ steps in
                                      // it, and compiled Taylor's steps cost as much
constexpr double many = 20'000;  // steps: fewer than these cost less than a change of the method
constexpr double steady =
    0.5;  // of the length that steps had when half as many were made: those that stability limits keep theirs
constexpr double known = 10;  // times the time that was looked at: velocities may stand still for a moment

}  // namespace

void StiffnessWatch::Stretch::take(const Sample& at) {
  speed.resize(at.v.size());
  acceleration.resize(at.v.size());
  for (std::size_t i = 0; i < at.v.size(); ++i) {
    speed[i] = std::max(speed[i], std::abs(at.v[i]));
    acceleration[i] = std::max(acceleration[i], std::abs(at.a[i]));
  }
}

void StiffnessWatch::forget() {
  steps_ = 0;
  lengths_.clear();
  before_ = now_ = {};
}

/// The least over the velocities; infinite where none of them changes.
double StiffnessWatch::time_scale(double now) const {
  double scale = HUGE_VAL;
  for (std::size_t i = 0; i < before_.speed.size(); ++i) {
    const auto largest = [&](const std::vector<double>& a, const std::vector<double>& b) {
      return std::max(a[i], i < b.size() ? b[i] : 0.0);
    };
    if (const double a = largest(before_.acceleration, now_.acceleration); a > 0)
      scale = std::min(scale, largest(before_.speed, now_.speed) / a);
  }
  return scale < HUGE_VAL ? std::min(scale, known * std::abs(now - before_.begin)) : scale;
}

bool StiffnessWatch::sees_stiffness(const Sample& start, const Step& step, double end) {
  if (!step.switches.empty()) {
    forget();  // around switches steps are short for another reason
    return false;
  }
  if (steps_ == 0) window_begin_ = step.begin;
  if (now_.speed.empty()) now_.begin = step.begin;
  now_.take(start);
  if (++steps_ < window) return false;
  steps_ = 0;
  ++now_.windows;
  if (now_.windows >= 2 * before_.windows) before_ = std::exchange(now_, {});
  const double length = std::abs(step.end - window_begin_) / static_cast<double>(window), scale = time_scale(step.end);
  lengths_.push_back(length);
  if (lengths_.size() < 2 || length < steady * lengths_[(lengths_.size() - 1) / 2]) return false;
  return scale < HUGE_VAL && length < far_shorter * scale && std::abs(end - step.end) > many * length;
}

}  // namespace maupertuis
