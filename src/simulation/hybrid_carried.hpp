#pragma once
#include <maupertuis/integrator.hpp>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace maupertuis::hybrid {

/// What the modes before, and what happened between them, leave to the motion that goes on.
struct Carried {
  /// As in samples of the motion: the work on h_E, what friction took, what D took, what surfaces that move gave.
  double integrals[4] = {0, 0, 0, 0};
  std::size_t steps = 0, rejected = 0, switches = 0;
  double residual = 0;  // of constraints, the largest

  void take(const TaylorStepper& stepper);
  void forget_work();
  void put_in(double energy) { integrals[0] += energy; }
  /// What a moment does to the energy is what contacts rub in it.
  void rub(double gained) { integrals[0] += gained, integrals[1] -= gained; }
};

/// A moment at whose end slips in space have stopped: it is passed over between two steps, as a parabola. Times in it
/// are known from its end.
class PassedMoment {
 public:
  void begin(double t, std::vector<double> accelerations);
  void forget();
  /// The step that follows it is the last one that may be asked for its times.
  void end_step();
  /// The time at which the step that began at `begin` is to be asked for t.
  double covered(double t, double begin) const;
  /// From the state at that time to the one at t.
  void move_back(double t, double begin, std::span<double> q, std::span<double> v) const;

 private:
  double begin_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> accelerations_;  // [n]
  bool just_passed_ = false;           // the last step follows it
};

}  // namespace maupertuis::hybrid
