#pragma once
#include "kernel/workspace/full_factors.hpp"

#include <cstdint>
#include <vector>

namespace maupertuis::workspace {

/// −M₀⁻¹ of up to 48 unknowns, symmetric, so that solutions are products. A matrix that is what it was keeps its
/// inverse.
class Inverse {
 public:
  Inverse(const Expansion& x, const ResidualPlaces& residual, const Tangents& tangents);
  Inverse(const Inverse&) = delete;

  /// Rows, padded to whole vectors; empty where there are too many unknowns. Code fills it.
  double* values() { return values_.data(); }
  double diagonal(std::size_t i) const { return values_[i * x_.padded_unknowns() + i]; }
  /// Without pivots: M₀ has to be symmetric and positive definite. False: it is not.
  bool find(FullMatrix& matrix);
  /// From its factors, with constraints. False: it is worth less than they are.
  bool find(FullMatrix& matrix, const FullFactors& factors);
  /// For the residual of a row, x [padded]; false: it is not finite.
  bool solve(const double* row, double* x) const;
  /// What the engine wants to run stages by it.
  packed::InverseSolution for_engine();

 private:
  void find_own_vectors();
  bool is_of(const std::vector<double>& matrix) const { return !inverted_.empty() && inverted_ == matrix; }

  const Expansion& x_;
  const ResidualPlaces& residual_;
  const Tangents& tangents_;
  Doubles values_;
  std::vector<double> inverted_;  // the matrix that it belongs to; empty: none, or that of code
  Doubles answers_;               // scratch of Engine::run_stages_by_inverse
  std::vector<std::int8_t> own_;  // see packed::InverseSolution
};

}  // namespace maupertuis::workspace
