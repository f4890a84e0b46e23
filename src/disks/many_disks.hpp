#pragma once
#include "disks/plan.hpp"
#include "disks/residual_terms.hpp"

#include <maupertuis/disks.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace maupertuis {

/// The terms of the rows on several disks about one centre at once, each bounded on that which suits it:
///
///     Σ_f |c| min over disks of tail_f(r) x^p/(1 − x),     x = h/r
///
/// is what the polynomials of a step of length h leave out of R_j. One disk for all does not do where near and far
/// bodies act on one: on a disk so large that the strong force of a near one is told to rounding, a far and light one
/// may be met, whose force a smaller disk tells well enough.
class ManyDisks {
 public:
  using Radii = std::array<double, Disks::many>;
  /// Of one term without its coefficient, on each disk; infinite or not a number: no bound.
  using Tails = std::array<double, Disks::many>;
  /// As many disks a pass as the registers of this processor hold: of P passes the k-th has the disks k, k + P, k + 2 P
  /// …, so that each is spread over all sizes.
  struct Values {
    virtual ~Values() = default;
    virtual std::size_t passes() const = 0;
    virtual void evaluate(const SlotCoefficients& coefficients, const Radii& radii, std::size_t pass,
                          std::span<const ResidualTerms::Term> terms, Tails* tails) = 0;
  };

  /// The program must outlive this.
  explicit ManyDisks(const Program& program);
  ManyDisks(const Program& program, std::unique_ptr<Values> values);
  void set_constants(const double* constants);
  /// radii: from the largest to the smallest. The rows have to stay until the last ask_more().
  void begin(const SlotCoefficients& coefficients, const Radii& radii);
  /// One pass. Which is the first does not matter to what a step may be: more disks never say less, and all are asked
  /// before a length is refused.
  bool ask_more();
  /// What a step of length h leaves out, on the disks asked so far of twice that and more.
  void find_left_out(double h);
  double left_out(std::size_t j) const { return left_out_[j]; }
  const ResidualTerms& rows() const { return rows_; }

 private:
  std::array<double, Disks::many> weights_for(double h) const;

  ResidualTerms rows_;
  DiskPlan plan_;  // of the terms alone: rows are added up here
  std::unique_ptr<Values> values_;
  SlotCoefficients now_;
  Radii radii_{};
  std::size_t asked_ = 0, first_ = 0;  // passes of this step; the one that was asked last in the step before
  std::vector<Tails> tails_;           // [terms]
  std::vector<double> least_;          // [terms]
  std::vector<double> left_out_;       // [rows]
};

/// Null where the compiler does not know these instructions.
std::unique_ptr<ManyDisks::Values> baseline_disks(const DiskPlan& plan);
std::unique_ptr<ManyDisks::Values> avx2_disks(const DiskPlan& plan);
std::unique_ptr<ManyDisks::Values> avx512_disks(const DiskPlan& plan);

}  // namespace maupertuis
