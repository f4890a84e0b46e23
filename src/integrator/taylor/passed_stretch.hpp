#pragma once
#include "disks/retrace.hpp"
#include "integrator/taylor/safe_length.hpp"

#include <maupertuis/disks.hpp>

#include <span>
#include <vector>

namespace maupertuis::taylor {

/// The formulas of a motion between the points at which a step looked that no series made: there too something narrow
/// may happen. The step's polynomials are followed in pieces over which disks bound the residual, and keep switch
/// functions and events on their sides; in each piece the equations are asked anew, so that one looks the more closely
/// the faster a formula varies.
class PassedStretch {
 public:
  /// rows: [order + 2][unknowns] coefficients about t + rest, those of multipliers being of what they are the second
  /// derivatives of. The program and `safe` must outlive this.
  PassedStretch(const Program& program, int order, SafeLength& safe, double t, double rest,
                std::span<const double> rows);

  /// Goes to t + s, where the program has these constants.
  void look_at(double s, const double* constants);
  /// Whether R_j vanishes there, but for its rounding and `size`.
  bool holds(std::size_t j, double size);
  /// From there on: how far, up to `most` (> 0), the formulas are what their series say, and no switch function and no
  /// event comes to zero. 0: not even over `least`.
  double length(double most, double least);

 private:
  SlotCoefficients coefficients() const { return {retrace_.row(0), retrace_.stride(), retrace_.order(), 1}; }
  bool are_clear(double length);

  const Program& program_;
  SafeLength& safe_;
  std::vector<Slot> watched_;
  Retrace<double> retrace_;
  Disks rows_, functions_;  // of the residual; of what is watched
  double t_, now_ = 0;
};

}  // namespace maupertuis::taylor
