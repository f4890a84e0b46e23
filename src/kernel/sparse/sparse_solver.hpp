#pragma once
#include "kernel/sparse/elimination.hpp"
#include "kernel/sparse/sweep.hpp"
#include "kernel/sparse/written_entries.hpp"

#include <optional>

/// Factors and solutions of a lifted system as flat loops over index arrays: what is computed from what was decided
/// once, when the pivots were chosen. Nothing is allocated after construction.
namespace maupertuis::sparse {

/// What code of a solution works on, in this order; then its scratch.
enum SolveArray : std::uint32_t { FactorArray, InverseArray, RightSideArray, UnknownArray, solve_arrays };

/// The same of code of a factorization, whose entries are made of values at order 0 and of constants; and of code of
/// several solutions at once with the factors that they need.
enum FactorArrays : std::uint32_t {
  NowArray,
  ConstantArray,
  UsualSizeArray,
  FactorOutArray,
  FactorInverseArray,
  factor_arrays
};
enum ColumnArrays : std::uint32_t { UnitArray = ConstantArray + 1, ColumnArray, column_arrays };

inline constexpr std::uint32_t no_place = ~std::uint32_t{0};

/// As values of a straight line.
struct WrittenFactors {
  std::vector<straight::Value> factor, inverse;  // [factors], [pivots]
};

class SparseSolver {
 public:
  /// `cells`: [columns] where the unknowns stand in the array that solve() fills.
  SparseSolver(const LiftedSystem& system, const std::vector<Pivot>& pivots, std::span<const std::uint32_t> cells);

  /// The factors of the matrix with these entries. [entries]
  /// Returns the smallest pivot in units of the terms that it was computed from (what cancellation left of it) and of
  /// its size where the pivots were chosen; 0 or NaN where there are no factors.
  double factor(std::span<const double> entries);

  /// M₀ x = b: x and the wanted tangents in its direction, each in its cell; the cells of other unknowns are scratch.
  /// b_i: at places[i] of `right`, or at i where there are none.
  void solve(const double* right, std::span<const std::uint32_t> places, double* x) const;
  void solve(std::span<const double> b, double* x) const { solve(b.data(), {}, x); }

  /// A cell of x, and where its number goes.
  struct Wanted {
    std::uint32_t cell, place;
  };

  /// b_i is read at places[i], and is 0 where that is `no_place`; without places at i.
  struct RightSide {
    std::vector<Wanted> wanted;
    std::vector<std::uint32_t> places;
  };

  /// solve() as a straight line over the arrays of SolveArray; of x it stores what is wanted alone.
  straight::StraightLine written_solve(const RightSide& side) const;
  const double* factors() const { return factors_.data(); }
  const double* inverse_pivots() const { return inverse_.data(); }
  /// factor() as a straight line over the arrays of FactorArrays, of which three are below; sound() where every pivot
  /// is above `least_share` of what factor() measures it by. `entry` reads the first two.
  straight::StraightLine written_factor(const EntryWriter& entry, double least_share) const;
  /// factor() and a solution for each right side as a straight line over the arrays of ColumnArrays. No pivot is looked
  /// at.
  straight::StraightLine written_columns(const EntryWriter& entry, std::span<const RightSide> sides) const;
  double* factors() { return factors_.data(); }
  double* inverse_pivots() { return inverse_.data(); }
  const double* usual_sizes() const { return usual_size_.data(); }
  /// [columns] at which of the pivots each is eliminated.
  std::vector<std::uint32_t> order_of_columns() const;

  /// Products of a factorization and of a solution: their cost.
  std::size_t factor_count() const { return factors_.size(); }
  std::size_t factor_products() const { return factor_products_; }
  std::size_t solve_products() const { return forward_.operand.size() + backward_.operand.size(); }
  /// How many sums wait for each other in a solution.
  std::size_t solve_depth() const { return forward_depth_ + backward_depth_; }

 private:
  friend class SparseBuilder;
  friend class SolveWriter;
  friend class FactorWriter;

  /// Sums over factors and unknowns of a solution, in the order in which they are made.
  struct Sweep {
    std::vector<SweepSum> sums;          // targets are cells; pivot, forward: of the row
    std::vector<std::uint32_t> operand;  // [products] cells
    std::uint32_t first_factor = 0;      // of the first product in factors_; they follow each other
  };

  WrittenFactors write_factors(straight::Builder& to, const EntryWriter& entry,
                               std::optional<double> least_share) const;
  void write_solutions(straight::Builder& to, const WrittenFactors& factors, std::uint32_t right, std::uint32_t unknown,
                       std::span<const RightSide> sides) const;

  std::vector<std::uint32_t> cell_of_residual_;  // [unknowns] where b_i goes
  Sweep forward_, backward_;
  LoopSweep forward_loop_, backward_loop_;
  std::vector<FactorRun> factor_runs_;
  std::vector<FactorSum> sums_;
  std::vector<FactorProduct> products_;
  std::vector<double> factors_;         // L, then U divided by the pivots, in the order of the solution
  std::vector<double> literal_factor_;  // [factors] of those that are the same number at every point; else NaN
  std::vector<double> inverse_;         // [pivots]
  std::vector<double> usual_size_;      // [pivots] the largest at the sampled states
  // Parts, see Pivot; and orders in which they are alike.
  std::uint32_t parts_ = 0;
  std::vector<std::uint32_t> part_of_pivot_, column_of_pivot_, part_of_cell_, part_of_factor_;
  std::vector<std::uint64_t> place_of_sum_;  // [sums] row and column
  std::vector<double> entries_;              // [entries + 1] the last one 0
  std::size_t factor_products_ = 0, forward_depth_ = 0, backward_depth_ = 0;
};

}  // namespace maupertuis::sparse
