#pragma once
#include <maupertuis/disks.hpp>

#include <cmath>
#include <cstddef>
#include <span>
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
  /// Whether velocities have grown so much since the last set_momenta, or that lies so far back, that momenta are to be found anew. M changes along the
  /// motion, but its size is all that counts. rates: [n] the largest velocities so far.
  bool wants_momenta(std::span<const double> rates);
  /// Σ_k |M_jk| rate_k with M of the point that the workspace holds.
  template <class Work>
  void set_momenta(std::span<const double> rates, const Work& work) {
    momentum_rates_.assign(rates.begin(), rates.end());
    momenta_.resize(rates.size(), 0.0);
    for (std::size_t j = 0; j < rates.size(); ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < rates.size(); ++k) sum += std::abs(static_cast<double>(work.mass(j, k))) * rates[k];
      momenta_[j] = std::max(momenta_[j], sum);
    }
  }
  /// The largest safe length up to `wanted` (> 0, may be infinite) for steps up to `most` (finite). 0: none was found.
  double within(const SlotCoefficients& coefficients, double wanted, double most);
  /// Bounds that `within` left, at the radius it chose.
  Disks& disks() { return disks_; }
  double radius() const { return radius_; }

 private:
  bool passes(double h);
  bool passes_on(double radius, double h, Disks::Depth depth);
  double allowed();
  double search(double most);
  double momentum(std::size_t j) const;

  Disks disks_;
  double tolerance_;
  int order_ = 0;
  std::vector<double> momenta_, momentum_rates_;  // [n] or empty; the rates that they belong to
  unsigned asked_momenta_ = 0;
  double ratio_ = 4.5;                 // radius over length that was right last
  double best_radius_ = 0;            // of the last search; 0: none yet
  double radius_ = 0;
  bool needs_coefficients_ = false;   // since the rules alone did not do in the last steps
  unsigned asked_ = 0;                // by coefficients so far
};

}  // namespace maupertuis::taylor
