#include "analysis/invariants/field_linear_algebra.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::invariants {
namespace {

void scale_row(FieldMatrix& m, std::size_t row, std::size_t from, Value factor, const PrimeField& field) {
  for (std::size_t k = from; k < m.columns; ++k) m.at(row, k) = field.multiply(m.at(row, k), factor);
}

/// row −= factor · pivot row, from a column on.
void subtract_row(FieldMatrix& m, std::size_t row, std::size_t pivot, std::size_t from, const PrimeField& field) {
  const Value factor = m.at(row, from);
  if (factor == 0) return;
  Value* target = &m.at(row, from);
  const Value* source = &m.at(pivot, from);
  for (std::size_t k = 0; k < m.columns - from; ++k)
    if (source[k] != 0) target[k] = field.subtract(target[k], field.multiply(factor, source[k]));
}

}  // namespace

std::vector<std::size_t> echelon(FieldMatrix& m, const PrimeField& field, const Interrupt& interrupt) {
  std::vector<std::size_t> pivots;
  for (std::size_t column = 0; column < m.columns && pivots.size() < m.rows; ++column) {
    interrupt.throw_if_asked();
    const std::size_t top = pivots.size();
    std::size_t row = top;
    while (row < m.rows && m.at(row, column) == 0) ++row;
    if (row == m.rows) continue;
    if (row != top) std::swap_ranges(&m.at(row, 0), &m.at(row, 0) + m.columns, &m.at(top, 0));
    scale_row(m, top, column, field.inverse(m.at(top, column)), field);
    for (std::size_t below = top + 1; below < m.rows; ++below) subtract_row(m, below, top, column, field);
    pivots.push_back(column);
  }
  return pivots;
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

std::optional<std::vector<Value>> solve(FieldMatrix m, const PrimeField& field) {
  const std::vector<std::size_t> pivots = echelon(m, field);
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
