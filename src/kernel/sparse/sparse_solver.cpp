#include "kernel/sparse/sparse_solver.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace maupertuis::sparse {
namespace {
constexpr std::uint32_t none = ~std::uint32_t{0};
}  // namespace

/// With pivots p = 0, 1, … in order, at places (r_p, c_p): L holds the columns below them, U the rows beside them
/// divided by the pivot. Then  y_p = (b_{r_p} − Σ_{k<p} L_{r_p,k} y_k)/d_p,  x_{c_p} = y_p − Σ_{j>p} U_{p,j} x_{c_j}.
class SparseBuilder {
 public:
  SparseBuilder(const LiftedSystem& system, const std::vector<Pivot>& pivots, std::span<const std::uint32_t> cells,
                SparseSolver& solver)
      : system_(system),
        pivots_(pivots),
        cells_(cells),
        s_(solver),
        pivot_of_row_(system.size),
        pivot_of_column_(system.size) {}

  void run() {
    for (std::uint32_t p = 0; p < pivots_.size(); ++p)
      pivot_of_row_[pivots_[p].row] = p, pivot_of_column_[pivots_[p].column] = p;
    for (std::uint32_t e = 0; e < system_.entries.size(); ++e)
      entry_at_[key(system_.entries[e].row, system_.entries[e].column)] = e;
    find_constant_pivots();
    s_.inverse_.assign(pivots_.size(), 0.0);
    build_forward();
    build_backward();
    build_factorization();
    for (const Pivot& pivot : pivots_) s_.usual_size_.push_back(pivot.size);
    s_.entries_.assign(system_.entries.size() + 1, 0.0);
    note_parts();
    s_.forward_loop_ = LoopSweep(s_.forward_.sums, s_.forward_.operand);
    s_.backward_loop_ = LoopSweep(s_.backward_.sums, s_.backward_.operand);
  }

 private:
  struct Sum {
    std::uint32_t pivot, level;
    bool starts, negates;
    std::vector<std::uint32_t> others;  // pivots whose unknowns it reads, the latest known last
  };

  static std::uint64_t key(std::uint32_t row, std::uint32_t column) { return (std::uint64_t{row} << 32) | column; }
  std::uint32_t cell(std::uint32_t pivot) const { return cells_[pivots_[pivot].column]; }

