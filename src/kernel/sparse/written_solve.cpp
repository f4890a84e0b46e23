#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

/// Factors and pivots are there from the beginning, the unknowns of a sum are not: what is known is multiplied first, so that a sum waits for
/// one operation after its newest unknown. Forward, what a part leaves for a sum between parts is a sum of its own; and all parts are
/// written down in the same order, so that they can be seen to be alike.
class SolveWriter {
 public:
  SolveWriter(const SparseSolver& solver, Builder& to) : s_(solver), to_(to), x_(s_.part_of_cell_.size(), to.literal(0)) {}

  void run(std::span<const SparseSolver::Wanted> wanted, std::span<const std::uint32_t> places) {
    for (std::uint32_t i = 0; i < s_.cell_of_residual_.size(); ++i) {
      const std::uint32_t place = places.empty() ? i : places[i];
      x_[s_.cell_of_residual_[i]] = place == no_place ? to_.literal(0) : to_.given(RightSideArray, place);
    }
    sweep(s_.forward_, true, true);
    add_up_parts();
    sweep(s_.forward_, true, false);
    partial_.clear();
    sweep(s_.backward_, false, false);
    sweep(s_.backward_, false, true);
    for (const auto& [cell, place] : wanted) to_.store(x_[cell], UnknownArray, place);
  }

 private:
  using Sweep = SparseSolver::Sweep;

  Value factor(std::uint32_t i) {
    return std::isnan(s_.literal_factor_[i]) ? to_.given(FactorArray, i) : to_.literal(s_.literal_factor_[i]);
  }

  void sweep(const Sweep& sweep, bool forward, bool of_parts) {
    for (const SumRun& run : sweep.runs)
      for (std::uint32_t i = run.first; i < run.last; ++i)
        if ((s_.part_of_pivot_[sweep.pivot[i]] != 0) == of_parts) write(sweep, run, i, forward);
    to_.set_part(0);
  }

  void write(const Sweep& sweep, const SumRun& run, std::uint32_t i, bool forward) {
    const std::uint32_t part = s_.part_of_pivot_[sweep.pivot[i]], cell = sweep.target[i];
    const Value scale = forward && !run.negates ? to_.given(InverseArray, sweep.pivot[i]) : to_.literal(run.negates ? -1 : 1);
    std::vector<Term> terms;
    if (run.starts) terms.push_back({1, scale, x_[cell]});
    if (!partial_.empty())
      for (const Value sum : partial_[cell]) terms.push_back({-1, scale, sum});
    const std::uint32_t first = run.first_product + (i - run.first) * run.products;
    for (std::uint32_t k = first; k < first + run.products; ++k)
      if (!forward || s_.part_of_cell_[sweep.operand[k]] == part) terms.push_back({-1, scale, factor(sweep.first_factor + k), x_[sweep.operand[k]]});
    to_.set_part(part);
    x_[cell] = to_.sum(std::move(terms));
  }

  /// Of what belongs to no part, in the order of its columns.
  void add_up_parts() {
    partial_.resize(x_.size());
    std::vector<std::pair<std::uint32_t, std::pair<const SumRun*, std::uint32_t>>> sums;
    for (const SumRun& run : s_.forward_.runs)
      for (std::uint32_t i = run.first; i < run.last; ++i)
        if (const std::uint32_t pivot = s_.forward_.pivot[i]; s_.part_of_pivot_[pivot] == 0) sums.push_back({s_.column_of_pivot_[pivot], {&run, i}});
    std::sort(sums.begin(), sums.end());
    for (std::uint32_t part = 1; part <= s_.parts_; ++part)
      for (const auto& [column, sum] : sums) {
        const auto [run, i] = sum;
        std::vector<Term> terms;
        const std::uint32_t first = run->first_product + (i - run->first) * run->products;
        for (std::uint32_t k = first; k < first + run->products; ++k)
          if (const std::uint32_t cell = s_.forward_.operand[k]; s_.part_of_cell_[cell] == part)
            terms.push_back({1, factor(s_.forward_.first_factor + k), x_[cell]});
        to_.set_part(part);
        if (!terms.empty()) partial_[s_.forward_.target[i]].push_back(to_.sum(std::move(terms)));
      }
  }

  const SparseSolver& s_;
  Builder& to_;
  std::vector<Value> x_;                      // [cells]
  std::vector<std::vector<Value>> partial_;   // [cells] sums of parts
};

straight::StraightLine SparseSolver::written_solve(std::span<const Wanted> wanted, std::span<const std::uint32_t> places) const {
  Builder to;
  SolveWriter(*this, to).run(wanted, places);
  return to.finish(solve_arrays, 1, 0);
}

}  // namespace maupertuis::sparse
