#include "kernel/sparse/sparse_solver.hpp"
#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

/// Sums of FactorTables, those of parts first; what a part leaves for the others is a sum of its own. Factors that are
/// the same number at every point are not stored, since written_solve knows them.
class FactorWriter {
 public:
  /// Without `least_share` nothing is stored and no pivot checked.
  FactorWriter(const SparseSolver& solver, Builder& to, const EntryWriter& entry, std::optional<double> least_share)
      : s_(solver),
        to_(to),
        entry_(entry),
        least_share_(least_share),
        factor_(s_.factors_.size(), straight::none),
        inverse_(s_.inverse_.size(), to.literal(-1)),
        partial_(s_.sums_.size()) {
    for (std::size_t i = 0; i < factor_.size(); ++i)
      if (!std::isnan(s_.literal_factor_[i])) factor_[i] = to.literal(s_.literal_factor_[i]);
  }

  WrittenFactors run() {
    sums(true);
    add_up_parts();
    sums(false);
    to_.set_part(0);
    return {std::move(factor_), std::move(inverse_)};
  }

 private:
  std::uint32_t part_of(std::uint32_t sum) const { return s_.part_of_pivot_[s_.sums_[sum].pivot]; }
  bool is_known(const FactorRun& run, std::uint32_t sum) const {
    return run.kind != FactorRun::Pivot && factor_[s_.sums_[sum].target] != straight::none;
  }

  void sums(bool of_parts) {
    for (const FactorRun& run : s_.factor_runs_)
      for (std::uint32_t i = run.first; i < run.last; ++i)
        if ((part_of(i) != 0) == of_parts && !is_known(run, i)) sum(run, i);
  }

  std::vector<Term> products(const FactorRun& run, std::uint32_t sum, std::uint32_t part) const {
    std::vector<Term> terms;
    const std::uint32_t first = run.first_product + (sum - run.first) * run.products;
    for (std::uint32_t k = first; k < first + run.products; ++k)
      if (const FactorProduct& p = s_.products_[k]; s_.part_of_factor_[p.lower] == part)
        terms.push_back({-1, factor_[p.lower], factor_[p.upper]});
    return terms;
  }

  void sum(const FactorRun& run, std::uint32_t i) {
    const FactorSum& sum = s_.sums_[i];
    to_.set_part(part_of(i));
    std::vector<Term> terms = products(run, i, part_of(i));
    for (const Value partial : partial_[i]) terms.push_back({1, partial});
    const bool starts = sum.entry + 1 < s_.entries_.size();  // the last one is 0
    const Value entry = starts ? entry_(to_, sum.entry) : to_.literal(0);
    if (run.kind == FactorRun::Pivot) return pivot(sum.pivot, entry, std::move(terms));
    terms.push_back({1, entry});
    factor_[sum.target] =
        to_.sum(std::move(terms), run.kind == FactorRun::Upper ? inverse_[sum.pivot] : straight::none);
    if (least_share_) to_.store(factor_[sum.target], FactorOutArray, sum.target);
  }

  void pivot(std::uint32_t p, Value entry, std::vector<Term> products) {
    std::vector<Term> terms = products;
    terms.push_back({1, entry});
    const Value pivot = to_.sum(std::move(terms));
    inverse_[p] = to_.reciprocal(pivot);
    if (!least_share_) return;
    const Value own = to_.larger(entry, to_.given(UsualSizeArray, p));
    const Value size = products.empty() ? own : to_.sum({{1, own}, {1, to_.magnitudes(products)}});
    to_.check({to_.magnitudes({{1, pivot}}), size, *least_share_});
    to_.store(inverse_[p], FactorInverseArray, p);
  }

  /// In the order of rows and columns.
  void add_up_parts() {
    std::vector<std::pair<std::uint64_t, std::pair<const FactorRun*, std::uint32_t>>> others;
    for (const FactorRun& run : s_.factor_runs_)
      for (std::uint32_t i = run.first; i < run.last; ++i)
        if (part_of(i) == 0) others.push_back({s_.place_of_sum_[i], {&run, i}});
    std::sort(others.begin(), others.end());
    for (std::uint32_t part = 1; part <= s_.parts_; ++part)
      for (const auto& [place, sum] : others) {
        to_.set_part(part);
        std::vector<Term> terms = products(*sum.first, sum.second, part);
        if (!terms.empty()) partial_[sum.second].push_back(to_.sum(std::move(terms)));
      }
  }

  const SparseSolver& s_;
  Builder& to_;
  const EntryWriter& entry_;
  std::optional<double> least_share_;
  std::vector<Value> factor_, inverse_;      // [factors], [pivots]
  std::vector<std::vector<Value>> partial_;  // [sums] of parts
};

WrittenFactors SparseSolver::write_factors(Builder& to, const EntryWriter& entry,
                                           std::optional<double> least_share) const {
  return FactorWriter(*this, to, entry, least_share).run();
}

straight::StraightLine SparseSolver::written_factor(const EntryWriter& entry, double least_share) const {
  Builder to;
  write_factors(to, entry, least_share);
  return to.finish(factor_arrays, 1, 0);
}

}  // namespace maupertuis::sparse
