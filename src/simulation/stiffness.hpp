#pragma once
#include <maupertuis/step.hpp>

#include <cstddef>
#include <vector>

namespace maupertuis {

/// Sees when steps are limited by stability: they stay far shorter than the times in which the velocities change,
/// because of motions that have died out. Steps that go on shrinking come to a point where no method passes. Judged
/// over windows of some hundred steps, and only where many more steps are to come.
class StiffnessWatch {
 public:
  /// Precondition: `start` is the motion at the beginning of `step`.
  bool sees_stiffness(const Sample& start, const Step& step, double end);

 private:
  std::vector<double> speed_, acceleration_;  // [n] largest in the window
  std::vector<double> lengths_;               // of steps, the mean of each window so far
  double window_begin_ = 0;
  std::size_t steps_ = 0;
};

}  // namespace maupertuis
