#include "analysis/action/directions.hpp"

#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::action {
namespace {

constexpr double least_rank_pivot = 1e-9;  // of rows at unit length: below it a row depends on others

std::vector<bool> fixed_at(const Trial& trial, const FixedEnds& fixed, Index node) {
  if (!trial.mesh.closed && node == 0) return fixed.from;
  if (!trial.mesh.closed && node + 1 == trial.mesh.nodes()) return fixed.to;
  return std::vector<bool>(static_cast<std::size_t>(trial.q.rows()), false);
}

/// One node at work: constraints in units of the scale, on its free components.
struct Node {
  Matrix rows;       // [r × n] A S, without fixed components
  Vector values;     // [r]
  Matrix unit_rows;  // of fixed components

  Node(Functional& functional, const Trial& trial, const std::vector<bool>& fixed, const Vector& scale, Index k) {
    const Index n = trial.q.rows();
    functional.constraints_at(trial.mesh.time(k), trial.q.col(k), values, rows);
    rows = rows * scale.asDiagonal();
    unit_rows = Matrix(0, n);
    for (Index i = 0; i < n; ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      rows.col(i).setZero();
      unit_rows.conservativeResize(unit_rows.rows() + 1, n);
      unit_rows.row(unit_rows.rows() - 1) = Vector::Unit(n, i).transpose();
    }
  }
};

}  // namespace

bool all_fixed(const Functional& functional, const Trial& trial, const FixedEnds& fixed) {
  const std::vector<Index>& list = functional.orders().configurations;
  return !trial.mesh.closed && std::all_of(list.begin(), list.end(), [&](Index i) {
    return fixed.from[static_cast<std::size_t>(i)] && fixed.to[static_cast<std::size_t>(i)];
  });
}

Matrix null_basis(const Matrix& rows, Index n) {
  Matrix scaled = rows;
  for (Index i = 0; i < scaled.rows(); ++i)
    if (const double size = scaled.row(i).norm(); size > 0) scaled.row(i) /= size;
  if (scaled.rows() == 0) return Matrix::Identity(n, n);
  Eigen::ColPivHouseholderQR<Matrix> qr(scaled.transpose());
  qr.setThreshold(least_rank_pivot);
  const Matrix q = columns_of_q(qr, n);
  return q.rightCols(n - qr.rank());
}

Vector Directions::reduce(const Vector& full) const {
  Vector out(size());
  for (Index k = 0; k < nodes(); ++k) {
    const Matrix& z = basis[static_cast<std::size_t>(k)];
    out.segment(first[static_cast<std::size_t>(k)], z.cols()) = z.transpose() * full.segment(k * z.rows(), z.rows());
  }
  return out;
}

Vector Directions::expand(const Vector& reduced) const {
  Vector out(normal.size());
  for (Index k = 0; k < nodes(); ++k) {
    const Matrix& z = basis[static_cast<std::size_t>(k)];
    out.segment(k * z.rows(), z.rows()) = z * reduced.segment(first[static_cast<std::size_t>(k)], z.cols());
  }
  return out;
}

Directions directions_of(Functional& functional, const Trial& trial, const FixedEnds& fixed, const Matrix& scale,
                         const Vector& gradient) {
  const Index n = trial.q.rows(), r = functional.constraints();
  Directions out;
  out.normal = Vector::Zero(trial.q.size());
  out.first.push_back(0);
  for (Index k = 0; k < trial.mesh.nodes(); ++k) {
    const Vector size = scale.col(k);
    const Node node(functional, trial, fixed_at(trial, fixed, k), size, k);
    Matrix all(node.unit_rows.rows() + r, n);
    all << node.unit_rows, node.rows;
    const Matrix free = null_basis(all, n);
    out.basis.push_back(size.asDiagonal() * free);
    out.first.push_back(out.first.back() + free.cols());
    Vector mu = Vector::Zero(r);
    if (r > 0 && node.rows.norm() > 0) {
      Eigen::CompleteOrthogonalDecomposition<Matrix> rows(node.rows);
      rows.setThreshold(least_rank_pivot);
      const Vector step = -rows.solve(node.values);
      out.normal.segment(k * n, n) = size.cwiseProduct(step);
      out.off = std::max(out.off, step.lpNorm<Eigen::Infinity>());
      Vector pull = size.cwiseProduct(gradient.segment(k * n, n));
      for (Index i = 0; i < node.unit_rows.rows(); ++i)
        pull -= node.unit_rows.row(i).transpose() * node.unit_rows.row(i).dot(pull);
      Eigen::CompleteOrthogonalDecomposition<Matrix> columns(node.rows.transpose());
      columns.setThreshold(least_rank_pivot);
      mu = -columns.solve(pull);
    }
    out.mu.push_back(mu);
  }
  return out;
}

