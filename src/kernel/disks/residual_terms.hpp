#pragma once
#include "kernel/program/program.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace maupertuis {

/// The rows R_j = Σ c f as sums of terms, each of which is bounded on the disk that suits it:
///
///     Σ_f |c| min over disks of tail_f(r) x^p/(1 − x),     x = h/r
///
/// is what the polynomials of a step of length h leave out of R_j. One disk for all does not do where near and far
/// bodies act on one: on a disk so large that the strong force of a near one is told to rounding, a far and light one
/// may be met, whose force a smaller disk tells well enough.
class ResidualTerms {
 public:
  /// dʳa/dtʳ with r = shift, or a b.
  struct Term {
    Slot a, b;
    std::uint32_t shift;
  };
  /// The program must outlive this.
  explicit ResidualTerms(const Program& program);

  std::size_t rows() const { return ends_.size(); }
  /// [program.constants]; anew whenever parameters or sides change.
  void set_constants(const double* constants);
  /// A step begins: no disk has been asked.
  void begin() { radii_.clear(), tails_.clear(); }
  /// tail(term): of a term without its coefficient on |s| ≤ radius; infinite or not a number: no bound.
  template <class F>
  void add_disk(double radius, F&& tail) {
    radii_.push_back(radius);
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      const double bound = sizes_[t] == 0 ? 0.0 : sizes_[t] * tail(terms_[t]);
      tails_.push_back(bound < infinity ? bound : infinity);
    }
  }
  /// What a step of length h leaves out, on disks of twice that and more. order: of the polynomial of q̇; without: a bit
  /// for each disk that is not to be used.
  void find_left_out(double h, int order, std::uint32_t without = 0);
  const std::vector<double>& radii() const { return radii_; }
  double left_out(std::size_t j) const { return left_out_[j]; }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  void add_terms(Slot slot, int depth);

  const Program& program_;
  std::vector<int> maker_;         // [slots] instruction; −1: none
  std::vector<Term> terms_;        // row after row
  std::vector<std::size_t> ends_;  // [rows] of their terms
  // The coefficient of a term is a product of constants.
  std::vector<ConstantId> path_, factors_;
  std::vector<std::size_t> factors_end_;  // [terms]
  std::vector<double> sizes_;             // [terms] |c|
  std::vector<double> radii_, tails_;     // [disks], [disks × terms]
  std::vector<double> weights_, left_out_;
};

}  // namespace maupertuis
