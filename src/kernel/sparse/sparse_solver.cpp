#include "kernel/sparse/sparse_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace maupertuis::sparse {
namespace {
constexpr std::uint32_t none = ~std::uint32_t{0};
}  // namespace

/// With pivots p = 0, 1, … in order, at places (r_p, c_p): L holds the columns below them, U the rows beside them divided by the
/// pivot. Then  y_p = (b_{r_p} − Σ_{k<p} L_{r_p,k} y_k)/d_p,  x_{c_p} = y_p − Σ_{j>p} U_{p,j} x_{c_j}.
class SparseBuilder {
 public:
  SparseBuilder(const LiftedSystem& system, const std::vector<Pivot>& pivots, std::span<const std::uint32_t> cells, SparseSolver& solver)
      : system_(system), pivots_(pivots), cells_(cells), s_(solver), pivot_of_row_(system.size), pivot_of_column_(system.size) {}

  void run() {
    for (std::uint32_t p = 0; p < pivots_.size(); ++p)
      pivot_of_row_[pivots_[p].row] = p, pivot_of_column_[pivots_[p].column] = p;
    for (std::uint32_t e = 0; e < system_.entries.size(); ++e) entry_at_[key(system_.entries[e].row, system_.entries[e].column)] = e;
    build_forward();
    build_backward();
    build_factorization();
    s_.inverse_.assign(pivots_.size(), 0.0);
    for (const Pivot& pivot : pivots_) s_.usual_size_.push_back(pivot.size);
    s_.entries_.assign(system_.entries.size() + 1, 0.0);
  }

 private:
  struct Sum {
    std::uint32_t pivot, level;
    bool starts;
    std::vector<std::uint32_t> others;  // pivots whose unknowns it reads, the latest known last
  };

  static std::uint64_t key(std::uint32_t row, std::uint32_t column) { return (std::uint64_t{row} << 32) | column; }
  std::uint32_t cell(std::uint32_t pivot) const { return cells_[pivots_[pivot].column]; }

