#pragma once
#include "kernel/workspace/expansion.hpp"

#include <span>

namespace maupertuis::workspace {

/// q̈_k and λ_k of one stage: at first their right side, then the solution.
class StageUnknowns {
 public:
  explicit StageUnknowns(const Expansion& x);
  StageUnknowns(const StageUnknowns&) = delete;

  std::span<double> values() { return values_; }  // [n + m]
  double* data() { return padded_.data(); }       // the same, padded to whole vectors
  /// −R_k, and 0 beyond, where a solution for what is not finite leaves the like.
  void take_residual(const double* row);
  bool are_finite() const;

  /// They are a first solution; what replaces them is to be the solution for what this one leaves of −R_k.
  void keep_as_rough();
  /// The sum of both. False: the second is not small beside the first, as it is where the first holds.
  bool add_rough();

 private:
  const Expansion& x_;
  Doubles padded_;
  std::span<double> values_;
  Doubles rough_;  // padded
};

}  // namespace maupertuis::workspace
