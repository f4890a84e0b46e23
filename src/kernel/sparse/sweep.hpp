#pragma once
#include "kernel/sparse/loops.hpp"

#include <vector>

namespace maupertuis::sparse {

/// target ← scale · target − scale Σ factor · operand, where scale is 1 or of a pivot.
struct SweepSum {
  std::uint32_t target;  // cells, as the operands
  std::uint32_t pivot;
  bool starts;           // else the target counts as 0
  struct Product {
    std::uint32_t operand, factor;
  };
  std::vector<Product> products;
};

/// One of the two substitutions in the order of the loops. What nothing waits for comes last, all at once. Of the rest chains often have a
/// *spine*: branches, each from its own predecessor and the hub before, and a hub from them. Its numbers stay in registers, since a number that goes
/// through memory is there only after 9 cycles.
class LoopSweep {
 public:
  /// `sums`: none reads what a later one makes.
  LoopSweep(std::vector<SweepSum> sums, bool divides);
  LoopSweep() = default;

  /// After a factorization. Factors times pivots are made here once, not in each solution.
  void set(const double* factors, const double* inverse_pivots);
  SweepTables tables() const;

 private:
  void join_spine(const SweepRun& run);

  std::vector<std::uint32_t> target_, pivot_;                     // [sums]
  std::vector<std::uint32_t> operand_, source_, pivot_of_product_;  // [products]
  std::vector<SweepRun> runs_;
  std::vector<double> scale_, factors_;                           // [sums], [products] with their signs
  bool divides_ = false;

  friend class SweepOrder;
};

}  // namespace maupertuis::sparse
