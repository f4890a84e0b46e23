#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

/// Forward and backward substitution with given factors, as a straight line.
///
/// Factors and inverse pivots are known from the beginning, unknowns become known one after the other. In each sum the
/// products with earlier unknowns come first, so that only one operation has to wait for the latest unknown. In the
/// forward part, what a part adds to an equation between parts is gathered in a sum of that part; and all parts are
/// written in the same order, so that widen() can find that they are alike. Where there are several right sides, an
/// unknown is found for all of them before the next unknown, because these sums do not depend on each other.
class SolveWriter {
 public:
  SolveWriter(const SparseSolver& solver, Builder& to, const WrittenFactors& factors)
      : s_(solver), to_(to), factors_(factors) {}

  void run(std::uint32_t right, std::uint32_t unknown, std::span<const SparseSolver::RightSide> sides) {
    for (const auto& side : sides) start(right, side.places);
    sweep(s_.forward_, true, true);
    add_up_parts();
    sweep(s_.forward_, true, false);
    partial_.clear();
    sweep(s_.backward_, false, false);
    sweep(s_.backward_, false, true);
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (const auto& [cell, place] : sides[i].wanted) to_.store(x_[i][cell], unknown, place);
  }

 private:
  using Sweep = SparseSolver::Sweep;

  void start(std::uint32_t right, std::span<const std::uint32_t> places) {
    std::vector<Value>& x = x_.emplace_back(s_.part_of_cell_.size(), to_.literal(0));
    for (std::uint32_t i = 0; i < s_.cell_of_residual_.size(); ++i) {
      const std::uint32_t place = places.empty() ? i : places[i];
      if (place != no_place) x[s_.cell_of_residual_[i]] = to_.given(right, place);
    }
  }

  void sweep(const Sweep& sweep, bool forward, bool of_parts) {
    for (const SweepSum& sum : sweep.sums)
      if ((s_.part_of_pivot_[sum.pivot] != 0) == of_parts) write(sweep, sum, forward);
    to_.set_part(0);
  }

  /// scale · factor · x
  struct Product {
    Value scale, factor;
    std::uint32_t cell;
  };

  void write(const Sweep& sweep, const SweepSum& sum, bool forward) {
    const Value scale = forward && !sum.negates ? factors_.inverse[sum.pivot] : to_.literal(sum.negates ? -1 : 1);
    const std::uint32_t part = s_.part_of_pivot_[sum.pivot];
    const bool shares = x_.size() > 1 && !to_.is_literal(scale);  // the product of both
    std::vector<Product> products;
    to_.set_part(part);
    for (std::uint32_t k = sum.first; k < sum.last; ++k) {
      const Value factor = factors_.factor[sweep.first_factor + k];
      if (forward && s_.part_of_cell_[sweep.operand[k]] != part) continue;
      products.push_back(
          {shares ? straight::none : scale, shares ? to_.product(1, scale, factor) : factor, sweep.operand[k]});
    }
    for (std::size_t side = 0; side < x_.size(); ++side) write(side, sum.target, sum.starts, scale, products);
  }

  void write(std::size_t side, std::uint32_t cell, bool starts, Value scale, const std::vector<Product>& products) {
    std::vector<Value>& x = x_[side];
    std::vector<Term> terms;
    if (starts) terms.push_back({1, scale, x[cell]});
    if (!partial_.empty())
      for (const Value sum : partial_[cell]) terms.push_back({-1, scale, sum});
    for (const Product& p : products) terms.push_back({-1, p.scale, p.factor, x[p.cell]});
    x[cell] = to_.sum(std::move(terms));
  }

  /// Of what belongs to no part, in the order of its columns.
  void add_up_parts() {
    if (s_.parts_ == 0) return;
    partial_.resize(s_.part_of_cell_.size());
    std::vector<std::pair<std::uint32_t, const SweepSum*>> sums;
    for (const SweepSum& sum : s_.forward_.sums)
      if (s_.part_of_pivot_[sum.pivot] == 0) sums.push_back({s_.column_of_pivot_[sum.pivot], &sum});
    std::sort(sums.begin(), sums.end());
    for (std::uint32_t part = 1; part <= s_.parts_; ++part)
      for (const auto& [column, sum] : sums) {
        std::vector<Term> terms;
        for (std::uint32_t k = sum->first; k < sum->last; ++k)
          if (const std::uint32_t cell = s_.forward_.operand[k]; s_.part_of_cell_[cell] == part)
            terms.push_back({1, factors_.factor[s_.forward_.first_factor + k], x_[0][cell]});
        to_.set_part(part);
        if (!terms.empty()) partial_[sum->target].push_back(to_.sum(std::move(terms)));
      }
  }

  const SparseSolver& s_;
  Builder& to_;
  const WrittenFactors& factors_;
  std::vector<std::vector<Value>> x_;        // [right sides][cells]
  std::vector<std::vector<Value>> partial_;  // [cells] sums of parts, of one right side
};

void SparseSolver::write_solutions(Builder& to, const WrittenFactors& factors, std::uint32_t right,
                                   std::uint32_t unknown, std::span<const RightSide> sides) const {
  SolveWriter(*this, to, factors).run(right, unknown, sides);
}

straight::StraightLine SparseSolver::written_solve(const RightSide& side) const {
  Builder to;
  WrittenFactors given;
  for (std::uint32_t i = 0; i < factors_.size(); ++i)
    given.factor.push_back(std::isnan(literal_factor_[i]) ? to.given(FactorArray, i) : to.literal(literal_factor_[i]));
  for (std::uint32_t p = 0; p < inverse_.size(); ++p) given.inverse.push_back(to.given(InverseArray, p));
  write_solutions(to, given, RightSideArray, UnknownArray, {&side, 1});
  return to.finish(solve_arrays, 1, 0);
}

straight::StraightLine SparseSolver::written_columns(const EntryWriter& entry, std::span<const RightSide> sides) const {
  Builder to;
  write_solutions(to, write_factors(to, entry, {}), UnitArray, ColumnArray, sides);
  return to.finish(column_arrays, 1, 0, straight::everything);
}

}  // namespace maupertuis::sparse
