#pragma once
#include "disks/plan.hpp"

#include <maupertuis/disks.hpp>

#include <vector>

namespace maupertuis {

/// What rounding makes of the values of a program at the beginning of a step, in units of the rounding of 1: a running
/// error analysis (N. J. Higham, Accuracy and Stability of Numerical Algorithms, §3.3).
class FormulaRoundings {
 public:
  explicit FormulaRoundings(const DiskPlan& plan) : plan_(plan), of_(plan.program.slots, 0.0) {}
  /// Another step begins.
  void forget() { length_ = 0; }
  /// length: over which what is differentiated is known. 0 where the analysis overflows.
  double of(Slot slot, const SlotCoefficients& coefficients, double length);

 private:
  void find(double length);
  double of_derivative(Slot slot, std::uint32_t shift) const;
  double of_node(const DiskPlan::Node& node) const;
  double size(Slot slot, std::uint32_t shift = 0) const;

  const DiskPlan& plan_;
  SlotCoefficients now_;
  std::vector<double> of_;  // [slots]
  double length_ = 0;       // that they belong to; 0: there are none of this step
};

}  // namespace maupertuis
