#include "symbolic/evaluate/precise_matrix.hpp"

#include <algorithm>

namespace maupertuis::evaluation {
namespace {

const Real100 deflated("1e-98");

Complex100 square_root(const Complex100& z) {
  const Real100 size = size_of(z);
  const Real100 x = sqrt(Real100((size + abs(z.real())) / 2));
  if (x == 0) return {0, 0};
  const Real100 y = z.imag() / (2 * x);
  return z.real() >= 0 ? Complex100(x, y) : Complex100(abs(y), z.imag() < 0 ? -x : x);
}

/// Similar to `a`, zero below the first subdiagonal, by elimination with pivots.
void to_hessenberg(PreciseMatrix& a) {
  const std::size_t n = a.rows;
  for (std::size_t m = 1; m + 1 < n; ++m) {
    std::size_t pivot = m;
    for (std::size_t i = m; i < n; ++i)
      if (size_of(a.at(i, m - 1)) > size_of(a.at(pivot, m - 1))) pivot = i;
    if (size_of(a.at(pivot, m - 1)) == 0) continue;
    for (std::size_t j = 0; j < n; ++j) std::swap(a.at(pivot, j), a.at(m, j));
    for (std::size_t i = 0; i < n; ++i) std::swap(a.at(i, pivot), a.at(i, m));
    for (std::size_t i = m + 1; i < n; ++i) {
      const Complex100 part = a.at(i, m - 1) / a.at(m, m - 1);
      for (std::size_t j = 0; j < n; ++j) a.at(i, j) -= part * a.at(m, j);
      for (std::size_t k = 0; k < n; ++k) a.at(k, m) += part * a.at(k, i);
    }
  }
}

/// The eigenvalue of the last block of two that is nearer to the last entry (Wilkinson).
Complex100 shift_of(const PreciseMatrix& a, std::size_t high) {
  const Complex100 p = a.at(high - 1, high - 1), s = a.at(high, high);
  const Complex100 half = (p - s) / Complex100(2), product = a.at(high - 1, high) * a.at(high, high - 1);
  const Complex100 root = square_root(half * half + product);
  const Complex100 sum = half + root, difference = half - root;
  const Complex100& larger = size_of(sum) > size_of(difference) ? sum : difference;
  return size_of(larger) == 0 ? s : s - product / larger;
}

/// One turn A − σ = Q R, A ← R Q + σ of the block from `low` to `high`.
void turn(PreciseMatrix& a, std::size_t low, std::size_t high, const Complex100& shift) {
  for (std::size_t i = low; i <= high; ++i) a.at(i, i) -= shift;
  std::vector<std::pair<Complex100, Complex100>> rotations;
  for (std::size_t k = low; k < high; ++k) {
    const Complex100 x = a.at(k, k), y = a.at(k + 1, k);
    const Real100 length = sqrt(Real100(std::norm(x) + std::norm(y)));
    const Complex100 by = length > 0 ? length : Real100(1), c = length > 0 ? x / by : Complex100(1), s = y / by;
    rotations.emplace_back(c, s);
    for (std::size_t j = k; j <= high; ++j) {
      const Complex100 u = a.at(k, j), v = a.at(k + 1, j);
      a.at(k, j) = std::conj(c) * u + std::conj(s) * v;
      a.at(k + 1, j) = c * v - s * u;
    }
  }
  for (std::size_t k = low; k < high; ++k) {
    const auto& [c, s] = rotations[k - low];
    for (std::size_t i = low; i <= std::min(k + 1, high); ++i) {
      const Complex100 u = a.at(i, k), v = a.at(i, k + 1);
      a.at(i, k) = u * c + v * s;
      a.at(i, k + 1) = v * std::conj(c) - u * std::conj(s);
    }
  }
  for (std::size_t i = low; i <= high; ++i) a.at(i, i) += shift;
}

}  // namespace

Reduction::Reduction(PreciseMatrix matrix, std::size_t unknowns)
    : Reduction(matrix, unknowns, matrix, Real100("1e-40")) {}

Reduction::Reduction(PreciseMatrix matrix, std::size_t unknowns, PreciseMatrix sizes, const Real100& least)
    : a_(std::move(matrix)), unknowns_(unknowns), column_sizes_(unknowns, Real100(1)) {
  equilibrate(std::move(sizes));
  std::vector<bool> taken_rows(a_.rows), taken(unknowns_);
  while (pivots_.size() < std::min(a_.rows, unknowns_)) {
    Real100 largest = least;
    std::optional<std::pair<std::size_t, std::size_t>> next;
    for (std::size_t i = 0; i < a_.rows; ++i)
      for (std::size_t j = 0; !taken_rows[i] && j < unknowns_; ++j)
        if (!taken[j] && size_of(a_.at(i, j)) > largest) largest = size_of(a_.at(i, j)), next = std::pair(i, j);
    if (!next) break;
    taken_rows[next->first] = taken[next->second] = true;
    pivots_.push_back(*next);
    eliminate(next->first, next->second);
  }
}

void Reduction::equilibrate(PreciseMatrix sizes) {
  for (std::size_t j = 0; j < unknowns_; ++j) {
    Real100 size = 0;
    for (std::size_t i = 0; i < a_.rows; ++i) size = std::max(size, size_of(sizes.at(i, j)));
    if (!(size > 0)) continue;
    column_sizes_[j] = size;
    for (std::size_t i = 0; i < a_.rows; ++i) a_.at(i, j) /= Complex100(size), sizes.at(i, j) /= Complex100(size);
  }
  for (std::size_t i = 0; i < a_.rows; ++i) {
    Real100 size = 0;
    for (std::size_t j = 0; j < unknowns_; ++j) size = std::max(size, size_of(sizes.at(i, j)));
    for (std::size_t j = 0; size > 0 && j < a_.columns; ++j) a_.at(i, j) /= Complex100(size);
  }
}

void Reduction::eliminate(std::size_t row, std::size_t column) {
  for (std::size_t i = 0; i < a_.rows; ++i) {
    if (i == row || size_of(a_.at(i, column)) == 0) continue;
    const Complex100 part = a_.at(i, column) / a_.at(row, column);
    for (std::size_t j = 0; j < a_.columns; ++j) a_.at(i, j) -= part * a_.at(row, j);
    a_.at(i, column) = 0;
  }
}

std::vector<Complex100> Reduction::solution(std::size_t k) const {
  std::vector<Complex100> x(unknowns_);
  for (const auto& [row, column] : pivots_)
    x[column] = a_.at(row, unknowns_ + k) / (a_.at(row, column) * Complex100(column_sizes_[column]));
  return x;
}

std::vector<std::vector<Complex100>> Reduction::kernel() const {
  std::vector<std::vector<Complex100>> out;
  for (std::size_t free = 0; free < unknowns_; ++free) {
    if (std::any_of(pivots_.begin(), pivots_.end(), [&](const auto& p) { return p.second == free; })) continue;
    std::vector<Complex100> x(unknowns_);
    x[free] = Complex100(1 / column_sizes_[free]);
    for (const auto& [row, column] : pivots_)
      x[column] = -a_.at(row, free) / (a_.at(row, column) * Complex100(column_sizes_[column]));
    out.push_back(std::move(x));
  }
  return out;
}

std::optional<std::vector<Complex100>> eigenvalues(PreciseMatrix a) {
  constexpr int most_turns = 100, stuck = 10;
  to_hessenberg(a);
  std::vector<Complex100> out;
  Real100 norm = 0;
  for (const Complex100& x : a.entries) norm = std::max(norm, size_of(x));
  int turns = 0;
  for (std::size_t left = a.rows; left > 0;) {
    const std::size_t high = left - 1;
    std::size_t low = high;
    for (; low > 0; --low) {
      // Of the whole matrix: below its rounding nothing beside small entries becomes smaller.
      if (size_of(a.at(low, low - 1)) <= deflated * norm) break;
    }
    if (low == high) {
      out.push_back(a.at(high, high));
      left = high;
      turns = 0;
      continue;
    }
    if (++turns > most_turns) return std::nullopt;
    const bool is_stuck = turns % stuck == 0;
    turn(a, low, high, is_stuck ? a.at(high, high) + Complex100(size_of(a.at(high, high - 1))) : shift_of(a, high));
  }
  return out;
}

}  // namespace maupertuis::evaluation
