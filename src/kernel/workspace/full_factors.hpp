#pragma once
#include "kernel/dense/bordered_solver.hpp"
#include "kernel/workspace/full_matrix.hpp"

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::workspace {

/// The factors of the full matrix, with pivots: they tell what is singular, and which constraints depend on others.
class FullFactors {
 public:
  explicit FullFactors(const Expansion& x) : x_(x) {}

  /// A matrix that is what it was, as between impacts of points, keeps its factors. False: the motion of `singular()`
  /// is not determined. Precondition: the matrix is finite.
  bool find(FullMatrix& matrix);
  std::size_t singular() const { return singular_; }
  /// b → its solution. Precondition: find().
  void solve(std::span<double> b) const { solver_->solve(b); }
  /// −M₀⁻¹, as BorderedSolver writes it.
  bool negative_inverse(double* inverse, std::size_t stride) const {
    return solver_->negative_inverse(inverse, stride);
  }

  // Where nothing was factored all constraints hold.
  bool keeps(std::size_t constraint) const { return !solver_ || solver_->keeps(constraint); }
  bool determines(std::size_t constraint) const { return !solver_ || solver_->determines(constraint); }
  double pivot_ratio() const { return solver_ ? solver_->pivot_ratio() : 1; }

 private:
  const Expansion& x_;
  std::optional<dense::BorderedSolver> solver_;
  std::vector<double> factored_;  // the matrix that they belong to; empty: none
  std::size_t singular_ = 0;
};

}  // namespace maupertuis::workspace
