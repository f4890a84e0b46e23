#pragma once
#include <cmath>
#include <cstddef>
#include <utility>

namespace maupertuis::taylor {

/// Sees steps that shrink as the inverse square of their number, or faster, or for long as its power −3/2 (an
/// oscillation across a coordinate that runs away in finite time), while what is left would take more of them than a
/// run has. From the power −1 on, all steps together come to an end. Looked at where their number doubles, so that
/// equal runs end alike.
class ShrinkingSteps {
 public:
  void start(double time) { *this = {}, time_ = time; }

  bool come_to_a_stop(std::size_t steps, double time, double left) {
    constexpr std::size_t first_look = 4096;
    constexpr double shrinks = 0.3, shrinks_for_long = 0.4, too_many = 1e8;
    if (steps < first_look || (steps & (steps - 1)) != 0 || steps == steps_) return false;
    // The mean of the steps since the last look: single ones differ by more than that.
    const double mean = std::abs(time - time_) / static_cast<double>(steps - steps_);
    steps_ = steps;
    time_ = time;
    const double before = std::exchange(mean_, mean), ratio = before > 0 ? mean / before : 1;
    const double ratio_before = std::exchange(ratio_, ratio);
    const bool goes_on = ratio < shrinks || (ratio < shrinks_for_long && ratio_before < shrinks_for_long);
    return goes_on && std::abs(left) > too_many * mean;
  }

  /// At such a look: what is left would take ten thousand times the steps that a run has, and the steps do not grow so
  /// that they could come there sooner (with the time to a power p, from which the ratio follows as 2^(p/(1 − p))).
  bool never_arrives(std::size_t steps, double left) const {
    constexpr std::size_t enough = 1u << 17;
    constexpr double far_too_many = 1e12, hardly_grows = 1.4;
    return steps >= enough && steps == steps_ && ratio_ < hardly_grows && std::isfinite(left) &&
           std::abs(left) > far_too_many * mean_;
  }
  /// Of the steps since the look before, s.
  double mean() const { return mean_; }

 private:
  std::size_t steps_ = 0;                   // at the last look
  double time_ = 0, mean_ = 0, ratio_ = 1;  // of the mean to the one before
};

}  // namespace maupertuis::taylor
