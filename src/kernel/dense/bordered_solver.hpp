#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace maupertuis::dense {

/// [M −Aᵀ; −A 0] (x, λ) = b with one factorization for many right-hand sides; without constraints M x = b. M may be
/// singular as long as it is regular where A vanishes. The matrix is equilibrated first (by powers of two, so exactly),
/// so that units do not decide what counts as singular.
///
/// Rows of A that depend on others are dropped, by QR with pivoting: the motion does not need them, and which part of
/// the force each of them carries is not determined.
class BorderedSolver {
 public:
  /// `may_be_symmetric`: M, as for LinearSolver; with constraints it makes no difference.
  BorderedSolver(std::size_t freedoms, std::size_t constraints, bool may_be_symmetric = true);
  ~BorderedSolver();
  BorderedSolver(BorderedSolver&&) noexcept;

  /// Row by row [(n + m) × (n + m)]: filled by the caller, overwritten by factor(). It need not be symmetric.
  std::span<double> matrix();
  /// The index of a coordinate that M and A do not determine, if there is one. The matrix must be finite.
  std::optional<std::size_t> factor();
  /// b → (x, λ) in place; the entries of dropped rows are ignored, and their λ is 0.
  /// Precondition: factor() returned nothing.
  void solve(std::span<double> b) const;
  /// −K⁻¹ of the bordered matrix K, column d from inverse[d · stride] on. False: rows were dropped, or K is so badly
  /// conditioned that a product with its inverse loses digits that the factors keep; then nothing is written.
  bool negative_inverse(double* inverse, std::size_t stride) const;
  /// The smallest pivot of the equilibrated matrix against the largest: what it is worth; 1 without constraints.
  double pivot_ratio() const;
  /// Whether this row of A is in force, and whether its λ is determined: not where it takes part in a dependence.
  bool keeps(std::size_t constraint) const;
  bool determines(std::size_t constraint) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis::dense
