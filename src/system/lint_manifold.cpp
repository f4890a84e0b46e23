#include "system/lint_manifold.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::lint_rules {
namespace {

constexpr double kSmall = 1e-9;  // of a pivot or an eigenvalue, once units are scaled away

Eigen::MatrixXd eigen_matrix(const Matrix& m, std::size_t columns) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(m.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t j = 0; j < columns; ++j) out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = m[i][j];
  return out;
}

double largest(const Row& row) {
  double out = 0;
  for (const double x : row) out = std::max(out, std::abs(x));
  return out;
}

/// Units of the coordinates: what makes the diagonal of M 1; where M has none, what makes the coordinate count in a
/// constraint as much as those beside it.
Row unit_scales(const Matrix& mass, const Matrix& constraints) {
  const std::size_t n = mass.size();
  Row scales(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double size = mass[i][i] != 0 ? std::abs(mass[i][i]) : largest(mass[i]);
    if (size > 0) scales[i] = 1 / std::sqrt(size);
  }
  const Row known = scales;
  for (std::size_t j = 0; j < n; ++j) {
    for (const Row& a : constraints) {
      double beside = 0;
      for (std::size_t k = 0; k < n; ++k) beside = std::max(beside, std::abs(a[k] * known[k]));
      if (known[j] == 0 && a[j] != 0 && beside > 0) scales[j] = std::max(scales[j], beside / std::abs(a[j]));
    }
    if (scales[j] == 0) scales[j] = 1;
  }
  return scales;
}

/// Each row in units of its largest entry, each column in those of its coordinate. Rows of zeros go.
Matrix scaled_rows(const Matrix& rows, const Row& scales) {
  Matrix out;
  for (Row row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] *= scales[j];
    const double size = largest(row);
    if (size == 0) continue;
    for (double& x : row) x /= size;
    out.push_back(std::move(row));
  }
  return out;
}

/// An orthonormal basis of the directions that all rows send to zero, as columns.
Eigen::MatrixXd kernel(const Matrix& rows, std::size_t n) {
  if (rows.empty()) return Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(eigen_matrix(rows, n).transpose());
  qr.setThreshold(kSmall);
  const auto size = static_cast<Eigen::Index>(n);
  return columns_of_q(qr, size).rightCols(size - qr.rank());
}

}  // namespace

Manifold::Manifold(const Subject& s) : coordinates_(s.order.coordinates), velocities_(s.velocities) {
  for (const Constraint& c : s.system.constraints) {
    const bool position = c.level == Constraint::Level::Position;
    if (position) {
      positions_.push_back(c.value);
      for (const Expr& x : gradient(c.value, coordinates_)) position_jacobian_.push_back(x);
    }
    rates_.push_back(position ? total_time_derivative(c.value) : c.value);
    for (const Expr& x : gradient(rates_.back(), velocities_)) rate_jacobian_.push_back(x);
  }
}

bool Manifold::settle(Bindings& point, const ExprVector& unknowns, const ExprVector& values,
                      const ExprVector& jacobian) const {
  const std::size_t n = unknowns.size(), m = values.size();
  const auto matrix = [&](const Row& flat) {
    return Eigen::MatrixXd(Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        flat.data(), static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)));
  };
  for (int step = 0; step < 60; ++step) {
    const Row value = evaluate(values, point);
    Eigen::MatrixXd a = matrix(evaluate(jacobian, point));
    Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(value.data(), static_cast<Eigen::Index>(m));
    if (!a.allFinite() || !r.allFinite()) return false;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double size = a.row(i).cwiseAbs().maxCoeff();
      if (size > 0) a.row(i) /= size, r(i) /= size;
    }
    const Eigen::VectorXd change = a.completeOrthogonalDecomposition().solve(Eigen::VectorXd(-r));
    double size = 1;
    for (std::size_t j = 0; j < n; ++j) {
      double& x = point[unknowns[j]];
      size = std::max(size, std::abs(x));
      x += change(static_cast<Eigen::Index>(j));
    }
    if (r.cwiseAbs().maxCoeff() <= 1e-10 * size) return true;
  }
  return false;
}

bool Manifold::reach(Bindings& point) const {
  return (positions_.empty() || settle(point, coordinates_, positions_, position_jacobian_)) &&
         (rates_.empty() || settle(point, velocities_, rates_, rate_jacobian_));
}

Matrix Manifold::rows(const Bindings& point) const {
  const std::size_t n = coordinates_.size();
  const Row flat = rates_.empty() ? Row{} : evaluate(rate_jacobian_, point);
  Matrix out;
  for (std::size_t i = 0; i < rates_.size(); ++i)
    out.emplace_back(flat.begin() + static_cast<std::ptrdiff_t>(i * n),
                     flat.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
  return out;
}

std::vector<Row> null_vectors(Matrix m, const Row& scales) {
  const std::size_t n = scales.size();
  std::vector<std::size_t> pivot_column;
  std::vector<bool> used(n, false);
  for (std::size_t step = 0; step < std::min(n, m.size()); ++step) {
    std::size_t row = step, column = n;
    double best = kSmall;
    for (std::size_t i = step; i < m.size(); ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (!used[j] && std::abs(m[i][j]) > best) best = std::abs(m[row = i][column = j]);
    if (column == n) break;
    used[column] = true;
    pivot_column.push_back(column);
    std::swap(m[step], m[row]);
    const double pivot = m[step][column];
    for (double& x : m[step]) x /= pivot;
    for (std::size_t i = 0; i < m.size(); ++i) {
      const double factor = m[i][column];
      if (i == step || factor == 0) continue;
      for (std::size_t j = 0; j < n; ++j) m[i][j] -= factor * m[step][j];
    }
  }
  std::vector<Row> out;
  for (std::size_t f = 0; f < n; ++f) {
    if (used[f]) continue;
    Row v(n, 0);
    v[f] = scales[f];
    for (std::size_t k = 0; k < pivot_column.size(); ++k) {
      const double x = -m[k][f];
      if (std::abs(x) > 1e-7) v[pivot_column[k]] = x * scales[pivot_column[k]];
    }
    out.push_back(std::move(v));
  }
  return out;
}

ReducedMass reduce(const Matrix& mass, const Matrix& constraints) {
  const std::size_t n = mass.size();
  const Row scales = unit_scales(mass, constraints);
  Matrix m = mass;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) m[i][j] *= scales[i] * scales[j];
  const Matrix a = scaled_rows(constraints, scales);
  const Eigen::MatrixXd free = kernel(a, n), scaled = eigen_matrix(m, n), reduced = free.transpose() * scaled * free;
  ReducedMass out;
  if (free.cols() == 0) return out;  // the constraints prescribe the motion
  const Eigen::VectorXd energies = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced).eigenvalues();
  out.positive = energies.minCoeff() > -kSmall;
  if (energies.cwiseAbs().minCoeff() > kSmall) return out;
  // v is free, A v = 0, and no free direction feels it: (free)ᵀ M v = 0.
  Matrix both = a;
  const Eigen::MatrixXd felt = free.transpose() * scaled;
  for (Eigen::Index i = 0; i < felt.rows(); ++i) {
    both.emplace_back();
    for (Eigen::Index j = 0; j < felt.cols(); ++j) both.back().push_back(felt(i, j));
  }
  out.null = null_vectors(std::move(both), scales);
  return out;
}

}  // namespace maupertuis::lint_rules
