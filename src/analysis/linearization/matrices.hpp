#pragma once
#include <maupertuis/linearization.hpp>

#include <eigen3/Eigen/Core>

#include <tuple>

namespace maupertuis {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

inline RealMatrix to_real(const Matrix& m) {
  RealMatrix out{static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols()), {}};
  out.entries.reserve(out.rows * out.columns);
  for (Index i = 0; i < m.rows(); ++i)
    for (Index j = 0; j < m.cols(); ++j) out.entries.push_back(m(i, j));
  return out;
}

/// Columns of u, u' and u'' apart.
inline std::tuple<RealMatrix, RealMatrix, RealMatrix> thirds(const Matrix& m) {
  const Index k = m.cols() / 3;
  return {to_real(m.leftCols(k)), to_real(m.middleCols(k, k)), to_real(m.rightCols(k))};
}

inline Matrix to_eigen(const RealMatrix& m) {
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const ByRows>(m.entries.data(), static_cast<Index>(m.rows), static_cast<Index>(m.columns));
}

inline Vector to_eigen(const std::vector<double>& x) {
  return Eigen::Map<const Vector>(x.data(), static_cast<Index>(x.size()));
}
inline std::vector<double> to_list(const Vector& x) { return {x.data(), x.data() + x.size()}; }

}  // namespace maupertuis
