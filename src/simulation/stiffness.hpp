#pragma once
#include <maupertuis/step.hpp>

#include <cstddef>
#include <vector>

namespace maupertuis {

/// Sees when steps are so short beside the times in which the velocities change that implicit steps would pay: motions
/// that have died out may keep them so. Steps that go on shrinking come to a point where no method passes. Judged over
/// the later half of the steps so far, and only where many more steps are to come.
class StiffnessWatch {
 public:
  /// Precondition: `start` is the motion at the beginning of `step`.
  bool sees_stiffness(const Sample& start, const Step& step, double end);
  /// The mean of the steps of the last window.
  double length() const { return lengths_.empty() ? 0 : lengths_.back(); }

 private:
  /// Windows that follow each other.
  struct Stretch {
    double begin = 0;
    std::size_t windows = 0;
    std::vector<double> speed, acceleration;  // [n] the largest
    void take(const Sample& at);
  };
  void forget();
  double time_scale(double now) const;

  Stretch before_, now_;         // the windows that are judged
  std::vector<double> lengths_;  // of steps, the mean of each window so far
  double window_begin_ = 0;
  std::size_t steps_ = 0;
};

}  // namespace maupertuis
