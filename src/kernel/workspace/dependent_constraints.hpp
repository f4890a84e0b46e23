#pragma once
#include "kernel/workspace/full_factors.hpp"

#include <span>
#include <vector>

namespace maupertuis::workspace {

/// Whether constraints that were dropped as dependent hold for the accelerations that the others leave. Where forces
/// balance (a ladder at rest between rough walls, a beam on three supports) accelerations are rounding, and ask
/// nothing.
class DependentConstraints {
 public:
  explicit DependentConstraints(const Expansion& x) : x_(x) {}

  void set_usual_accelerations(std::span<const double> a) { usual_accelerations_.assign(a.begin(), a.end()); }
  /// For q̈ and λ of the point. False: `contradicting()` does not hold.
  bool agree(const std::vector<double>& matrix, const FullFactors& factors, std::span<const double> unknowns);
  std::size_t contradicting() const { return contradicting_; }

 private:
  double acceleration_of_terms(std::size_t i, const std::vector<double>& matrix,
                               std::span<const double> unknowns) const;

  const Expansion& x_;
  std::vector<double> usual_accelerations_;  // [n] or empty
  std::size_t contradicting_ = 0;
};

}  // namespace maupertuis::workspace
