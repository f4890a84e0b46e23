#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/straight_line/builder.hpp"

#include <cmath>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

/// Sums of FactorTables, in the same order; factors that are the same number at every point are not stored, since written_solve knows them.
straight::StraightLine SparseSolver::written_factor(double least_share) const {
  Builder to;
  std::vector<Value> factor(factors_.size(), straight::none), inverse(inverse_.size(), to.literal(-1));
  for (std::size_t i = 0; i < factors_.size(); ++i)
    if (!std::isnan(literal_factor_[i])) factor[i] = to.literal(literal_factor_[i]);
  const auto products = [&](const FactorRun& run, std::uint32_t sum) {
    std::vector<Term> terms;
    const std::uint32_t first = run.first_product + (sum - run.first) * run.products;
    for (std::uint32_t k = first; k < first + run.products; ++k) terms.push_back({-1, factor[products_[k].lower], factor[products_[k].upper]});
    return terms;
  };
  for (const FactorRun& run : factor_runs_)
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const FactorSum& sum = sums_[i];
      std::vector<Term> terms = products(run, i);
      const bool starts = sum.entry + 1 < entries_.size();  // the last one is 0
      const Value entry = starts ? to.given(EntryArray, sum.entry) : to.literal(0);
      if (run.kind == FactorRun::Pivot) {
        const Value own = to.larger(entry, to.given(UsualSizeArray, sum.pivot));
        const Value size = terms.empty() ? own : to.sum({{1, own}, {1, to.magnitudes(terms)}});
        terms.push_back({1, entry});
        const Value pivot = to.sum(std::move(terms));
        to.check({to.magnitudes({{1, pivot}}), size, least_share});
        inverse[sum.pivot] = to.reciprocal(pivot);
        to.store(inverse[sum.pivot], FactorInverseArray, sum.pivot);
        continue;
      }
      if (factor[sum.target] != straight::none) continue;
      terms.push_back({1, entry});
      factor[sum.target] = to.sum(std::move(terms), run.kind == FactorRun::Upper ? inverse[sum.pivot] : straight::none);
      to.store(factor[sum.target], FactorOutArray, sum.target);
    }
  return to.finish(factor_arrays, 1, 0);
}

}  // namespace maupertuis::sparse
