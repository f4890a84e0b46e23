#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace maupertuis {

/// A matrix with `below` diagonals under the main one and `above` over it, and its factors L U with partial pivoting.
/// Entries are kept by columns. Cost: O(n · below · (below + above)) to factor, O(n · (below + above)) to solve.
template <typename T>
class BandedMatrix {
 public:
  BandedMatrix() = default;
  BandedMatrix(std::size_t n, std::size_t below, std::size_t above);
  std::size_t size() const { return n_; }
  void clear();
  T& at(std::size_t row, std::size_t column) { return data_[column * rows_ + row + lift_ - column]; }
  T at(std::size_t row, std::size_t column) const { return data_[column * rows_ + row + lift_ - column]; }
  /// The rows of a column that hold entries: from, to.
  std::size_t first_row(std::size_t column) const { return column > above_ ? column - above_ : 0; }
  std::size_t end_row(std::size_t column) const { return column + below_ + 1 < n_ ? column + below_ + 1 : n_; }
  /// y += A x, before `factor`.
  void add_product(const T* x, T* y) const;

  /// Factors it in its place. False where a pivot is below 1e-14 of the largest entry of its column: singular.
  bool factor();
  /// After `factor`: x = A⁻¹ x.
  void solve(T* x) const;

 private:
  std::size_t n_ = 0, below_ = 0, above_ = 0;
  std::size_t lift_ = 0, rows_ = 0;  // of the main diagonal in a column; with the room that pivoting needs
  std::vector<T> data_;
  std::vector<std::size_t> pivots_;
};

extern template class BandedMatrix<double>;
extern template class BandedMatrix<std::complex<double>>;

}  // namespace maupertuis
