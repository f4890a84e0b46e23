#include "analysis/linearization/dense.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

LeastSquares least_squares(const Matrix& a, const Matrix& b, double threshold) {
  if (a.size() == 0) return {Matrix::Zero(a.cols(), b.cols()), 0};
  Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
  solver.setThreshold(threshold);
  solver.compute(a);
  return {solver.solve(b), solver.rank()};
}

std::vector<std::size_t> pivot_columns(const Matrix& a, double threshold) {
  std::vector<std::size_t> out;
  if (a.rows() == 0 || a.cols() == 0) return out;
  Eigen::ColPivHouseholderQR<Matrix> qr;
  qr.setThreshold(threshold);
  qr.compute(a);
  for (Index k = 0; k < qr.rank(); ++k) out.push_back(static_cast<std::size_t>(qr.colsPermutation().indices()[k]));
  return out;
}

KernelFirst kernel_first(const Matrix& a, double tolerance) {
  const Index n = a.cols();
  if (a.rows() == 0) return {n, Matrix::Identity(n, n)};
  const Eigen::ColPivHouseholderQR<Matrix> qr(a.transpose());
  const Index diagonal = std::min(a.rows(), n);
  Index rank = 0;
  while (rank < diagonal && std::abs(qr.matrixQR()(rank, rank)) > tolerance) ++rank;
  const Matrix q = columns_of_q(qr, n);
  KernelFirst out{n - rank, Matrix(n, n)};
  out.basis.leftCols(n - rank) = q.rightCols(n - rank);
  out.basis.rightCols(rank) = q.leftCols(rank);
  return out;
}

Matrix triangular_factor(const Matrix& a) {
  const Eigen::HouseholderQR<Matrix> qr(a);
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

Matrix orthogonal_factor(const Matrix& a) { return columns_of_q(Eigen::HouseholderQR<Matrix>(a), a.rows()); }

std::vector<std::vector<Index>> uncoupled_parts(const Matrix& a) {
  std::vector<std::vector<Index>> out;
  std::vector<bool> taken(static_cast<std::size_t>(a.rows()), false);
  for (Index first = 0; first < a.rows(); ++first) {
    if (taken[static_cast<std::size_t>(first)]) continue;
    std::vector<Index> part{first};
    taken[static_cast<std::size_t>(first)] = true;
    for (std::size_t k = 0; k < part.size(); ++k)
      for (Index j = 0; j < a.rows(); ++j)
        if (!taken[static_cast<std::size_t>(j)] && (a(part[k], j) != 0 || a(j, part[k]) != 0)) {
          taken[static_cast<std::size_t>(j)] = true;
          part.push_back(j);
        }
    std::sort(part.begin(), part.end());
    out.push_back(std::move(part));
  }
  return out;
}

SymmetricEigen symmetric_eigen(const Matrix& a) {
  const Index n = a.rows();
  std::vector<Index> order;
  Vector values(n), norms(n);
  Matrix vectors = Matrix::Zero(n, n);
  for (const std::vector<Index>& part : uncoupled_parts(a)) {
    const Matrix block = a(part, part);
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(block);
    for (Index i = 0; i < block.rows(); ++i) {
      const auto at = static_cast<Index>(order.size());
      values[at] = solver.eigenvalues()[i], norms[at] = block.stableNorm();
      vectors(part, at) = solver.eigenvectors().col(i);
      order.push_back(at);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return values[i] < values[j]; });
  return {values(order), vectors(Eigen::all, order), norms(order)};
}

std::optional<Cholesky> cholesky(const Matrix& a) {
  if (!a.allFinite()) return std::nullopt;
  const Eigen::LLT<Matrix> llt(a);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const Matrix lower = llt.matrixL();
  const Matrix identity = Matrix::Identity(a.rows(), a.cols());
  return Cholesky{lower, lower.triangularView<Eigen::Lower>().solve(identity)};
}

GeneralEigen general_eigen(const Matrix& a) {
  const Eigen::EigenSolver<Matrix> solver(a);
  GeneralEigen out{solver.eigenvalues(), solver.eigenvectors(), {}};
  out.left = out.vectors.partialPivLu().inverse();
  return out;
}

namespace {

template <class Line>
void scale_line(Line&& line, double& factor) {
  const double size = line.size() == 0 ? 0 : line.template lpNorm<Eigen::Infinity>();
  if (!(size > 0) || !std::isfinite(size)) return;
  const double f = std::ldexp(1, -std::ilogb(std::sqrt(size)));
  line *= f;
  factor *= f;
}

}  // namespace

Equilibration::Equilibration(const Matrix& a) : rows(Vector::Ones(a.rows())), columns(Vector::Ones(a.cols())) {
  Matrix work = a;
  constexpr int sweeps = 6;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index i = 0; i < work.rows(); ++i) scale_line(work.row(i), rows[i]);
    for (Index i = 0; i < work.cols(); ++i) scale_line(work.col(i), columns[i]);
  }
}

}  // namespace maupertuis