  /// y is structurally zero where neither b nor an earlier y enters: those rows cost nothing.
  void build_forward() {
    const std::size_t n = pivots_.size();
    std::vector<std::vector<std::uint32_t>> lower(n);  // [pivots] earlier pivots with an entry in its row
    for (std::uint32_t p = 0; p < n; ++p)
      for (const std::uint32_t row : pivots_[p].rows) lower[pivot_of_row_[row]].push_back(p);
    std::vector<bool> has_b(n, false);
    for (const std::uint32_t row : system_.row_of_residual) {
      has_b[pivot_of_row_[row]] = true;
      s_.cell_of_residual_.push_back(cell(pivot_of_row_[row]));
    }
    has_y_ = has_b;
    std::vector<std::uint32_t> level(n, 0);
    std::vector<Sum> sums;
    for (std::uint32_t p = 0; p < n; ++p) {
      Sum sum{p, 0, true, {}};
      for (const std::uint32_t k : lower[p])
        if (has_y_[k]) sum.others.push_back(k), level[p] = std::max(level[p], level[k] + 1);
      has_y_[p] = has_b[p] || !sum.others.empty();
      if (!has_y_[p]) continue;
      if (!has_b[p]) s_.cleared_.push_back(cell(p));
      sum.level = level[p];
      std::stable_sort(sum.others.begin(), sum.others.end(), [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
      s_.forward_depth_ = std::max<std::size_t>(s_.forward_depth_, sum.level + 1);
      sums.push_back(std::move(sum));
    }
    lay_out(s_.forward_, sums, [&](const Sum& sum, std::uint32_t other) { return key(pivots_[sum.pivot].row, pivots_[other].column); });
  }

  void build_backward() {
    const std::size_t n = pivots_.size();
    std::vector<bool> needed(n, false);
    for (std::uint32_t p = 0; p < n; ++p) {  // U refers to later pivots
      needed[p] = needed[p] || system_.wanted[pivots_[p].column];
      if (needed[p])
        for (const std::uint32_t column : pivots_[p].columns) needed[pivot_of_column_[column]] = true;
    }
    std::vector<std::uint32_t> level(n, 0);
    std::vector<Sum> sums;
    for (std::uint32_t p = static_cast<std::uint32_t>(n); p-- > 0;) {
      if (!needed[p]) continue;
      Sum sum{p, 0, has_y_[p], {}};
      for (const std::uint32_t column : pivots_[p].columns) {
        const std::uint32_t j = pivot_of_column_[column];
        sum.others.push_back(j);
        level[p] = std::max(level[p], level[j] + 1);
      }
      if (sum.others.empty() && has_y_[p]) continue;  // x = y
      sum.level = level[p];
      std::stable_sort(sum.others.begin(), sum.others.end(), [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
      s_.backward_depth_ = std::max<std::size_t>(s_.backward_depth_, sum.level + 1);
      sums.push_back(std::move(sum));
    }
    lay_out(s_.backward_, sums, [&](const Sum& sum, std::uint32_t other) { return key(pivots_[sum.pivot].row, pivots_[other].column); });
  }

  template <class Key>
  void lay_out(SparseSolver::Sweep& sweep, std::vector<Sum>& sums, Key&& place) {
    const auto order = [](const Sum& sum) { return std::tuple(sum.level, sum.others.size(), sum.starts); };
    std::stable_sort(sums.begin(), sums.end(), [&](const Sum& a, const Sum& b) { return order(a) < order(b); });
    sweep.first_factor = next_factor_;
    for (std::uint32_t i = 0; i < sums.size(); ++i) {
      const Sum& sum = sums[i];
      if (i == 0 || order(sums[i - 1]) != order(sum))
        sweep.runs.push_back({static_cast<std::uint32_t>(sum.others.size()), i, i, static_cast<std::uint32_t>(sweep.operand.size()), sum.starts});
      sweep.runs.back().last = i + 1;
      sweep.target.push_back(cell(sum.pivot));
      sweep.pivot.push_back(sum.pivot);
      for (const std::uint32_t other : sum.others) {
        sweep.operand.push_back(cell(other));
        factor_at_[place(sum, other)] = next_factor_++;
      }
    }
  }

  std::uint32_t factor_at(std::uint64_t place) {
    const auto [found, fresh] = factor_at_.try_emplace(place, next_factor_);
    if (fresh) ++next_factor_;
    return found->second;
  }

  /// An entry of L or U is its entry of the matrix minus the products of all earlier pivots.
  void build_factorization() {
    std::unordered_map<std::uint64_t, std::vector<SparseSolver::FactorProduct>> products;
    std::uint32_t p = 0;
    while (p < pivots_.size()) {
      std::uint32_t last = p;
      while (last < pivots_.size() && pivots_[last].round == pivots_[p].round) ++last;
      add_stage(p, last, products);
      for (; p < last; ++p) {
        const Pivot& pivot = pivots_[p];
        for (const std::uint32_t row : pivot.rows)
          for (const std::uint32_t column : pivot.columns)
            products[key(row, column)].push_back({factor_at(key(row, pivot.column)), factor_at(key(pivot.row, column))});
      }
    }
    s_.factor_products_ = s_.products_.size();
    s_.factors_.assign(next_factor_, 0.0);
  }

  void add_stage(std::uint32_t first, std::uint32_t last,
                 const std::unordered_map<std::uint64_t, std::vector<SparseSolver::FactorProduct>>& products) {
    const auto add = [&](std::uint32_t target, std::uint32_t row, std::uint32_t column, std::uint32_t pivot) {
      const auto entry = entry_at_.find(key(row, column));
      const auto from = static_cast<std::uint32_t>(s_.products_.size());
      if (const auto found = products.find(key(row, column)); found != products.end())
        s_.products_.insert(s_.products_.end(), found->second.begin(), found->second.end());
      const auto start = entry == entry_at_.end() ? static_cast<std::uint32_t>(system_.entries.size()) : entry->second;
      s_.sums_.push_back({target, start, pivot, from, static_cast<std::uint32_t>(s_.products_.size())});
    };
    const auto count = [&] { return static_cast<std::uint32_t>(s_.sums_.size()); };
    SparseSolver::FactorStage stage{count(), 0, 0, 0};
    for (std::uint32_t p = first; p < last; ++p) add(none, pivots_[p].row, pivots_[p].column, p);
    stage.first_lower = count();
    for (std::uint32_t p = first; p < last; ++p)
      for (const std::uint32_t row : pivots_[p].rows) add(factor_at(key(row, pivots_[p].column)), row, pivots_[p].column, p);
    stage.first_upper = count();
    for (std::uint32_t p = first; p < last; ++p)
      for (const std::uint32_t column : pivots_[p].columns) add(factor_at(key(pivots_[p].row, column)), pivots_[p].row, column, p);
    stage.last = count();
    s_.stages_.push_back(stage);
  }

  const LiftedSystem& system_;
  const std::vector<Pivot>& pivots_;
  std::span<const std::uint32_t> cells_;
  SparseSolver& s_;
  std::vector<std::uint32_t> pivot_of_row_, pivot_of_column_;
  std::vector<bool> has_y_;  // [pivots]
  std::unordered_map<std::uint64_t, std::uint32_t> entry_at_, factor_at_;
  std::uint32_t next_factor_ = 0;
};

SparseSolver::SparseSolver(const LiftedSystem& system, const std::vector<Pivot>& pivots, std::span<const std::uint32_t> cells) {
  SparseBuilder(system, pivots, cells, *this).run();
}

double SparseSolver::factor(std::span<const double> entries) {
  std::copy(entries.begin(), entries.end(), entries_.begin());
  double least = 1;
  const auto value = [&](const FactorSum& sum) {
    double v = entries_[sum.entry];
    for (std::uint32_t k = sum.first; k < sum.last; ++k) v -= factors_[products_[k].lower] * factors_[products_[k].upper];
    return v;
  };
  for (const FactorStage& stage : stages_) {
    for (std::uint32_t i = stage.first_pivot; i < stage.first_lower; ++i) {
      const FactorSum& sum = sums_[i];
      double v = entries_[sum.entry], size = std::max(usual_size_[sum.pivot], std::abs(v));
      for (std::uint32_t k = sum.first; k < sum.last; ++k) {
        const double term = factors_[products_[k].lower] * factors_[products_[k].upper];
        v -= term;
        size += std::abs(term);
      }
      if (!(size < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::quiet_NaN();
      if (!(std::abs(v) >= least * size)) least = std::abs(v) / size;
      inverse_[sum.pivot] = 1 / v;
    }
    for (std::uint32_t i = stage.first_lower; i < stage.first_upper; ++i) factors_[sums_[i].target] = value(sums_[i]);
    for (std::uint32_t i = stage.first_upper; i < stage.last; ++i) factors_[sums_[i].target] = value(sums_[i]) * inverse_[sums_[i].pivot];
  }
  return least;
}

template <int Products>
void SparseSolver::forward_run(const SumRun& run, double* x) const {
  const double* factor = factors_.data() + forward_.first_factor + run.first_product;
  const std::uint32_t* operand = forward_.operand.data() + run.first_product;
  const int count = Products >= 0 ? Products : static_cast<int>(run.products);
  for (std::uint32_t i = run.first; i < run.last; ++i, factor += count, operand += count) {
    double sum = x[forward_.target[i]];
    for (int k = 0; k < count; ++k) sum -= factor[k] * x[operand[k]];
    x[forward_.target[i]] = sum * inverse_[forward_.pivot[i]];
  }
}

template <int Products>
void SparseSolver::backward_run(const SumRun& run, double* x) const {
  const double* factor = factors_.data() + backward_.first_factor + run.first_product;
  const std::uint32_t* operand = backward_.operand.data() + run.first_product;
  const int count = Products >= 0 ? Products : static_cast<int>(run.products);
  for (std::uint32_t i = run.first; i < run.last; ++i, factor += count, operand += count) {
    double sum = run.starts ? x[backward_.target[i]] : 0;
    for (int k = 0; k < count; ++k) sum -= factor[k] * x[operand[k]];
    x[backward_.target[i]] = sum;
  }
}

void SparseSolver::solve(std::span<const double> b, double* x) const {
  for (const std::uint32_t cell : cleared_) x[cell] = 0;
  for (std::size_t i = 0; i < b.size(); ++i) x[cell_of_residual_[i]] = b[i];
  for (const SumRun& run : forward_.runs) switch (run.products) {
      case 0: forward_run<0>(run, x); break;
      case 1: forward_run<1>(run, x); break;
      case 2: forward_run<2>(run, x); break;
      case 3: forward_run<3>(run, x); break;
      case 4: forward_run<4>(run, x); break;
      default: forward_run<-1>(run, x);
    }
  for (const SumRun& run : backward_.runs) switch (run.products) {
      case 0: backward_run<0>(run, x); break;
      case 1: backward_run<1>(run, x); break;
      case 2: backward_run<2>(run, x); break;
      case 3: backward_run<3>(run, x); break;
      case 4: backward_run<4>(run, x); break;
      default: backward_run<-1>(run, x);
    }
}

}  // namespace maupertuis::sparse
