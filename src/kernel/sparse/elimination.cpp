#include "kernel/sparse/elimination.hpp"
#include "kernel/sparse/parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace maupertuis::sparse {
namespace {

constexpr std::size_t most_states = 16;
using Values = std::array<double, most_states>;

struct Cell {
  std::uint32_t column;
  Values values;
};

class Elimination {
 public:
  Elimination(const LiftedSystem& system, const std::vector<std::vector<double>>& samples,
              const EliminationOptions& options)
      : options_(options),
        own_column_(system.own_column),
        rows_(system.size),
        columns_(system.size),
        row_scale_(system.size, 1.0),
        column_scale_(system.size, 1.0),
        group_of_column_(nearest_coordinates(system)),
        group_of_row_(system.size),
        members_(system.row_of_residual.size()),
        border_(members_.size()),
        stale_(members_.size(), true) {
    for (std::uint32_t e = 0; e < system.entries.size(); ++e) {
      Cell cell{system.entries[e].column, {}};
      for (std::size_t s = 0; s < most_states; ++s) cell.values[s] = samples[s % samples.size()][e];
      rows_[system.entries[e].row].push_back(cell);
      columns_[system.entries[e].column].push_back(system.entries[e].row);
    }
    for (std::size_t s = 0; s < most_states; ++s) in_use_[s] = s < samples.size();
    equilibrate();
    for (std::uint32_t row = 0; row < system.size; ++row) {
      group_of_row_[row] = group_of_column_[own_column_[row]];
      members_[group_of_row_[row]].push_back(row);
    }
  }

  std::optional<std::vector<Pivot>> run(const std::vector<std::vector<std::uint32_t>>& parts) {
    eliminate_parts(parts);
    for (std::uint32_t group = 0; group < members_.size(); ++group)
      if (!members_[group].empty()) open_.push_back(group);
    while (!open_.empty()) {
      const std::size_t before = pivots_.size();
      bool merged = false;
      for (const std::uint32_t group : choose_round()) merged |= eliminate_group(group);
      std::erase_if(open_, [&](std::uint32_t group) { return members_[group].empty(); });
      round_ = next_round_;
      if (pivots_.size() == before && !merged && !drop_worst_state()) return std::nullopt;
    }
    std::stable_sort(pivots_.begin(), pivots_.end(), [](const Pivot& x, const Pivot& y) { return x.round < y.round; });
    return std::move(pivots_);
  }

 private:
  // --------------------------------------------------------------------------------------------------------- values

  static double size(const Values& values) {
    double largest = 0;
    for (const double x : values) largest = std::max(largest, std::abs(x));
    return largest;
  }

  /// Rows and columns to a largest entry near 1, so that units do not decide what is small.
  void equilibrate() {
    const std::size_t n = rows_.size();
    for (int sweep = 0; sweep < 4; ++sweep) {
      std::vector<double> row(n, 0.0), column(n, 0.0);
      for (std::size_t i = 0; i < n; ++i)
        for (const Cell& cell : rows_[i]) {
          row[i] = std::max(row[i], size(cell.values));
          column[cell.column] = std::max(column[cell.column], size(cell.values));
        }
      const auto step = [](double x) { return x > 0 && std::isfinite(x) ? 1 / std::sqrt(x) : 1.0; };
      for (std::size_t i = 0; i < n; ++i)
        for (Cell& cell : rows_[i])
          for (double& x : cell.values) x *= step(row[i]) * step(column[cell.column]);
      for (std::size_t i = 0; i < n; ++i) row_scale_[i] *= step(row[i]), column_scale_[i] *= step(column[i]);
    }
  }

  Cell* find(std::uint32_t row, std::uint32_t column) {
    for (Cell& c : rows_[row])
      if (c.column == column) return &c;
    return nullptr;
  }

  Values largest_in_column(std::uint32_t column) {
    Values largest{};
    for (const std::uint32_t row : columns_[column]) {
      const Cell& c = *find(row, column);
      for (std::size_t s = 0; s < most_states; ++s) largest[s] = std::max(largest[s], std::abs(c.values[s]));
    }
    return largest;
  }

  /// The size of an entry against the largest of its column, at the sampled state where that is least.
  double share(const Cell& cell) {
    const Values largest = largest_in_column(cell.column);
    double least = 1;
    for (std::size_t s = 0; s < most_states; ++s)
      if (in_use_[s]) least = std::min(least, std::abs(cell.values[s]) / std::max(largest[s], 1e-12));
    return least;
  }

