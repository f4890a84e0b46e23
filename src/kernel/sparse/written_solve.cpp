#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/straight_line/builder.hpp"

#include <cmath>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

/// Factors and pivots are there from the beginning, the unknowns of a sum are not: what is known is multiplied first, so that a sum waits for
/// one operation after its newest unknown.
straight::StraightLine SparseSolver::written_solve(std::span<const std::uint32_t> wanted) const {
  Builder to;
  std::uint32_t cells = 0;
  for (const auto* list : {&cell_of_residual_, &cleared_, &forward_.target, &backward_.target})
    for (const std::uint32_t cell : *list) cells = std::max(cells, cell + 1);
  for (const std::uint32_t cell : wanted) cells = std::max(cells, cell + 1);
  std::vector<Value> x(cells, to.literal(0));
  for (std::uint32_t i = 0; i < cell_of_residual_.size(); ++i) x[cell_of_residual_[i]] = to.given(RightSideArray, i);

  const auto factor = [&](std::uint32_t i) {
    return std::isnan(literal_factor_[i]) ? to.given(FactorArray, i) : to.literal(literal_factor_[i]);
  };
  const auto sums = [&](const Sweep& sweep, const SumRun& run, bool divides) {
    std::uint32_t product = run.first_product;
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const Value scale = divides && !run.negates ? to.given(InverseArray, sweep.pivot[i]) : to.literal(run.negates ? -1 : 1);
      std::vector<Term> terms;
      if (run.starts) terms.push_back({1, scale, x[sweep.target[i]]});
      for (std::uint32_t k = 0; k < run.products; ++k, ++product)
        terms.push_back({-1, scale, factor(sweep.first_factor + product), x[sweep.operand[product]]});
      x[sweep.target[i]] = to.sum(std::move(terms));
    }
  };
  for (const SumRun& run : forward_.runs) sums(forward_, run, true);
  for (const SumRun& run : backward_.runs) sums(backward_, run, false);
  for (const std::uint32_t cell : wanted) to.store(x[cell], UnknownArray, cell);
  return to.finish(solve_arrays, 1, 0);
}

}  // namespace maupertuis::sparse
