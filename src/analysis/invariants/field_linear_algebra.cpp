#include "analysis/invariants/field_linear_algebra.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis::invariants {
namespace {

using evaluation::Wide;

constexpr std::size_t none = ~std::size_t{0};

/// Takes rows one after the other and keeps those that are new, with unit pivots.
class Elimination {
 public:
  Elimination(FieldMatrix& m, const PrimeField& field)
      : m_(m), field_(field), row_of_(m.columns, none), rest_(m.columns) {}

  std::size_t rank() const { return rank_; }

  /// Subtracts the rows before it; what is left, if anything, takes the place after them.
  void take(std::size_t row) {
    for (std::size_t k = 0; k < m_.columns; ++k) rest_[k] = field_.unreduced(m_.at(row, k));
    forget_waiting();
    for (std::size_t column = 0; column < m_.columns; ++column) {
      const Value value = field_.reduced(with_waiting(column));
      if (value == 0) continue;
      if (row_of_[column] == none) return keep(column, field_.inverse(value));
      waiting_[waiting_count_++] = {field_.negate(value), &m_.at(row_of_[column], 0)};
      if (waiting_count_ == waiting_.size()) add_waiting(column + 1);
    }
  }

  /// Puts the rows in the order of their pivots, those that are left over last, as zeros; the columns of the pivots.
  std::vector<std::size_t> finish() {
    std::vector<std::size_t> pivots;
    FieldMatrix sorted(m_.rows, m_.columns);
    for (std::size_t column = 0; column < m_.columns; ++column) {
      if (row_of_[column] == none) continue;
      const Value* row = &m_.at(row_of_[column], 0);
      std::copy(row, row + m_.columns, &sorted.at(pivots.size(), 0));
      pivots.push_back(column);
    }
    m_ = std::move(sorted);
    return pivots;
  }

 private:
  struct Multiple {
    Value factor;
    const Value* row;
  };

  /// An entry of the row that is taken, with the multiples of four rows at once.
  Wide with_waiting(std::size_t k) const {
    const auto product = [&](const Multiple& m) { return static_cast<Wide>(m.factor) * m.row[k]; };
    return field_.lessened(rest_[k] + product(waiting_[0]) + product(waiting_[1]) + product(waiting_[2]) +
                           product(waiting_[3]));
  }
  void add_waiting(std::size_t from) {
    for (std::size_t k = from; k < m_.columns; ++k) rest_[k] = with_waiting(k);
    forget_waiting();
  }
  void forget_waiting() {
    waiting_.fill({0, &m_.at(0, 0)});
    waiting_count_ = 0;
  }

  void keep(std::size_t column, Value scale) {
    add_waiting(column);
    for (std::size_t k = 0; k < m_.columns; ++k)
      m_.at(rank_, k) = k < column ? 0 : field_.multiply(field_.reduced(rest_[k]), scale);
    row_of_[column] = rank_++;
  }

  FieldMatrix& m_;
  const PrimeField& field_;
  std::vector<std::size_t> row_of_;  // [columns] the row whose pivot stands there
  std::vector<Wide> rest_;           // [columns] of the row that is taken
  std::array<Multiple, 4> waiting_;  // not added to the rest yet
  std::size_t waiting_count_ = 0, rank_ = 0;
};

}  // namespace

std::vector<std::size_t> echelon(FieldMatrix& m, const PrimeField& field, const Interrupt& interrupt) {
  Elimination elimination(m, field);
  for (std::size_t row = 0; row < m.rows && elimination.rank() < m.columns; ++row) {
    interrupt.throw_if_asked();
    elimination.take(row);
  }
  return elimination.finish();
}

std::vector<NullVector> null_vectors(FieldMatrix m, const PrimeField& field, const Interrupt& interrupt) {
  const std::vector<std::size_t> pivots = echelon(m, field, interrupt);
  std::vector<NullVector> out;
  for (std::size_t column = 0, next = 0; column < m.columns; ++column) {
    if (next < pivots.size() && pivots[next] == column) {
      ++next;
      continue;
    }
    interrupt.throw_if_asked();
    // Back substitution over the pivots before this column.
    std::vector<Value> x(m.columns, 0);
    x[column] = field.one();
    for (std::size_t i = next; i-- > 0;) {
      Value sum = m.at(i, column);
      for (std::size_t k = i + 1; k < next; ++k) sum = field.add(sum, field.multiply(m.at(i, pivots[k]), x[pivots[k]]));
      x[pivots[i]] = field.negate(sum);
    }
    NullVector vector;
    for (std::size_t k = 0; k <= column; ++k)
      if (x[k] != 0) {
        vector.columns.push_back(k);
        vector.entries.push_back(x[k]);
      }
    out.push_back(std::move(vector));
  }
  return out;
}

std::optional<std::vector<Value>> solve(FieldMatrix m, const PrimeField& field, std::size_t determined) {
  const std::vector<std::size_t> pivots = echelon(m, field);
  if (pivots.size() < determined || (determined > 0 && pivots[determined - 1] >= determined)) return std::nullopt;
  if (!pivots.empty() && pivots.back() + 1 == m.columns) return std::nullopt;
  std::vector<Value> x(m.columns - 1, 0);
  for (std::size_t i = pivots.size(); i-- > 0;) {
    Value sum = m.at(i, m.columns - 1);
    for (std::size_t k = i + 1; k < pivots.size(); ++k)
      sum = field.subtract(sum, field.multiply(m.at(i, pivots[k]), x[pivots[k]]));
    x[pivots[i]] = sum;
  }
  return x;
}

std::optional<Rational> rational_of(Value value, const PrimeField& field) {
  constexpr std::int64_t likely = std::int64_t{1} << 44;  // a random residue has so small a fraction once in 2^16
  const auto p = static_cast<std::int64_t>(field.prime());
  const auto bound = static_cast<std::int64_t>(std::sqrt(static_cast<double>(p) / 2));
  std::int64_t r0 = p, r1 = static_cast<std::int64_t>(field.residue(value)), t0 = 0, t1 = 1;
  for (;;) {
    if (r1 <= bound && std::abs(t1) <= bound && std::abs(t1) <= likely / std::max<std::int64_t>(1, r1))
      return Rational(r1, t1);
    if (r1 == 0 || std::abs(t1) > bound) return std::nullopt;
    const std::int64_t quotient = r0 / r1;
    r0 -= quotient * r1;
    t0 -= quotient * t1;
    std::swap(r0, r1);
    std::swap(t0, t1);
  }
}

}  // namespace maupertuis::invariants
