#include "kernel/workspace/dependent_constraints.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::workspace {

/// How large the acceleration is that the terms of one equation would give alone. Where they balance, what is left of
/// it is their rounding.
double DependentConstraints::acceleration_of_terms(std::size_t i, const std::vector<double>& matrix,
                                                   std::span<const double> unknowns) const {
  const Slot slot = x_.program.residual[i];
  const double mass = std::abs(matrix[i * x_.unknowns + i]);
  double force = x_.scale(slot);
  for (std::size_t k = x_.program.freedoms; k < x_.unknowns; ++k)
    force += std::abs(matrix[k * x_.unknowns + i] * unknowns[k]);
  const double usual = usual_accelerations_.empty() ? 0 : usual_accelerations_[i];
  return mass > 0 ? std::max(usual, force / mass) : usual;
}

bool DependentConstraints::agree(const std::vector<double>& matrix, const FullFactors& factors,
                                 std::span<const double> unknowns) {
  constexpr double rounding = 1e-12;
  const std::size_t n = x_.program.freedoms;
  for (std::size_t j = 0; n + j < x_.unknowns; ++j) {
    if (factors.keeps(j)) continue;
    const Slot slot = x_.program.residual[n + j];
    double rest = x_.memory.row(0)[slot], size = x_.scale(slot), left = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double a = matrix[(n + j) * x_.unknowns + i];
      rest += a * unknowns[i];
      size += std::abs(a * unknowns[i]);
      if (a != 0) left += std::abs(a) * acceleration_of_terms(i, matrix, unknowns);
    }
    if (std::abs(rest) <= 1e-6 * size + rounding * left) continue;
    contradicting_ = j;
    return false;
  }
  return true;
}

}  // namespace maupertuis::workspace
