#pragma once
#include <maupertuis/constraint_manifold.hpp>

#include <eigen3/Eigen/SparseCore>

namespace maupertuis {

/// The diagonal of M, 1 where it has none or none that is positive.
Eigen::VectorXd positive_diagonal(const std::vector<MatrixEntry>& mass, std::size_t n);

/// The smallest δ in the metric M with A δ = −error, for rows and coordinates by the thousand: from the sparse system
///
///     M δ + Aᵀ μ = 0,   A δ − ε μ = −error
///
/// whose small ε makes it solvable where rows repeat each other; then δ is the one of the least squares.
class SparseStep {
 public:
  /// `free`: the coordinates that move.
  SparseStep(std::size_t n, const std::vector<Eigen::Index>& free);

  /// The chosen rows of A. By what each is multiplied so that its length is 1.
  Eigen::VectorXd set_rows(const std::vector<MatrixEntry>& a, const std::vector<std::size_t>& chosen);
  /// M, or where it is not positive definite its diagonal. Empty: no metric is known, every coordinate counts 1.
  void set_metric(const std::vector<MatrixEntry>& mass);
  /// `error`: of the rows of length 1. δ [n].
  Eigen::VectorXd solve(const Eigen::VectorXd& error) const;

 private:
  using Entries = std::vector<Eigen::Triplet<double>>;
  std::size_t n_;
  std::vector<Eigen::Index> free_, place_;  // place_ [n]: among the free ones, −1: held
  Eigen::Index rows_ = 0;
  Entries a_, metric_;
};

}  // namespace maupertuis
