#include "comparison/freedoms.hpp"

#include "linear_algebra/dense.hpp"

#include <fmt/format.h>

namespace maupertuis::comparison {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

constexpr double rank_threshold = 1e-9;

/// Columns, then rows, brought to length 1, so that metres and radians count alike.
Matrix balanced(Matrix m) {
  for (Index j = 0; j < m.cols(); ++j)
    if (const double size = m.col(j).norm(); size > 0) m.col(j) /= size;
  for (Index i = 0; i < m.rows(); ++i)
    if (const double size = m.row(i).norm(); size > 0) m.row(i) /= size;
  return m;
}

std::size_t rank_of(const Matrix& m) {
  if (m.rows() == 0 || m.cols() == 0) return 0;
  Eigen::ColPivHouseholderQR<Matrix> qr(balanced(m));
  qr.setThreshold(rank_threshold);
  return static_cast<std::size_t>(qr.rank());
}

Matrix kernel_of(const Matrix& m, Index n) {
  if (m.rows() == 0) return Matrix::Identity(n, n);
  Eigen::FullPivLU<Matrix> lu(m);
  lu.setThreshold(rank_threshold);
  if (lu.dimensionOfKernel() == 0) return Matrix(n, 0);
  return lu.kernel();
}

Matrix by_rows(const std::vector<double>& entries, std::size_t rows, std::size_t columns) {
  Matrix m(static_cast<Index>(rows), static_cast<Index>(columns));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      m(static_cast<Index>(i), static_cast<Index>(j)) = entries[i * columns + j];
  return m;
}

Matrix position_rows(const Matrix& m, const MechanicalSystem& system) {
  Matrix out(0, m.cols());
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    if (system.constraints[k].level != Constraint::Level::Position) continue;
    out.conservativeResize(out.rows() + 1, Eigen::NoChange);
    out.row(out.rows() - 1) = m.row(static_cast<Index>(k));
  }
  return out;
}

}  // namespace

std::string describe(const MotionState& state, const MechanicalSystem& system) {
  constexpr int most = 12;
  int count = 0;
  std::string out;
  const auto add = [&](const std::string& name, double value) {
    if (++count > most) return;
    out += fmt::format("{}{} = {:.6g}", out.empty() ? "" : ", ", name, value);
  };
  for (std::size_t i = 0; i < state.q.size(); ++i) add(system.coordinates[i].name, state.q[i]);
  for (std::size_t i = 0; i < state.v.size(); ++i)
    if (state.v[i] != 0) add(system.coordinates[i].name + "'", state.v[i]);
  if (state.t != 0) add("t", state.t);
  return count > most ? out + ", …" : out;
}

void count_freedoms(const EquationsOfMotion& a, const EquationsOfMotion& b, const PullBack& pull_back,
                    const Motions& motions, Comparison& comparison) {
  const std::size_t n_a = a.system->coordinates.size(), n_b = b.system->coordinates.size();
  ExprVector q;
  for (const Coordinate& c : b.system->coordinates) q.push_back(c.q);
  ExprVector jacobian;
  for (const Expr& f : pull_back.positions())
    for (const Expr& entry : gradient(f, q)) jacobian.push_back(entry);
  const ExprVector a_rows = pull_back(constraint_matrix(a).entries);
  const ConstraintManifold manifold(b);

  std::size_t rank_a = 0, positions_a = 0, rank_b = 0, positions_b = 0;
  std::vector<std::size_t> ranks;
  for (const MotionState& state : motions.states()) {
    const Bindings at = motions.at(state);
    const Matrix of_a = by_rows(evaluate(a_rows, at), a.system->constraints.size(), n_a);
    const Matrix of_b = by_rows(manifold.matrix(state), b.system->constraints.size(), n_b);
    rank_a = std::max(rank_a, rank_of(of_a));
    rank_b = std::max(rank_b, rank_of(of_b));
    positions_a = std::max(positions_a, rank_of(position_rows(of_a, *a.system)));
    positions_b = std::max(positions_b, rank_of(position_rows(of_b, *b.system)));
    const Matrix j = by_rows(evaluate(jacobian, at), n_a, n_b);
    ranks.push_back(rank_of(j * kernel_of(of_b, static_cast<Index>(n_b))));
    comparison.rank = std::max(comparison.rank, ranks.back());
  }
  comparison.freedoms_a = n_a - positions_a;
  comparison.freedoms_b = n_b - positions_b;
  comparison.instantaneous_freedoms_a = n_a - rank_a;
  comparison.instantaneous_freedoms_b = n_b - rank_b;
  for (std::size_t k = 0; k < ranks.size() && comparison.degenerate.empty(); ++k)
    if (ranks[k] < comparison.rank) comparison.degenerate = describe(motions.states()[k], *b.system);
}

}  // namespace maupertuis::comparison
