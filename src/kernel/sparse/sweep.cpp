#include "kernel/sparse/sweep.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace maupertuis::sparse {
namespace {
/// Shorter spines are not worth their beginning.
constexpr std::size_t least_periods = 4;
}  // namespace

class SweepOrder {
 public:
  SweepOrder(std::vector<SweepSum> sums, LoopSweep& out) : sums_(std::move(sums)), out_(out) {}

  void run() {
    find_levels();
    for (std::size_t level = 0; level < levels_.size();) {
      const Spine spine = spine_from(level);
      if (spine.sums.size() >= least_periods * (spine.branches + 1)) {
        write_spine(spine);
        level += 2 * spine.sums.size() / (spine.branches + 1);
      } else {
        write_level(levels_[level++]);
      }
    }
    out_.scale_.assign(out_.target_.size(), 1.0);
    out_.factors_.assign(out_.operand_.size(), 0.0);
  }

 private:
  struct Spine {
    std::uint32_t branches = 0;
    std::vector<SweepSum> sums;  // the branches and the hub of each period
  };

  /// What nothing reads has a level of its own, the last.
  void find_levels() {
    std::map<std::uint32_t, std::size_t> level_of;  // cells
    std::map<std::uint32_t, bool> is_read;
    std::size_t most = 0;
    for (const SweepSum& sum : sums_) {
      std::size_t level = 0;
      for (const SweepSum::Product& product : sum.products) {
        is_read[product.operand] = true;
        if (const auto found = level_of.find(product.operand); found != level_of.end()) level = std::max(level, found->second + 1);
      }
      level_of[sum.target] = level;
      most = std::max(most, level + 1);
    }
    levels_.resize(most + 1);
    for (SweepSum& sum : sums_) levels_[is_read[sum.target] ? level_of[sum.target] : most].push_back(std::move(sum));
  }

  // ----------------------------------------------------------------------------------------------------------------- spines

  Spine spine_from(std::size_t level) const {
    Spine out;
    for (; level + 1 < levels_.size(); level += 2)
      if (!add_period(out, levels_[level], levels_[level + 1])) break;
    return out;
  }

  bool add_period(Spine& spine, std::vector<SweepSum> branches, const std::vector<SweepSum>& hubs) const {
    if (hubs.size() != 1 || !hubs[0].starts || hubs[0].products.size() != branches.size() || branches.empty() || branches.size() > most_branches) return false;
    const std::size_t m = branches.size();
    const SweepSum* const before = spine.sums.empty() ? nullptr : &spine.sums[spine.sums.size() - m - 1];
    if (before && (spine.branches != m || before->starts != branches[0].starts)) return false;
    for (const SweepSum& branch : branches)
      if (branch.products.size() != 2 || branch.starts != branches[0].starts) return false;
    const std::uint32_t last_hub = before ? before[m].target : branches[0].products[1].operand;
    SweepSum hub = hubs[0];
    for (std::size_t j = 0; j < m; ++j) {
      const auto follows = [&](const SweepSum& x) { return !before || x.products[0].operand == before[j].target; };
      const auto found = std::find_if(branches.begin() + static_cast<std::ptrdiff_t>(j), branches.end(), follows);
      if (found == branches.end() || found->products[1].operand != last_hub) return false;
      std::swap(branches[j], *found);
      const auto product = std::find_if(hub.products.begin() + static_cast<std::ptrdiff_t>(j), hub.products.end(),
                                        [&](const SweepSum::Product& p) { return p.operand == branches[j].target; });
      if (product == hub.products.end()) return false;
      std::swap(hub.products[j], *product);
    }
    spine.branches = static_cast<std::uint32_t>(m);
    spine.sums.insert(spine.sums.end(), branches.begin(), branches.end());
    spine.sums.push_back(hub);
    return true;
  }

  // ---------------------------------------------------------------------------------------------------------------- writing

  void open(const SweepSum& first, std::uint32_t branches) {
    const auto sum = static_cast<std::uint32_t>(out_.target_.size());
    out_.runs_.push_back({static_cast<std::uint32_t>(first.products.size()), sum, sum, static_cast<std::uint32_t>(out_.operand_.size()), branches, first.starts});
  }

  void write_spine(const Spine& spine) {
    open(spine.sums[0], spine.branches);
    const std::size_t period = spine.branches + 1;
    for (std::size_t i = 0; i < spine.sums.size(); ++i) {
      write(spine.sums[i]);
      if ((i + 1) % period == 0) write_product(spine.sums[i].products[0], spine.sums[i].pivot);  // room for what set() makes
    }
  }

  void write_level(std::vector<SweepSum>& level) {
    const auto shape = [](const SweepSum& sum) { return std::tuple(sum.products.size(), sum.starts); };
    std::stable_sort(level.begin(), level.end(), [&](const SweepSum& a, const SweepSum& b) { return shape(a) < shape(b); });
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i == 0 || shape(level[i - 1]) != shape(level[i])) open(level[i], 0);
      write(level[i]);
    }
  }

  void write(const SweepSum& sum) {
    out_.target_.push_back(sum.target);
    out_.pivot_.push_back(sum.pivot);
    for (const SweepSum::Product& product : sum.products) write_product(product, sum.pivot);
    ++out_.runs_.back().last;
  }

  void write_product(const SweepSum::Product& product, std::uint32_t pivot) {
    out_.operand_.push_back(product.operand);
    out_.source_.push_back(product.factor);
    out_.pivot_of_product_.push_back(pivot);
  }

  std::vector<SweepSum> sums_;
  LoopSweep& out_;
  std::vector<std::vector<SweepSum>> levels_;
};

LoopSweep::LoopSweep(std::vector<SweepSum> sums, bool divides) : divides_(divides) { SweepOrder(std::move(sums), *this).run(); }

void LoopSweep::set(const double* factors, const double* inverse_pivots) {
  if (divides_) {
    for (std::size_t i = 0; i < scale_.size(); ++i) scale_[i] = inverse_pivots[pivot_[i]];
    for (std::size_t k = 0; k < factors_.size(); ++k) factors_[k] = -inverse_pivots[pivot_of_product_[k]] * factors[source_[k]];
  } else {
    for (std::size_t k = 0; k < factors_.size(); ++k) factors_[k] = -factors[source_[k]];
  }
  for (const SweepRun& run : runs_)
    if (run.branches > 0) join_spine(run);
}

/// From hub to hub, through the branches.
void LoopSweep::join_spine(const SweepRun& run) {
  const std::uint32_t m = run.branches, periods = (run.last - run.first) / (m + 1);
  double* factor = factors_.data() + run.first_product;
  for (std::uint32_t i = 0; i < periods; ++i, factor += 3 * m + 1) {
    factor[3 * m] = 0;
    for (std::uint32_t j = 0; j < m; ++j) factor[3 * m] += factor[2 * m + j] * factor[2 * j + 1];
  }
}

SweepTables LoopSweep::tables() const {
  return {runs_.data(), runs_.data() + runs_.size(), target_.data(), operand_.data(), scale_.data(), factors_.data()};
}

}  // namespace maupertuis::sparse
