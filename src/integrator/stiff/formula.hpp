#pragma once
#include "integrator/stiff/motion.hpp"

#include <memory>
#include <optional>
#include <span>

namespace maupertuis::stiff {

enum class Failure {
  Value,        // infinite, undefined, or no unique accelerations
  Accuracy,     // the tolerance is finer than double precision resolves
  ErrorTest,    // no step, however short, meets the tolerance
  Convergence,  // Newton's iteration does not converge
  Constraints,  // no state on the constraints near the one reached
};

struct Advance {
  double reached = 0;
  std::optional<Failure> failure;  // then nothing was reached
  bool history_ends = false;       // the next step needs a restart
  bool drifted = false;            // over a jump, without the formula
};

/// Backward differentiation over a history of its own. States are those of Motion.
class Formula {
 public:
  virtual ~Formula() = default;
  /// Begins a new history at a state that meets the constraints. Precondition: the motion was solved there.
  virtual void restart(double t, std::span<const double> y) = 0;
  /// One step towards `bound`, at most up to it; y: the state reached, on the constraints.
  virtual Advance advance(double bound, std::span<double> y) = 0;
  /// The state at a time in the last step, off the constraints by what the tolerance allows.
  virtual void interpolate(double t, std::span<double> y) const = 0;
  /// Of the last step.
  virtual int order() const = 0;
  /// No step shall be longer from now on; 0: as long as the errors allow.
  virtual void limit(double longest) = 0;
};

/// CVODE: y' = f(t, y). Precondition: no constraints.
std::unique_ptr<Formula> explicit_rates(Motion& motion);
/// IDA on the index-2 form of Gear, Gupta and Leimkuhler (docs/theory/stiff.md).
std::unique_ptr<Formula> index_two(Motion& motion);

}  // namespace maupertuis::stiff
