#include "simulation/stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr std::size_t window = 400;   // steps
constexpr double far_shorter = 0.02;  // a step that accuracy limits is longer than the time scale of the motion
constexpr double many = 20'000;       // steps: fewer than these cost less than a change of the method
constexpr double steady =
    0.5;  // of the length that steps had when half as many were made: those that stability limits keep theirs

}  // namespace

bool StiffnessWatch::sees_stiffness(const Sample& start, const Step& step, double end) {
  if (steps_ == 0) {
    window_begin_ = step.begin;
    speed_.assign(start.v.size(), 0);
    acceleration_.assign(start.v.size(), 0);
  }
  for (std::size_t i = 0; i < start.v.size(); ++i) {
    speed_[i] = std::max(speed_[i], std::abs(start.v[i]));
    acceleration_[i] = std::max(acceleration_[i], std::abs(start.a[i]));
  }
  if (step.switches > 0) {
    steps_ = 0;  // around switches steps are short for another reason
    lengths_.clear();
    return false;
  }
  if (++steps_ < window) return false;
  const double length = std::abs(step.end - window_begin_) / static_cast<double>(steps_);
  double scale = HUGE_VAL;
  for (std::size_t i = 0; i < speed_.size(); ++i)
    if (acceleration_[i] > 0) scale = std::min(scale, speed_[i] / acceleration_[i]);
  steps_ = 0;
  lengths_.push_back(length);
  if (lengths_.size() < 2 || length < steady * lengths_[(lengths_.size() - 1) / 2]) return false;
  return scale < HUGE_VAL && length < far_shorter * scale && std::abs(end - step.end) > many * length;
}

}  // namespace maupertuis
