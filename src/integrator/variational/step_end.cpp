#include "integrator/variational/stages.hpp"

#include <algorithm>

/// The end of a step whose node equations are solved: q₁ and p₁ by compensated sums, and v₁.
namespace maupertuis::variational {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The whole of a long double goes into the sum.
void add(Compensated& sum, long double increment) {
  const auto leading = static_cast<double>(increment);
  sum.add(leading);
  sum.add(static_cast<double>(increment - leading));
}

}  // namespace

StageStatus StageSolver::finish(double end_time, Phase& end) {
  if (constrained()) multipliers_.col(index(s_ - 1)).setZero();
  if (!residual()) return StageStatus::NonFinite;
  Phase next{end_time, begin_->q, begin_->p, {}};
  for (std::size_t k = 0; k < n_; ++k) {
    long double dq = 0, dp = 0;
    for (std::size_t j = 0; j < s_; ++j) {
      dq += tableau_.b[j] * velocities_(index(k), index(j));
      dp += tableau_.b[j] * forces_at_(index(k), index(j));
    }
    add(next.q[k], h_ * dq);
    add(next.p[k], h_ * dp);
  }
  const StageStatus status = end_velocity(next);
  if (status == StageStatus::Ok) end = std::move(next);
  return status;
}

/// v₁ from p₁ = ∂L/∂v(q₁,v₁), by Newton. Under constraints p₁ still lacks the impulse of the last multiplier, which is
/// what makes φ̇(q₁,v₁) = 0: it is an unknown beside v₁.
StageStatus StageSolver::end_velocity(Phase& end) {
  const Index n = index(n_), r = index(rows_.size());
  std::vector<double>& x = point_end_;
  std::fill(x.begin(), x.end(), 0.0);
  for (std::size_t k = 0; k < n_; ++k) {
    x[k] = end.q[k].hi;
    x[n_ + k] = velocity_at(1, k);
  }
  x.back() = end.t;
  const MatrixXd normals = normals_at(x);
  VectorXd impulse = VectorXd::Zero(r), rows_scaled, columns_scaled;
  double last = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < most_iterations; ++turn) {
    MatrixXd matrix = MatrixXd::Zero(n + r, n + r);
    VectorXd right(n + r);
    if (!legendre_equations(x, end, normals, impulse, matrix, right)) return StageStatus::NonFinite;
    equilibrate(matrix, rows_scaled, columns_scaled);
    const Eigen::PartialPivLU<MatrixXd> lu(matrix);
    const VectorXd change = columns_scaled.cwiseProduct(lu.solve(rows_scaled.cwiseProduct(right)));
    if (!change.allFinite()) return StageStatus::Singular;
    Eigen::Map<VectorXd> v(x.data() + n_, n);
    v -= change.head(n);
    impulse -= change.tail(r);
    const double size = weights_.cwiseProduct(change.head(n)).norm(), reference = weights_.cwiseProduct(v).norm();
    const bool small = size <= 1e-10 * reference;
    if (size == 0 || (small && size >= 0.3 * last) || size < 0.5 * epsilon * reference) break;
    if (turn > 20 && size >= last) return lu.rcond() > singular ? StageStatus::NoConvergence : StageStatus::Singular;
    last = size;
  }
  if (constrained()) {
    const VectorXd push = normals * impulse;
    for (std::size_t k = 0; k < n_; ++k) end.p[k].add(push[index(k)]);
    multipliers_.col(index(s_ - 1)) = impulse / (h_ * static_cast<double>(tableau_.b.back()));
  }
  end.v.assign(x.begin() + static_cast<std::ptrdiff_t>(n_), x.begin() + static_cast<std::ptrdiff_t>(2 * n_));
  return StageStatus::Ok;
}

/// Aᵀ of the rows in use, at a point.
MatrixXd StageSolver::normals_at(std::span<const double> point) {
  MatrixXd normals(index(n_), index(rows_.size()));
  if (!constrained()) return normals;
  MatrixXd by_multipliers(index(n_), index(m_));
  forces_.linearize(point);
  forces_.block(functions_.motion.lambda_at(0), by_multipliers);
  for (std::size_t k = 0; k < rows_.size(); ++k) normals.col(index(k)) = by_multipliers.col(index(rows_[k]));
  return normals;
}

/// ∂L/∂v − p₁ − Aᵀ impulse = 0 and φ̇ = 0, with their derivatives by v and the impulse.
bool StageSolver::legendre_equations(std::span<const double> point, const Phase& end, const MatrixXd& normals,
                                     const VectorXd& impulse, MatrixXd& matrix, VectorXd& right) {
  const Index n = index(n_), r = index(rows_.size());
  momenta_.linearize(point);
  if (!momenta_.finite()) return false;
  momenta_.block(n_, matrix.topLeftCorner(n, n));
  for (std::size_t k = 0; k < n_; ++k) right[index(k)] = momenta_.value(k) - end.p[k].hi - end.p[k].lo;
  if (!constrained()) return true;
  right.head(n) -= normals * impulse;
  rates_.linearize(point);
  MatrixXd by_velocity(index(m_), n);
  rates_.block(n_, by_velocity);
  for (Index k = 0; k < r; ++k) {
    const std::size_t row = rows_[static_cast<std::size_t>(k)];
    matrix.row(n + k).head(n) = by_velocity.row(index(row));
    right[n + k] = rates_.value(row);
  }
  matrix.topRightCorner(n, r) = -normals;
  return true;
}

}  // namespace maupertuis::variational