Vector with_reactions(Functional& functional, const Trial& trial, const Directions& directions, Vector gradient) {
  if (functional.constraints() == 0) return gradient;
  const Index n = trial.q.rows();
  Vector values;
  Matrix rows;
  for (Index k = 0; k < trial.mesh.nodes(); ++k) {
    functional.constraints_at(trial.mesh.time(k), trial.q.col(k), values, rows);
    gradient.segment(k * n, n) += rows.transpose() * directions.mu[static_cast<std::size_t>(k)];
  }
  return gradient;
}

Matrix reduced_element(const Trial& trial, const Matrix& hessian, const Directions& directions, Index e) {
  const Index n = trial.q.rows(), p = trial.mesh.rule->degree;
  std::vector<Index> offset{0};
  for (Index j = 0; j <= p; ++j)
    offset.push_back(offset.back() + directions.basis[static_cast<std::size_t>(trial.mesh.node(e, j))].cols());
  Matrix out(offset.back(), offset.back());
  for (Index j = 0; j <= p; ++j)
    for (Index l = 0; l <= p; ++l) {
      const Matrix& a = directions.basis[static_cast<std::size_t>(trial.mesh.node(e, j))];
      const Matrix& b = directions.basis[static_cast<std::size_t>(trial.mesh.node(e, l))];
      out.block(offset[static_cast<std::size_t>(j)], offset[static_cast<std::size_t>(l)], a.cols(), b.cols()) =
          product(transposed_product(a, hessian.block(j * n, l * n, n, n)), b);
    }
  return out;
}

Matrix node_curvature(Functional& functional, const Trial& trial, const Directions& directions, Index k) {
  const auto at = static_cast<std::size_t>(k);
  const Matrix& z = directions.basis[at];
  if (functional.constraints() == 0 || z.cols() == 0) return Matrix::Zero(z.cols(), z.cols());
  return quadratic_form(z, functional.constraint_curvature(trial.mesh.time(k), trial.q.col(k), directions.mu[at]));
}

Sparse reduced_matrix(Functional& functional, const Trial& trial, const Assembly& assembly,
                      const Directions& directions) {
  std::vector<Eigen::Triplet<double>> entries;
  const Index p = trial.mesh.rule->degree, size = directions.size(), k = functional.integrals();
  const auto add = [&](Index row, Index column, double value) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (Index e = 0; e < trial.mesh.elements(); ++e) {
    const Matrix block = reduced_element(trial, assembly.hessians[static_cast<std::size_t>(e)], directions, e);
    std::vector<Index> places;
    for (Index j = 0; j <= p; ++j) {
      const auto node = static_cast<std::size_t>(trial.mesh.node(e, j));
      for (Index i = directions.first[node]; i < directions.first[node + 1]; ++i) places.push_back(i);
    }
    for (Index a = 0; a < block.rows(); ++a)
      for (Index b = 0; b < block.cols(); ++b)
        add(places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)], block(a, b));
  }
  for (Index node = 0; node < directions.nodes() && functional.constraints() > 0; ++node) {
    const Matrix block = node_curvature(functional, trial, directions, node);
    const Index first = directions.first[static_cast<std::size_t>(node)];
    for (Index a = 0; a < block.rows(); ++a)
      for (Index b = 0; b < block.cols(); ++b) add(first + a, first + b, block(a, b));
  }
  for (Index c = 0; c < k; ++c) {
    const Vector column = directions.reduce(assembly.integral_gradients.col(c));
    for (Index i = 0; i < size; ++i) {
      add(i, size + c, column[i]);
      add(size + c, i, column[i]);
    }
  }
  Sparse out(size + k, size + k);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace maupertuis::action
