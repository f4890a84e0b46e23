#include "kernel/dynamics/written_dynamics.hpp"

#include "kernel/sparse/written_elimination.hpp"
#include "kernel/sparse/written_entries.hpp"

namespace maupertuis::dynamics {
namespace {

using straight::Builder;
using straight::Term;
using straight::Value;

/// A pivot below this leaves the solution to the full matrix.
constexpr double least_share = 1e-3, least_full_share = 1e-6;
/// From this many coordinates on, columns of M₀ stand side by side in wide values.
constexpr std::size_t least_wide = 5;
/// Nodes. Of a full matrix more numbers are alive at a time.
constexpr std::size_t most_sorted = 2500, most_sorted_full = 400;

/// The entries of a lifted system from the values at order 0.
std::vector<Value> write_entries(Builder& to, Numbers& numbers, const sparse::LiftedSystem& system,
                                 const PointWriter& point) {
  const sparse::EntryWriter write(system,
                                  {.value = [&](Builder&, Slot slot) { return point.at(slot); },
                                   .constant = [&](Builder& b, ConstantId id) { return numbers.constant(b, id); },
                                   .choice = [&](Builder& b, std::uint32_t edge) { return numbers.choice(b, edge); }});
  std::vector<Value> out;
  for (std::uint32_t e = 0; e < system.entries.size(); ++e) out.push_back(write(to, e));
  return out;
}

// ----------------------------------------------------------------------------------------------------- the full matrix

/// The lower triangle of M₀ along the tangent graph, its columns one by one or side by side.
class MatrixWriter {
 public:
  MatrixWriter(Builder& to, const sparse::LiftedSystem& system, std::span<const Value> entries)
      : to_(to), system_(system), entries_(entries), n_(system.row_of_residual.size()), is_wide_(n_ >= least_wide) {}

  /// [n × n] below the diagonal and on it.
  std::vector<Value> run() {
    sort_entries();
    std::vector<Value> m(n_ * n_, straight::none);
    if (is_wide_) tangents_.resize(system_.size, straight::none);
    columns_.assign(is_wide_ ? 0 : system_.size, std::vector<Value>(n_, to_.literal(0)));
    for (std::uint32_t j = 0; j < n_; ++j) {
      if (is_wide_)
        tangents_[j] = to_.unit(j);
      else
        columns_[j][j] = to_.literal(1);
    }
    for (const std::uint32_t row : system_.rows_of_slots)
      if (column_[row] != straight::none) tangent(row);
    for (std::uint32_t i = 0; i < n_; ++i) {
      const std::uint32_t row = system_.row_of_residual[i];
      const Value all = is_wide_ ? to_.wide(wide_terms(row)) : straight::none;
      for (std::uint32_t j = 0; j <= i; ++j) m[i * n_ + j] = is_wide_ ? to_.lane(all, j) : to_.sum(terms(row, j));
    }
    return m;
  }

 private:
  void sort_entries() {
    of_row_.resize(system_.size);
    column_.assign(system_.size, straight::none);
    for (std::uint32_t e = 0; e < system_.entries.size(); ++e) of_row_[system_.entries[e].row].push_back(e);
    for (const std::uint32_t e : system_.minus_one) {
      column_[system_.entries[e].row] = system_.entries[e].column;
      std::erase(of_row_[system_.entries[e].row], e);
    }
  }

  void tangent(std::uint32_t row) {
    const std::uint32_t out = column_[row];
    if (is_wide_)
      tangents_[out] = to_.wide(wide_terms(row));
    else
      for (std::uint32_t j = 0; j < n_; ++j) columns_[out][j] = to_.sum(terms(row, j));
  }

  std::vector<Term> terms(std::uint32_t row, std::uint32_t j) const {
    std::vector<Term> out;
    for (const std::uint32_t e : of_row_[row]) out.push_back({1, entries_[e], columns_[system_.entries[e].column][j]});
    return out;
  }
  std::vector<Term> wide_terms(std::uint32_t row) const {
    std::vector<Term> out;
    for (const std::uint32_t e : of_row_[row])
      out.push_back({1, entries_[e], straight::none, tangents_[system_.entries[e].column]});
    return out;
  }