  /// Those of slots whose place nothing else enters.
  void find_constant_pivots() {
    std::vector<bool> constant(system_.entries.size(), false);
    for (const std::uint32_t entry : system_.minus_one) constant[entry] = true;
    for (const std::uint32_t entry : system_.entry_of_edge) constant[entry] = false;
    is_minus_one_.assign(pivots_.size(), false);
    for (std::uint32_t p = 0; p < pivots_.size(); ++p) {
      const auto entry = entry_at_.find(key(pivots_[p].row, pivots_[p].column));
      is_minus_one_[p] = entry != entry_at_.end() && constant[entry->second];
    }
    for (const Pivot& earlier : pivots_)
      for (const std::uint32_t row : earlier.rows)
        for (const std::uint32_t column : earlier.columns)
          if (pivot_of_row_[row] == pivot_of_column_[column]) is_minus_one_[pivot_of_row_[row]] = false;
  }

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
      Sum sum{p, 0, has_b[p], is_minus_one_[p], {}};
      for (const std::uint32_t k : lower[p])
        if (has_y_[k]) sum.others.push_back(k), level[p] = std::max(level[p], level[k] + 1);
      has_y_[p] = has_b[p] || !sum.others.empty();
      if (!has_y_[p]) continue;
      sum.level = level[p];
      std::stable_sort(sum.others.begin(), sum.others.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
      s_.forward_depth_ = std::max<std::size_t>(s_.forward_depth_, sum.level + 1);
      sums.push_back(std::move(sum));
    }
    lay_out(s_.forward_, sums,
            [&](const Sum& sum, std::uint32_t other) { return key(pivots_[sum.pivot].row, pivots_[other].column); });
  }

  /// What belongs to no part comes first, and the order within a part is that of the part alone: so parts that are
  /// alike stay so.
  void build_backward() {
    const std::size_t n = pivots_.size();
    std::uint32_t between_parts = 0;
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
      Sum sum{p, 0, has_y_[p], false, {}};
      for (const std::uint32_t column : pivots_[p].columns) {
        const std::uint32_t j = pivot_of_column_[column];
        sum.others.push_back(j);
        const bool is_known = pivots_[p].part != 0 && pivots_[j].part == 0;
        level[p] = std::max(level[p], is_known ? between_parts : level[j] + 1);
      }
      if (pivots_[p].part == 0) between_parts = std::max(between_parts, level[p] + 1);
      if (sum.others.empty() && has_y_[p]) continue;  // x = y
      sum.level = level[p];
      const auto order = [&](std::uint32_t a) {
        return pivots_[p].part != 0 && pivots_[a].part == 0 ? std::pair(0U, pivots_[a].column)
                                                            : std::pair(level[a], 0U);
      };
      std::stable_sort(sum.others.begin(), sum.others.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return order(a) < order(b); });
      s_.backward_depth_ = std::max<std::size_t>(s_.backward_depth_, sum.level + 1);
      sums.push_back(std::move(sum));
    }
    lay_out(s_.backward_, sums,
            [&](const Sum& sum, std::uint32_t other) { return key(pivots_[sum.pivot].row, pivots_[other].column); });
  }

  template <class Key>
  void lay_out(SparseSolver::Sweep& sweep, std::vector<Sum>& sums, Key&& place) {
    const auto order = [](const Sum& sum) { return std::tuple(sum.level, sum.others.size(), sum.starts, sum.negates); };
    std::stable_sort(sums.begin(), sums.end(), [&](const Sum& a, const Sum& b) { return order(a) < order(b); });
    sweep.first_factor = next_factor_;
    for (const Sum& sum : sums) {
      const auto first = static_cast<std::uint32_t>(sweep.operand.size());
      sweep.sums.push_back({cell(sum.pivot), sum.pivot, first, first + static_cast<std::uint32_t>(sum.others.size()),
                            sum.starts, sum.negates});
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

  struct Work {
    FactorRun::Kind kind;
    std::uint32_t level;
    FactorSum sum;
    std::vector<FactorProduct> products;
    std::uint64_t place;
  };

  /// An entry of L or U is its entry of the matrix minus the products of all earlier pivots. What is known early is
  /// computed early, with much else of its kind.
  void build_factorization() {
    std::vector<Work> work;
    std::vector<std::uint32_t> pivot_level(pivots_.size(), 0);
    for (std::uint32_t p = 0; p < pivots_.size(); ++p) {
      const Pivot& pivot = pivots_[p];
      Work own = work_of(FactorRun::Pivot, pivot.row, pivot.column, p);
      pivot_level[p] = is_minus_one_[p] ? 0 : own.level + 1;
      if (is_minus_one_[p])
        s_.inverse_[p] = -1;
      else
        work.push_back(std::move(own));
      for (const std::uint32_t row : pivot.rows) add_factor(work, FactorRun::Lower, row, pivot.column, p, 0);
      for (const std::uint32_t column : pivot.columns)
        add_factor(work, FactorRun::Upper, pivot.row, column, p, pivot_level[p]);
      for (const std::uint32_t row : pivot.rows)
        for (const std::uint32_t column : pivot.columns)
          products_[key(row, column)].push_back({factor_at(key(row, pivot.column)), factor_at(key(pivot.row, column))});
    }
    find_literals(work);
    lay_out(work);
    s_.factors_.assign(next_factor_, 0.0);
  }

  void find_literals(const std::vector<Work>& work) {
    s_.literal_factor_.assign(next_factor_, std::numeric_limits<double>::quiet_NaN());
    for (const Work& w : work) {
      const bool plain = w.products.empty() && w.sum.entry < system_.entries.size();
      if (!plain || w.kind == FactorRun::Pivot || (w.kind == FactorRun::Upper && !is_minus_one_[w.sum.pivot])) continue;
      s_.literal_factor_[w.sum.target] =
          w.kind == FactorRun::Upper ? -system_.literal[w.sum.entry] : system_.literal[w.sum.entry];
    }
  }

  Work work_of(FactorRun::Kind kind, std::uint32_t row, std::uint32_t column, std::uint32_t pivot) {
    const auto entry = entry_at_.find(key(row, column));
    Work out{
        kind,
        0,
        {none, entry == entry_at_.end() ? static_cast<std::uint32_t>(system_.entries.size()) : entry->second, pivot},
        {},
        key(row, column)};
    if (const auto found = products_.find(key(row, column)); found != products_.end())
      out.products = std::move(found->second);
    const auto level = [&](const FactorProduct& p) { return std::max(factor_level_[p.lower], factor_level_[p.upper]); };
    for (const FactorProduct& product : out.products) out.level = std::max(out.level, level(product) + 1);
    std::stable_sort(out.products.begin(), out.products.end(),  // the newest last
                     [&](const FactorProduct& x, const FactorProduct& y) { return level(x) < level(y); });
    return out;
  }

  void add_factor(std::vector<Work>& work, FactorRun::Kind kind, std::uint32_t row, std::uint32_t column,
                  std::uint32_t pivot, std::uint32_t least_level) {
    work.push_back(work_of(kind, row, column, pivot));
    Work& w = work.back();
    w.level = std::max(w.level, least_level);
    w.sum.target = factor_at(key(row, column));
    if (factor_level_.size() <= w.sum.target) factor_level_.resize(w.sum.target + 1, 0);
    factor_level_[w.sum.target] = w.level;
  }

  void lay_out(std::vector<Work>& work) {
    const auto order = [](const Work& w) { return std::tuple(w.level, w.kind, w.products.size()); };
    std::stable_sort(work.begin(), work.end(), [&](const Work& x, const Work& y) { return order(x) < order(y); });
    for (std::uint32_t i = 0; i < work.size(); ++i) {
      if (i == 0 || order(work[i - 1]) != order(work[i]))
        s_.factor_runs_.push_back({work[i].kind, static_cast<std::uint32_t>(work[i].products.size()), i, i,
                                   static_cast<std::uint32_t>(s_.products_.size())});
      s_.factor_runs_.back().last = i + 1;
      s_.sums_.push_back(work[i].sum);
      s_.place_of_sum_.push_back(work[i].place);
      s_.products_.insert(s_.products_.end(), work[i].products.begin(), work[i].products.end());
    }
    s_.factor_products_ = s_.products_.size();
  }

  void note_parts() {
    s_.part_of_cell_.assign(*std::max_element(cells_.begin(), cells_.end()) + 1, 0);
    s_.part_of_factor_.assign(next_factor_, 0);
    for (std::uint32_t p = 0; p < pivots_.size(); ++p) {
      const std::uint32_t part = pivots_[p].part;
      s_.parts_ = std::max(s_.parts_, part);
      s_.part_of_pivot_.push_back(part);
      s_.column_of_pivot_.push_back(pivots_[p].column);
      s_.part_of_cell_[cell(p)] = part;
      for (const std::uint32_t row : pivots_[p].rows) s_.part_of_factor_[factor_at(key(row, pivots_[p].column))] = part;
      for (const std::uint32_t column : pivots_[p].columns)
        s_.part_of_factor_[factor_at(key(pivots_[p].row, column))] = part;
    }
  }

  const LiftedSystem& system_;
  const std::vector<Pivot>& pivots_;
  std::span<const std::uint32_t> cells_;
  SparseSolver& s_;
  std::vector<std::uint32_t> pivot_of_row_, pivot_of_column_;
  std::vector<bool> has_y_;         // [pivots]
  std::vector<bool> is_minus_one_;  // [pivots]
  std::unordered_map<std::uint64_t, std::uint32_t> entry_at_, factor_at_;
  std::unordered_map<std::uint64_t, std::vector<FactorProduct>> products_;  // of places that are still to be found
  std::vector<std::uint32_t> factor_level_;                                 // [factors]
  std::uint32_t next_factor_ = 0;
};

SparseSolver::SparseSolver(const LiftedSystem& system, const std::vector<Pivot>& pivots,
                           std::span<const std::uint32_t> cells) {
  SparseBuilder(system, pivots, cells, *this).run();
}

std::vector<std::uint32_t> SparseSolver::order_of_columns() const {
  std::vector<std::uint32_t> out(column_of_pivot_.size());
  for (std::uint32_t pivot = 0; pivot < out.size(); ++pivot) out[column_of_pivot_[pivot]] = pivot;
  return out;
}

double SparseSolver::factor(std::span<const double> entries) {
  std::copy(entries.begin(), entries.end(), entries_.begin());
  const FactorRun* const runs = factor_runs_.data();
  const double least = loops().factor({runs, runs + factor_runs_.size(), sums_.data(), products_.data(),
                                       entries_.data(), usual_size_.data(), factors_.data(), inverse_.data()});
  forward_loop_.set(factors_.data() + forward_.first_factor, inverse_.data());
  backward_loop_.set(factors_.data() + backward_.first_factor, nullptr);
  return least;
}

void SparseSolver::solve(const double* right, std::span<const std::uint32_t> places, double* x) const {
  const std::uint32_t* const cells = cell_of_residual_.data();
  const std::size_t n = cell_of_residual_.size();
  if (places.empty())
    for (std::size_t i = 0; i < n; ++i) x[cells[i]] = right[i];
  else
    for (std::size_t i = 0; i < n; ++i) x[cells[i]] = right[places[i]];
  loops().sweep(forward_loop_.tables(), x);
  loops().sweep(backward_loop_.tables(), x);
}

}  // namespace maupertuis::sparse
