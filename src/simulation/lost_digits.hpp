#pragma once
#include "simulation/companions.hpp"

#include <vector>

namespace maupertuis {

/// Of the largest value of a column: an error above it leaves no digit, and grows no further than the motion reaches.
inline constexpr double saturated_error = 0.5;

/// From which error on a column of the state has no digit left: half of the largest value that it takes, unless that
/// is noise beside other columns of its unit, or what rounding of forces that balance leaves.
class LostDigits {
 public:
  explicit LostDigits(const CompanionPlan& plan);

  /// The largest value of a column of the state.
  double size(std::size_t column) const { return sizes_[column]; }
  bool is_lost(std::size_t column, double error) const;

 private:
  std::vector<double> sizes_, of_unit_, rounding_;  // [2n]
};

/// Whether a companion has lost the motion: from there on it tells nothing of the state any more.
class LostCompanion {
 public:
  /// `share`: of a difference of one companion in the error.
  LostCompanion(const CompanionPlan& plan, double share);

  /// Row g of the companion, its first 2n columns. True from where all columns are lost, whatever the others say.
  bool look(std::size_t g, const double* row);

 private:
  const CompanionPlan& plan_;
  LostDigits digits_;
  double share_;
  std::vector<double> largest_;  // [2n] differences so far
};

}  // namespace maupertuis
