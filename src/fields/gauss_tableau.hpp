#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace maupertuis {

/// Gauss's collocation with s stages: order 2s, symplectic and symmetric. A is diagonal in a complex basis, so that the
/// equations of all stages fall apart into s sparse systems, of which one of each conjugate pair is solved.
struct GaussTableau {
  explicit GaussTableau(int stages);
  std::size_t stages;
  std::vector<double> c, b, a;                               // [s], [s], [s × s]
  std::vector<double> d;                                     // bᵀA⁻¹: Σ b_j F_j h = Σ d_i (P_i − p_0)
  std::vector<std::complex<double>> lambda, basis, inverse;  // A = T diag(λ) T⁻¹
  /// Σ_i weights_i f_i at 1 + c_j continues the polynomial through f_i at c_i: [s × s].
  std::vector<double> continuation;
};

}  // namespace maupertuis
