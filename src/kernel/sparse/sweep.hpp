#pragma once
#include "kernel/sparse/loops.hpp"

#include <vector>

namespace maupertuis::sparse {

/// One of the two substitutions of a solution, in the order in which loops run it: sums as soon as their operands are
/// known, and what nothing waits for last.
///
/// Of a chain most sums are a *recurrence* from joint to joint. A joint h reads what the links before it bring in one
/// or more sides a_j (the coordinates of a point), and each side reads itself and the joint before:
///
///     sides   a₁ ───→ a₁′ ───→ a₁″          a_j′ = s_j a_j′ + f_j a_j + g_j h
///                ↗   ╲   ↗   ╲              h′   = s h′ + Σ_j p_j a_j′
///     joint   h       h′      h″                 = (s h′ + Σ_j p_j (s_j a_j′ + f_j a_j)) + (Σ_j p_j g_j) h
///
/// Written in the last way a joint waits for one product of the joint before instead of for the sides between them, and
/// both stay in registers: a number that goes through memory is there some 8 cycles later.
class LoopSweep {
 public:
  LoopSweep() = default;
  /// `operands`: [products] cells. No sum reads what a later one makes.
  LoopSweep(const std::vector<SweepSum>& sums, const std::vector<std::uint32_t>& operands);

  /// After a factorization; `factors`: [products] as the sums had them. `inverse_pivots`: by which sums are multiplied,
  /// or null. Factors times pivots are made here once, not in each solution.
  void set(const double* factors, const double* inverse_pivots);
  SweepTables tables() const {
    return {runs_.data(), runs_.data() + runs_.size(), sums_.data(), operand_.data(), scale_.data(), factors_.data()};
  }

 private:
  friend class SweepOrder;

  std::vector<SweepRun> runs_;
  std::vector<SweepSum> sums_;
  std::vector<std::uint32_t> operand_, source_, sum_of_product_;  // [products] source: place as the sums had it
  std::vector<double> scale_, factors_;                           // [sums], [products] with their signs
};

}  // namespace maupertuis::sparse
