#include "kernel/sparse/written_elimination.hpp"

#include <unordered_map>

namespace maupertuis::sparse {
namespace {

using straight::Builder;
using straight::Term;
using straight::Value;

class Writer {
 public:
  Writer(Builder& to, const WrittenSystem& written)
      : to_(to), w_(written), side_(written.system.size), y_(written.pivots.size()), upper_(written.pivots.size()) {}

  std::vector<Value> run(std::span<const Value> b) {
    for (std::size_t e = 0; e < w_.entries.size(); ++e)
      matrix_[key(w_.system.entries[e].row, w_.system.entries[e].column)].push_back({1, w_.entries[e]});
    for (std::size_t i = 0; i < b.size(); ++i) side_[w_.system.row_of_residual[i]].push_back({1, b[i]});
    for (std::size_t p = 0; p < w_.pivots.size(); ++p) eliminate(p);
    return substitute();
  }

 private:
  static std::uint64_t key(std::uint32_t row, std::uint32_t column) { return (std::uint64_t{row} << 32) | column; }

  std::vector<Term> take(std::uint32_t row, std::uint32_t column) {
    const auto found = matrix_.find(key(row, column));
    if (found == matrix_.end()) return {};
    std::vector<Term> out = std::move(found->second);
    matrix_.erase(found);
    return out;
  }

  Value checked(std::size_t p, const std::vector<Term>& terms) {
    const Value pivot = to_.sum(terms);
    if (!to_.is_literal(pivot))
      to_.check({to_.magnitudes({{1, pivot}}), to_.larger(to_.magnitudes(terms), w_.usual_size[p]), w_.least_share});
    return pivot;
  }

  /// The rest of the matrix and of the right side loses what pivot p takes.
  void eliminate(std::size_t p) {
    const Pivot& pivot = w_.pivots[p];
    const Value inverse = to_.reciprocal(checked(p, take(pivot.row, pivot.column)));
    for (const std::uint32_t column : pivot.columns)
      upper_[p].emplace_back(column, to_.sum(take(pivot.row, column), inverse));
    y_[p] = to_.sum(side_[pivot.row], inverse);
    for (const std::uint32_t row : pivot.rows) {
      const Value lower = to_.sum(take(row, pivot.column));
      if (to_.is_zero(lower)) continue;
      for (const auto& [column, upper] : upper_[p])
        if (!to_.is_zero(upper)) matrix_[key(row, column)].push_back({-1, lower, upper});
      if (!to_.is_zero(y_[p])) side_[row].push_back({-1, lower, y_[p]});
    }
  }

  std::vector<Value> substitute() {
    std::vector<Value> x(w_.pivots.size(), straight::none);
    for (std::size_t p = w_.pivots.size(); p-- > 0;) {
      std::vector<Term> terms{{1, y_[p]}};
      for (const auto& [column, upper] : upper_[p]) terms.push_back({-1, upper, x[column]});
      x[w_.pivots[p].column] = to_.sum(std::move(terms));
    }
    return x;
  }

  Builder& to_;
  const WrittenSystem& w_;
  std::unordered_map<std::uint64_t, std::vector<Term>> matrix_;      // places that are still to be found
  std::vector<std::vector<Term>> side_;                              // [rows] b
  std::vector<Value> y_;                                             // [pivots]
  std::vector<std::vector<std::pair<std::uint32_t, Value>>> upper_;  // [pivots] of its row, divided by it
};

}  // namespace

std::vector<Value> write_solution(Builder& to, const WrittenSystem& written, std::span<const Value> b) {
  return Writer(to, written).run(b);
}

}  // namespace maupertuis::sparse