  Builder& to_;
  const sparse::LiftedSystem& system_;
  std::span<const Value> entries_;
  std::size_t n_;
  bool is_wide_;
  std::vector<std::vector<std::uint32_t>> of_row_;  // [rows] entries but that of its own slot
  std::vector<std::uint32_t> column_;               // [rows] of the slot that it gives
  std::vector<Value> tangents_;                     // [columns]
  std::vector<std::vector<Value>> columns_;         // [columns][n]
};

/// x of two equations by their determinant, so that one division is all that waits for it.
std::vector<Value> write_pair_solution(Builder& to, Value a, Value b, Value c, std::span<const Value> right) {
  const Value determinant = to.sum({{1, a, c}, {-1, b, b}});
  to.check({a, a, least_full_share});
  to.check({determinant, to.product(1, a, c), least_full_share});
  const Value inverse = to.reciprocal(determinant);
  return {to.sum({{1, c, right[0]}, {-1, b, right[1]}}, inverse),
          to.sum({{1, a, right[1]}, {-1, b, right[0]}}, inverse)};
}

/// x with L D Lᵀ x = b; m: [n × n], its lower triangle.
std::vector<Value> write_full_solution(Builder& to, std::vector<Value> m, std::span<const Value> b) {
  const std::size_t n = b.size();
  if (n == 2) return write_pair_solution(to, m[0], m[2], m[3], b);
  const auto at = [&](std::size_t i, std::size_t j) -> Value& { return m[i * n + j]; };  // above the diagonal: D Lᵀ
  std::vector<Value> y(b.begin(), b.end()), x(n), inverse(n);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<Term> pivot{{1, at(j, j)}};
    for (std::size_t k = 0; k < j; ++k) pivot.push_back({-1, at(j, k), at(k, j)});
    const Value d = to.sum(pivot);
    to.check({d, at(j, j), least_full_share});
    inverse[j] = to.reciprocal(d);
    for (std::size_t i = j + 1; i < n; ++i) {
      std::vector<Term> sum{{1, at(i, j)}};
      for (std::size_t k = 0; k < j; ++k) sum.push_back({-1, at(i, k), at(k, j)});
      at(j, i) = to.sum(std::move(sum));
      at(i, j) = to.product(1, at(j, i), inverse[j]);
    }
    for (std::size_t i = j + 1; i < n; ++i) y[i] = to.sum({{1, y[i]}, {-1, at(i, j), y[j]}});
  }
  for (std::size_t i = n; i-- > 0;) {
    std::vector<Term> sum{{1, y[i], inverse[i]}};
    for (std::size_t k = i + 1; k < n; ++k) sum.push_back({-1, at(k, i), x[k]});
    x[i] = to.sum(std::move(sum));
  }
  return x;
}

straight::StraightLine write_forces(const Program& program, Numbers& numbers) {
  Builder to;
  const PointWriter point(to, numbers, program, true);
  const Value anchor = to.next();
  for (std::uint32_t i = 0; i < program.freedoms; ++i) to.store(point.at(program.residual[i]), ResultArray, i);
  to.guard();
  return to.finish(arrays, 1, anchor);
}

straight::StraightLine write_accelerations(const Program& program, const WrittenPlan& plan, Numbers& numbers) {
  Builder to;
  const PointWriter point(to, numbers, program, false);
  const std::vector<Value> entries = write_entries(to, numbers, *plan.system, point);
  const Value anchor = to.next();
  // M₀ comes first, since more waits for it.
  const std::vector<Value> m = plan.pivots ? std::vector<Value>() : MatrixWriter(to, *plan.system, entries).run();
  std::vector<Value> b, x, usual;
  for (const Slot slot : program.residual) b.push_back(to.product(-1, point.at(slot)));
  if (plan.pivots) {
    for (std::uint32_t p = 0; p < plan.pivots->size(); ++p) usual.push_back(numbers.usual_size(to, p));
    x = sparse::write_solution(to, {*plan.system, *plan.pivots, entries, usual, least_share}, b);
  } else {
    x = write_full_solution(to, m, b);
  }
  for (std::uint32_t i = 0; i < b.size(); ++i) to.store(x[i], ResultArray, i), to.require_finite(x[i]);
  to.guard();
  std::uint32_t wide = 1;
  while (wide < b.size() && wide < 8) wide *= 2;
  return to.finish(arrays, wide, anchor, plan.pivots ? most_sorted : most_sorted_full);
}

}  // namespace

WrittenDynamics write_dynamics(const Program& program, const WrittenPlan& plan) {
  WrittenDynamics out;
  Numbers numbers(program, out.numbers);
  out.lines.push_back(write_forces(program, numbers));
  if (plan.system) out.lines.push_back(write_accelerations(program, plan, numbers));
  return out;
}

}  // namespace maupertuis::dynamics
