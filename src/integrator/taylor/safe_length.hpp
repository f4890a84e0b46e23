#pragma once
#include "integrator/taylor/known_lengths.hpp"

#include <maupertuis/disks.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Bounds the length of a step so that no value of the program leaves more out than the step may err by
/// (docs/design/safe_steps.md).
///
/// With d_j the tail of R_j on |s| ≤ r and p the order of q̇, what is left out of the momentum j over a step of length h
/// = x r is at most h d_j x^p/(1 − x). It may be `tolerance` times the momentum that this row has had so far, or h
/// times what rounding makes of R_j.
class SafeLength {
 public:
  /// The program must outlive this.
  SafeLength(const Program& program, int order, double tolerance, std::shared_ptr<KnownLengths> shared = {});
  /// What several motions with the same constants may know together: handed to each of them.
  static std::shared_ptr<KnownLengths> shared_by_motions(const Program& program, int order, double tolerance);

  void forget();
  /// False: R is linear in q, and any length is safe.
  bool is_needed() const { return disks_.residual_has_tails(); }
  bool has_constants() const { return known().has_constants(); }
  void set_constants(const double* constants);
  /// Whether M is to be looked at for the momenta: at the beginning, and from time to time, since it changes along the
  /// motion, but its size is all that counts. In between momenta follow velocities that grow. rates: [n] the largest
  /// velocities so far.
  bool wants_momenta(std::span<const double> rates);
  /// Σ_k |M_jk| rate_k with M of the point that the workspace holds. Rows of constraints have no momentum: their
  /// rounding alone counts, since next to a singular position λ and q̈ are far more sensitive to them.
  template <class Work>
  void set_momenta(std::span<const double> rates, const Work& work) {
    const std::size_t n = rates.size();
    masses_.resize(n * n, 0.0);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k)
        masses_[j * n + k] = std::max(masses_[j * n + k], std::abs(static_cast<double>(work.mass(j, k))));
    find_momenta(rates);
  }
  /// The largest safe length up to `wanted` (> 0, may be infinite) for steps up to `most` (finite). 0: none was found.
  double within(const SlotCoefficients& coefficients, double time, double wanted, double most,
                const double* sizes = nullptr);
  /// The radius at which a step of length h is asked about first, and at which sizes may be given: [3][unknowns] as
  /// KnownLengths::ask says.
  double disk_radius(double h) const { return own_.disk_radius(h); }
  /// Bounds that `within` left, at the radius it chose.
  Disks& disks() { return disks_; }
  double radius() const { return radius_; }

 private:
  const KnownLengths& known() const { return uses_shared_ ? *shared_ : own_; }
  KnownLengths& known() { return uses_shared_ ? *shared_ : own_; }
  void find_momenta(std::span<const double> rates);
  void allow();
  bool is_known(const SlotCoefficients& coefficients, double time, double h, const double* sizes);
  std::span<const double> allowed_by_rounding(const SlotCoefficients& coefficients);
  bool is_safe_alone(const SlotCoefficients& coefficients);
  double within_bases(const SlotCoefficients& coefficients, double h);
  bool passes_somewhere(const SlotCoefficients& coefficients, double h);
  bool passes(double h);
  bool passes_by_terms(double h);
  bool passes_on(double radius, double h, Disks::Depth depth);
  double allowed();
  double search(const SlotCoefficients& coefficients, double most);
  double passing_length(double passes_at, double most);
  double momentum(std::size_t j) const;

  Disks disks_;
  double usual_ratio_;
  KnownLengths own_;
  std::shared_ptr<KnownLengths> shared_;
  bool uses_shared_ = false;     // whose constants are those of this motion
  std::vector<double> allowed_;  // [residuals] tolerance · momentum
  std::vector<double> allowed_by_rounding_;
  double tolerance_;
  int order_;
  std::vector<double> masses_;                    // [n][n] the largest |M| so far; empty: none
  std::vector<double> momenta_, momentum_rates_;  // [n] or empty; the rates that they belong to
  unsigned asked_momenta_ = 0;
  double largest_ratio_;
  double ratio_;                            // radius over length that was right last
  std::vector<double> all_ratios_;          // that are asked about, from large to small
  std::array<double, Disks::many> ratios_;  // where there are bases: of the disks of a step, from the largest to 2
  double best_radius_ = 0;                  // of the last search; 0: none yet
  double radius_ = 0;
  bool needs_coefficients_ = false;  // since the rules alone did not do in the last steps
  unsigned asked_ = 0;               // by coefficients so far
};

}  // namespace maupertuis::taylor