  /// M₀ may be singular at a sampled state, where no pivot is large then: the state with the smallest best pivot is
  /// left out from now on. The first state is that of the motion itself and stays. False: there is no other.
  bool drop_worst_state() {
    Values best{};
    for (const std::uint32_t group : open_)
      for (const std::uint32_t row : members_[group])
        for (const Cell& cell : rows_[row]) {
          const Values largest = largest_in_column(cell.column);
          for (std::size_t s = 0; s < most_states; ++s)
            best[s] = std::max(best[s], std::abs(cell.values[s]) / std::max(largest[s], 1e-12));
        }
    std::size_t worst = 0;
    for (std::size_t s = 1; s < most_states; ++s)
      if (in_use_[s] && (worst == 0 || best[s] <= best[worst])) worst = s;
    in_use_[worst] = false;
    return worst != 0;
  }

  // --------------------------------------------------------------------------------------------------------- groups

  struct Border {
    std::set<std::uint32_t> rows, columns;  // outside of the group
    double cost() const { return static_cast<double>(rows.size() * columns.size()); }
  };

  Border border(std::uint32_t group) const {
    Border out;
    for (const std::uint32_t row : members_[group])
      for (const Cell& cell : rows_[row])
        if (group_of_column_[cell.column] != group) out.columns.insert(cell.column);
    for (const std::uint32_t row : members_[group])
      for (const std::uint32_t other : columns_[partner(row)])
        if (group_of_row_[other] != group) out.rows.insert(other);
    return out;
  }

  /// The column that stands for a row in its group. Each row owns one, so that a group has as many columns as rows,
  /// though a row need not be eliminated with its own.
  std::uint32_t partner(std::uint32_t row) const { return own_column_[row]; }

  /// Those groups of the least cost that share no row or column with each other's borders: they can be eliminated in
  /// any order.
  std::vector<std::uint32_t> choose_round() {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t group : open_) {
      if (stale_[group]) border_[group] = border(group), stale_[group] = false;
      least = std::min(least, border_[group].cost());
    }
    std::set<std::uint32_t> touched;
    std::vector<std::uint32_t> out;
    for (const std::uint32_t group : open_) {
      if (border_[group].cost() > least || !touched.insert(group).second) continue;
      out.push_back(group);
      for (const std::uint32_t column : border_[group].columns) touched.insert(group_of_column_[column]);
      for (const std::uint32_t row : border_[group].rows) touched.insert(group_of_row_[row]);
    }
    for (const std::uint32_t group : touched) stale_[group] = true;
    return out;
  }

  void eliminate_parts(const std::vector<std::vector<std::uint32_t>>& parts) {
    for (std::size_t turn = 0; !parts.empty() && turn < parts[0].size(); ++turn, round_ = next_round_)
      for (part_ = 0; part_ < parts.size();) {
        const std::uint32_t group = parts[part_][turn];
        ++part_;
        eliminate_group(group);
      }
    between_parts_ = !parts.empty();
    part_ = 0;
  }

  /// Eliminates all of a group that has an acceptable pivot. The rest, such as a multiplier whose coordinates are still
  /// there, joins a neighbouring group. True: something did.
  bool eliminate_group(std::uint32_t group) {
    std::uint32_t round = round_;
    while (const auto place = best_pivot(group)) eliminate(place->first, place->second, round++);
    next_round_ = std::max(next_round_, round);
    std::vector<std::uint32_t>& left = members_[group];
    if (left.empty()) return false;
    const Border b = border(group);
    if (b.columns.empty() && b.rows.empty()) return false;
    const std::uint32_t to = b.columns.empty() ? group_of_row_[*b.rows.begin()] : group_of_column_[*b.columns.begin()];
    for (const std::uint32_t row : left) {
      group_of_row_[row] = group_of_column_[partner(row)] = to;
      members_[to].push_back(row);
    }
    left.clear();
    for (const std::uint32_t column : b.columns) stale_[group_of_column_[column]] = true;
    for (const std::uint32_t row : b.rows) stale_[group_of_row_[row]] = true;
    return true;
  }

  using Place = std::pair<std::uint32_t, std::uint32_t>;

  /// The acceptable pivot of the group that fills in least; a row's own column is preferred to all others.
  std::optional<Place> best_pivot(std::uint32_t group) {
    if (between_parts_) return most_certain_pivot(group);
    for (const bool own : {true, false}) {
      std::optional<Place> best;
      std::size_t least = std::numeric_limits<std::size_t>::max();
      for (const std::uint32_t row : members_[group])
        for (const Cell& cell : rows_[row]) {
          if (own ? cell.column != own_column_[row] : group_of_column_[cell.column] != group) continue;
          const std::size_t cost = (rows_[row].size() - 1) * (columns_[cell.column].size() - 1);
          if (cost >= least || !(share(cell) >= (own ? options_.least_own_share : options_.least_share))) continue;
          least = cost;
          best = {row, cell.column};
        }
      if (best) return best;
    }
    return std::nullopt;
  }

