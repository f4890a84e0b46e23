#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace maupertuis {

/// Where the entries of a square matrix stand: column by column, rows ascending.
struct SparsityPattern {
  std::vector<std::size_t> first;  // [n + 1] of each column in `rows`
  std::vector<std::size_t> rows;
  std::size_t bandwidth = 0;  // the largest distance of an entry from the diagonal

  /// All pairs of unknowns within each group, as the cells of a mesh have them.
  static SparsityPattern of_groups(std::size_t n, const std::vector<std::vector<std::size_t>>& groups);
  std::size_t size() const { return first.size() - 1; }
  /// The number of an entry that is there. Cost: O(log of the column).
  std::size_t find(std::size_t row, std::size_t column) const;
  /// f(row, column, number of the entry) of all of them.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t j = 0; j < size(); ++j)
      for (std::size_t k = first[j]; k < first[j + 1]; ++k) f(rows[k], j, k);
  }
};

/// A matrix of a mesh, and its factors L U with pivoting: within its band where that is narrow, as along a line, else
/// by Eigen's sparse factors.
template <typename T>
class MeshMatrix {
 public:
  MeshMatrix();
  explicit MeshMatrix(std::shared_ptr<const SparsityPattern> pattern);
  ~MeshMatrix();
  MeshMatrix(MeshMatrix&&) noexcept;
  MeshMatrix& operator=(MeshMatrix&&) noexcept;

  const SparsityPattern& pattern() const { return *pattern_; }
  T& at(std::size_t row, std::size_t column) { return values[pattern_->find(row, column)]; }
  /// y += A x, before `factor`.
  void add_product(const T* x, T* y) const;
  /// False where it is singular to rounding. The values are gone afterwards.
  bool factor();
  /// After `factor`: x = A⁻¹ x.
  void solve(T* x) const;

  std::vector<T> values;  // of the entries, in the order of the pattern

 private:
  struct Factors;
  std::shared_ptr<const SparsityPattern> pattern_;
  std::unique_ptr<Factors> factors_;
};

extern template class MeshMatrix<double>;
extern template class MeshMatrix<std::complex<double>>;

}  // namespace maupertuis
