#pragma once
#include "kernel/extended/number.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace maupertuis::extended {

/// B x = b for many right-hand sides by one elimination with full pivoting, which reveals the rank; the matrix is
/// equilibrated first, by powers of two and so exactly. Where B is singular, the unknowns that it does not determine
/// are 0 and the rows that depend on others are left out. Cost n³/3, n² a right-hand side.
template <class T>
class LinearSolver {
 public:
  /// Row by row [n × n]. Entries below `least` times the largest pivot are taken to be rounding.
  void factor(std::span<const T> matrix, std::size_t size, const T& least);
  void solve(std::span<T> b) const;
  std::size_t rank() const { return rank_; }
  /// Directions that B does not see, one for each missing rank, in the unknowns as given. [n] each
  std::vector<std::vector<T>> null_vectors() const;
  /// The smallest pivot in use against the largest.
  double pivot_ratio() const { return ratio_; }

 private:
  T& at(std::size_t i, std::size_t j) { return m_[i * n_ + j]; }
  const T& at(std::size_t i, std::size_t j) const { return m_[i * n_ + j]; }
  void equilibrate();
  bool bring_up_pivot(std::size_t step, const T& smallest, T& largest);
  void swap_columns(std::size_t a, std::size_t b);

  std::size_t n_ = 0, rank_ = 0;
  std::vector<T> m_;                       // [n × n] L below the diagonal, U above
  std::vector<int> scale_;                 // [n] exponents of two
  std::vector<std::size_t> row_, column_;  // [n] what stands where
  double ratio_ = 1;
};

/// Ruiz (2001), symmetric: the largest entry of each row and column becomes about 1.
template <class T>
void LinearSolver<T>::equilibrate() {
  scale_.assign(n_, 0);
  for (int sweep = 0; sweep < 3; ++sweep) {
    std::vector<T> largest(n_, T(0));
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) {
        const T size = abs(at(i, j));
        largest[i] = std::max(largest[i], size), largest[j] = std::max(largest[j], size);
      }
    std::vector<int> step(n_, 0);
    for (std::size_t i = 0; i < n_; ++i)
      if (largest[i] > 0) step[i] = -static_cast<int>(std::floor(0.5 * log2_size(largest[i])));
    for (std::size_t i = 0; i < n_; ++i) {
      scale_[i] += step[i];
      for (std::size_t j = 0; j < n_; ++j) at(i, j) = ldexp(at(i, j), step[i] + step[j]);
    }
  }
}

template <class T>
void LinearSolver<T>::swap_columns(std::size_t a, std::size_t b) {
  if (a == b) return;
  for (std::size_t i = 0; i < n_; ++i) std::swap(at(i, a), at(i, b));
  std::swap(column_[a], column_[b]);
}

template <class T>
bool LinearSolver<T>::bring_up_pivot(std::size_t step, const T& smallest, T& largest) {
  std::size_t row = step, column = step;
  for (std::size_t i = step; i < n_; ++i)
    for (std::size_t j = step; j < n_; ++j)
      if (abs(at(i, j)) > abs(at(row, column))) row = i, column = j;
  const T pivot = abs(at(row, column));
  if (step == 0) largest = pivot;
  if (!(pivot > smallest * largest)) return false;
  ratio_ = static_cast<double>(pivot / largest);
  if (row != step) {
    for (std::size_t j = 0; j < n_; ++j) std::swap(at(row, j), at(step, j));
    std::swap(row_[row], row_[step]);
  }
  swap_columns(column, step);
  return true;
}

template <class T>
void LinearSolver<T>::factor(std::span<const T> matrix, std::size_t size, const T& least) {
  n_ = size;
  m_.assign(matrix.begin(), matrix.end());
  row_.resize(n_), column_.resize(n_);
  std::iota(row_.begin(), row_.end(), std::size_t{0});
  std::iota(column_.begin(), column_.end(), std::size_t{0});
  equilibrate();
  T largest = T(0);
  ratio_ = 1;
  for (rank_ = 0; rank_ < n_ && bring_up_pivot(rank_, least, largest); ++rank_)
    for (std::size_t i = rank_ + 1; i < n_; ++i) {
      const T factor = at(i, rank_) /= at(rank_, rank_);
      if (factor == 0) continue;
      for (std::size_t j = rank_ + 1; j < n_; ++j) at(i, j) -= factor * at(rank_, j);
    }
}

template <class T>
void LinearSolver<T>::solve(std::span<T> b) const {
  std::vector<T> x(n_, T(0));
  for (std::size_t i = 0; i < rank_; ++i) {
    x[i] = ldexp(b[row_[i]], scale_[row_[i]]);
    for (std::size_t j = 0; j < i; ++j) x[i] -= at(i, j) * x[j];
  }
  for (std::size_t i = rank_; i-- > 0;) {
    for (std::size_t j = i + 1; j < rank_; ++j) x[i] -= at(i, j) * x[j];
    x[i] /= at(i, i);
  }
  for (std::size_t i = 0; i < n_; ++i) b[column_[i]] = ldexp(x[i], scale_[column_[i]]);
}

template <class T>
std::vector<std::vector<T>> LinearSolver<T>::null_vectors() const {
  std::vector<std::vector<T>> out;
  for (std::size_t d = rank_; d < n_; ++d) {
    std::vector<T> x(n_, T(0)), given(n_, T(0));
    x[d] = T(1);
    for (std::size_t i = rank_; i-- > 0;) {
      x[i] = -at(i, d);
      for (std::size_t j = i + 1; j < rank_; ++j) x[i] -= at(i, j) * x[j];
      x[i] /= at(i, i);
    }
    for (std::size_t i = 0; i < n_; ++i) given[column_[i]] = ldexp(x[i], scale_[column_[i]]);
    out.push_back(std::move(given));
  }
  return out;
}

}  // namespace maupertuis::extended
