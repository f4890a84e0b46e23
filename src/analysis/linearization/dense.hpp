#pragma once
#include "analysis/linearization/matrices.hpp"

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

/// Factorizations of dense matrices, each compiled once.
namespace maupertuis {

/// The x of least norm among those with the smallest |a x − b|, and the rank of a; pivots below `threshold` of the
/// largest are zero.
struct LeastSquares {
  Matrix x;
  Index rank = 0;
};
LeastSquares least_squares(const Matrix& a, const Matrix& b, double threshold);

/// Columns that span the range of a, found by the largest pivots; as many as the rank.
std::vector<std::size_t> pivot_columns(const Matrix& a, double threshold);

/// An orthonormal basis whose first `kernel` columns span the kernel of a: rank-revealing QR of aᵀ, pivots below
/// `tolerance` are zero.
struct KernelFirst {
  Index kernel = 0;
  Matrix basis;
};
KernelFirst kernel_first(const Matrix& a, double tolerance);

/// The triangular factor [n × n] of the QR factorization of a [rows ≥ n]: it has the kernel of a.
Matrix triangular_factor(const Matrix& a);
/// The orthogonal factor [rows × rows].
Matrix orthogonal_factor(const Matrix& a);

/// Groups of indices that no entry of a [n × n] joins: what stands in one knows nothing of what stands in another,
/// and of its sizes. Each ascending.
std::vector<std::vector<Index>> uncoupled_parts(const Matrix& a);

struct SymmetricEigen {
  Vector values;   // ascending
  Matrix vectors;  // orthonormal columns
  Vector norms;    // ‖·‖ of the uncoupled part of each: its rounding is measured by it
};
SymmetricEigen symmetric_eigen(const Matrix& a);

/// L of a = L Lᵀ, and L⁻¹; nothing where a is not positive definite.
struct Cholesky {
  Matrix lower, inverse;
};
std::optional<Cholesky> cholesky(const Matrix& a);

struct GeneralEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  // unit columns
  Eigen::MatrixXcd left;     // rows wᴴ with left · vectors = 1
};
GeneralEigen general_eigen(const Matrix& a);

/// Powers of two that bring the entries of a near 1, rows · a · columns (Ruiz 2001): ranks and least steps do not
/// depend on units then.
struct Equilibration {
  Vector rows, columns;
  explicit Equilibration(const Matrix& a);
  Matrix of(const Matrix& a) const { return rows.asDiagonal() * a * columns.asDiagonal(); }
};

}  // namespace maupertuis
