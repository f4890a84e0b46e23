#pragma once
#include <maupertuis/evaluate.hpp>

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis {

/// Rows R(q, q̇, q̈, λ) with their symbols; all other symbols are bound. Virtual displacements are those on which no λ
/// works: δq with (∂R/∂λ)ᵀ δq = 0, and so are velocities.
struct RowsOfMotion {
  std::vector<Expr> rows, q, v, a;  // [n] each
  std::vector<Expr> multipliers;    // [m] λ
  std::vector<Expr> positions;      // [h] φ(q) = 0, h ≤ m: the other λ belong to constraints on velocities
};

/// An eigenvalue of ∂R/∂q̈ ξ̈ + ∂R/∂q̇ ξ̇ + ∂R/∂q ξ + ∂R/∂λ δλ = 0, kept to the constraints, as it is in 100 digits,
/// rounded at last.
struct PreciseMode {
  std::complex<double> eigenvalue;  // Im ≥ 0; 0: below `error`
  double error = 0;                 // 10⁻²² of the largest eigenvalue where it is 0, else its rounding
  std::size_t multiplicity = 1;     // of the eigenvalue; above the number of shapes there are Jordan chains
  std::vector<std::vector<std::complex<double>>> shapes;  // [n] each, independent
};

/// At a root of the rows at rest and of φ next to `at`, which binds every symbol, found in 100 digits too. Eigenvalues
/// nearer than 10⁻²² of their size are one; so are those nearer than 10⁻²² of the largest, where ∂R/∂q is singular on
/// the displacements that are left. Nothing where M is singular on the velocities that are left, where the steps to the
/// root do not end below 10⁻⁴⁰ of `sizes` [n], or a value is none. Cost: all derivatives as formulas, O(n³) operations
/// in 100 digits.
std::optional<std::vector<PreciseMode>> precise_modes(const RowsOfMotion& motion, const Bindings& at,
                                                      std::span<const double> sizes);

}  // namespace maupertuis