  bool keeps_sign(const Cell& cell) const {
    for (std::size_t s = 0; s < most_states; ++s)
      if (in_use_[s] && !(cell.values[s] * cell.values[0] > 0)) return false;
    return true;
  }

  std::optional<Place> most_certain_pivot(std::uint32_t group) {
    std::optional<Place> best;
    double most = options_.least_own_share;
    for (const std::uint32_t row : members_[group])
      for (const Cell& cell : rows_[row]) {
        if (group_of_column_[cell.column] != group || !keeps_sign(cell)) continue;
        if (const double here = share(cell); here > most) most = here, best = {row, cell.column};
      }
    return best;
  }

  // ---------------------------------------------------------------------------------------------------- elimination

  Cell& cell(std::uint32_t row, std::uint32_t column) {
    if (Cell* c = find(row, column)) return *c;
    rows_[row].push_back({column, {}});
    columns_[column].push_back(row);
    return rows_[row].back();
  }

  void eliminate(std::uint32_t row, std::uint32_t column, std::uint32_t round) {
    Pivot pivot{row, column, round, part_, 0, {}, {}};
    take_from_group(row, column);
    const std::vector<Cell> cells = std::move(rows_[row]);
    rows_[row].clear();
    Values inverse{};
    for (const Cell& c : cells) {
      std::erase(columns_[c.column], row);
      if (c.column != column) {
        pivot.columns.push_back(c.column);
        continue;
      }
      for (std::size_t s = 0; s < most_states; ++s) inverse[s] = 1 / c.values[s];
      pivot.size = size(c.values) / (row_scale_[row] * column_scale_[column]);
    }
    pivot.rows = std::move(columns_[column]);
    columns_[column].clear();
    for (const std::uint32_t below : pivot.rows) subtract(below, column, cells, inverse);
    pivots_.push_back(std::move(pivot));
  }

  /// The row is eliminated and leaves its group. Each row has one column of its own in its group; if the pivot stands
  /// in the column of another row, the two rows exchange their columns first. So each group loses one row and one
  /// column with each elimination, and keeps as many columns as rows.
  void take_from_group(std::uint32_t row, std::uint32_t column) {
    std::erase(members_[group_of_row_[row]], row);
    if (own_column_[row] == column) return;
    for (std::uint32_t& other : own_column_)
      if (other == column) {
        other = own_column_[row];
        break;
      }
    own_column_[row] = column;
  }

  void subtract(std::uint32_t below, std::uint32_t column, const std::vector<Cell>& cells, const Values& inverse) {
    Values factor = cell(below, column).values;
    for (std::size_t s = 0; s < most_states; ++s) factor[s] *= inverse[s];
    std::erase_if(rows_[below], [&](const Cell& c) { return c.column == column; });
    for (const Cell& c : cells) {
      if (c.column == column) continue;
      Cell& target = cell(below, c.column);
      for (std::size_t s = 0; s < most_states; ++s) target.values[s] -= factor[s] * c.values[s];
    }
  }

  EliminationOptions options_;
  std::vector<std::uint32_t> own_column_;  // [rows]
  std::vector<std::vector<Cell>> rows_;
  std::vector<std::vector<std::uint32_t>> columns_;  // the rows that have an entry there
  std::vector<double> row_scale_, column_scale_;
  std::vector<std::uint32_t> group_of_column_, group_of_row_;
  std::vector<std::vector<std::uint32_t>> members_;  // [groups] rows
  std::vector<Border> border_;                       // [groups]
  std::vector<bool> stale_;                          // [groups] whose border is to be found anew
  std::array<bool, most_states> in_use_;             // states by which pivots are judged
  std::vector<std::uint32_t> open_;                  // groups
  std::uint32_t round_ = 0, next_round_ = 0;
  std::uint32_t part_ = 0;  // that is being eliminated; see Pivot
  bool between_parts_ = false;
  std::vector<Pivot> pivots_;
};

}  // namespace

std::optional<std::vector<Pivot>> eliminate(const LiftedSystem& system, const std::vector<std::vector<double>>& samples,
                                            const EliminationOptions& options,
                                            const std::vector<std::vector<std::uint32_t>>& parts) {
  if (samples.empty() || samples.size() > most_states) return std::nullopt;
  return Elimination(system, samples, options).run(parts);
}

}  // namespace maupertuis::sparse
