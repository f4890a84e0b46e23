#include "linear_algebra/mesh_matrix.hpp"

#include "linear_algebra/banded.hpp"

#include <eigen3/Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace maupertuis {

SparsityPattern SparsityPattern::of_groups(std::size_t n, const std::vector<std::vector<std::size_t>>& groups) {
  std::vector<std::vector<std::size_t>> columns(n);
  for (const std::vector<std::size_t>& group : groups)
    for (const std::size_t column : group) columns[column].insert(columns[column].end(), group.begin(), group.end());
  SparsityPattern out;
  out.first.push_back(0);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t>& rows = columns[j];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (const std::size_t i : rows) out.bandwidth = std::max(out.bandwidth, i > j ? i - j : j - i);
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
    out.first.push_back(out.rows.size());
    std::vector<std::size_t>().swap(rows);
  }
  return out;
}

std::size_t SparsityPattern::find(std::size_t row, std::size_t column) const {
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first[column]);
  const auto end = rows.begin() + static_cast<std::ptrdiff_t>(first[column + 1]);
  return static_cast<std::size_t>(std::lower_bound(begin, end, row) - rows.begin());
}

template <typename T>
struct MeshMatrix<T>::Factors {
  using Sparse = Eigen::SparseMatrix<T, Eigen::ColMajor, int>;
  std::unique_ptr<BandedMatrix<T>> band;
  Eigen::SparseLU<Sparse, Eigen::COLAMDOrdering<int>> sparse;
};

template <typename T>
MeshMatrix<T>::MeshMatrix() = default;
template <typename T>
MeshMatrix<T>::MeshMatrix(std::shared_ptr<const SparsityPattern> pattern)
    : values(pattern->rows.size(), T(0)), pattern_(std::move(pattern)) {}
template <typename T>
MeshMatrix<T>::~MeshMatrix() = default;
template <typename T>
MeshMatrix<T>::MeshMatrix(MeshMatrix&&) noexcept = default;
template <typename T>
MeshMatrix<T>& MeshMatrix<T>::operator=(MeshMatrix&&) noexcept = default;

template <typename T>
void MeshMatrix<T>::add_product(const T* x, T* y) const {
  for (std::size_t j = 0; j < pattern_->size(); ++j)
    for (std::size_t k = pattern_->first[j]; k < pattern_->first[j + 1]; ++k) y[pattern_->rows[k]] += values[k] * x[j];
}

template <typename T>
bool MeshMatrix<T>::factor() {
  const std::size_t n = pattern_->size(), band = pattern_->bandwidth;
  constexpr std::size_t room = 6;  // so many times the entries a band may hold
  factors_ = std::make_unique<Factors>();
  if ((3 * band + 1) * n <= room * values.size()) {
    factors_->band = std::make_unique<BandedMatrix<T>>(n, band, band);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = pattern_->first[j]; k < pattern_->first[j + 1]; ++k)
        factors_->band->at(pattern_->rows[k], j) = values[k];
    std::vector<T>().swap(values);
    return factors_->band->factor();
  }
  typename Factors::Sparse matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.reserve(static_cast<Eigen::Index>(values.size()));
  for (std::size_t j = 0; j < n; ++j) {
    matrix.startVec(static_cast<Eigen::Index>(j));
    for (std::size_t k = pattern_->first[j]; k < pattern_->first[j + 1]; ++k)
      matrix.insertBack(static_cast<Eigen::Index>(pattern_->rows[k]), static_cast<Eigen::Index>(j)) = values[k];
  }
  matrix.finalize();
  std::vector<T> ones(n, T(1)), test(n, T(0));
  add_product(ones.data(), test.data());
  std::vector<T>().swap(values);
  factors_->sparse.compute(matrix);
  if (factors_->sparse.info() != Eigen::Success) return false;
  // The factors of a matrix that is singular to rounding exist, and solve nothing.
  solve(test.data());
  constexpr double far = 0.01;
  return std::all_of(test.begin(), test.end(), [](const T& x) { return std::abs(x - T(1)) < far; });
}

template <typename T>
void MeshMatrix<T>::solve(T* x) const {
  if (factors_->band) return factors_->band->solve(x);
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  Eigen::Map<Vector> b(x, static_cast<Eigen::Index>(pattern_->size()));
  const Vector solved = factors_->sparse.solve(Vector(b));
  b = solved;
}

template class MeshMatrix<double>;
template class MeshMatrix<std::complex<double>>;

}  // namespace maupertuis
