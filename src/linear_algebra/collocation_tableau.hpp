#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace maupertuis {

/// Collocation with s stages at Gauss's points: order 2s, symplectic and symmetric. At Radau's, the end of the step
/// among them: order 2s − 1, and what decays faster than a step is gone after it, where Gauss's steps keep its size. A
/// is diagonal in a complex basis, so that the equations of all stages fall apart into s sparse systems, of which one
/// of each conjugate pair is solved.
struct CollocationTableau {
  enum class Points { Gauss, Radau };
  explicit CollocationTableau(int stages, Points points = Points::Gauss);
  std::size_t stages;
  int order;
  std::vector<double> c, b, a;                               // [s], [s], [s × s]
  std::vector<double> d;                                     // bᵀA⁻¹: Σ b_j F_j h = Σ d_i (P_i − p_0)
  std::vector<std::complex<double>> lambda, basis, inverse;  // A = T diag(λ) T⁻¹
  /// Σ_i weights_i f_i at 1 + c_j continues the polynomial through f_i at c_i: [s × s].
  std::vector<double> continuation;
};

}  // namespace maupertuis
