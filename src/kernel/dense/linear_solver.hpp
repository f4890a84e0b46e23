#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace maupertuis::dense {

/// M x = b with one factorization for many right-hand sides: Cholesky when M is symmetric and positive definite, else
/// LU with full pivoting, which reveals the rank. M is scaled to a unit diagonal first (by powers of two, so exactly),
/// so that units do not decide what counts as singular.
class LinearSolver {
 public:
  /// `may_be_symmetric`: what differs from a symmetric M by rounding of its diagonal is one. False: it is not, by its
  /// pattern, and entries as small as that mean what they say.
  explicit LinearSolver(std::size_t size, bool may_be_symmetric = true);
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;

  /// M, row by row [n × n]: filled by the caller, overwritten by factor().
  std::span<double> matrix();
  /// The index of an unknown that M does not determine, if M is singular to rounding. M must be finite.
  std::optional<std::size_t> factor();
  /// b → x in place. Precondition: factor() returned nothing.
  void solve(std::span<double> b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis::dense
