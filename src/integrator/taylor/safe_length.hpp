#pragma once
#include <maupertuis/disks.hpp>

#include <cstddef>
#include <vector>

namespace maupertuis::taylor {

/// Bounds the length of a step so that no value of the program leaves more out than the step may err by (docs/design/safe_steps.md).
///
/// With d_j the tail of R_j on |s| ≤ r and p the order of q̇, what is left out of the momentum j over a step of length h = x r is at most
/// h d_j x^p/(1 − x). It may be `tolerance` times the momentum that this row has had so far, or h times what rounding makes of R_j.
class SafeLength {
 public:
  /// The program must outlive this.
  SafeLength(const Program& program, double tolerance);

  void forget();
  /// False: R is linear in q, and any length is safe.
  bool is_needed() const { return disks_.residual_has_tails(); }
  void set_constants(const double* constants) { disks_.set_constants(constants); }
  /// [unknowns] largest momenta Σ_k |M_jk q̇_k| so far; none are needed.
  void set_momenta(std::vector<double> momenta) { momenta_ = std::move(momenta); }
  /// The largest safe length up to `wanted` (> 0, may be infinite) for steps up to `most` (finite). 0: none was found.
  double within(const SlotCoefficients& coefficients, double wanted, double most);
  /// Bounds that `within` left, at the radius it chose.
  Disks& disks() { return disks_; }
  double radius() const { return radius_; }

 private:
  bool passes(double h);
  double allowed();
  double search(double most);
  double momentum(std::size_t j) const;

  Disks disks_;
  double tolerance_;
  int order_ = 0;
  std::vector<double> momenta_;       // [residuals] or empty
  double ratio_ = 4;                  // radius over length that was right last
  double best_radius_ = 0;            // of the last search; 0: none yet
  double radius_ = 0;
};

}  // namespace maupertuis::taylor
