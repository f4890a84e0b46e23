#include "integrator/variational/stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::variational {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 60;
constexpr int slow = 7;               // iterations after which the next step begins with a new Jacobian
constexpr double singular = 1e-15;    // reciprocal condition of a scaled matrix

/// Scales rows and columns of m by their largest entries, so that units do not decide what is small.
void equilibrate(MatrixXd& m, VectorXd& rows, VectorXd& columns) {
  const auto inverse = [](double size) { return size > 0 ? 1 / size : 1; };
  rows = m.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse);
  m = rows.asDiagonal() * m;
  columns = m.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse);
  m = m * columns.asDiagonal();
}

}  // namespace

StageSolver::StageSolver(const VariationalFunctions& functions, std::span<const double> parameters, Tableau tableau)
    : functions_(functions), momenta_(functions.momenta, parameters), forces_(functions.forces, parameters),
      positions_(functions.motion.positions, parameters), rates_(functions.motion.rates, parameters),
      tableau_(std::move(tableau)), n_(functions.motion.freedoms), m_(functions.motion.constraints),
      s_(tableau_.stages), point_(functions.motion.inputs()), point_end_(point_.size()) {
  for (MatrixXd* matrix : {&positions_at_, &velocities_, &forces_at_}) matrix->setZero(index(n_), index(s_));
  q_begin_.resize(n_);
  weights_.setOnes(index(n_));
  set_rows({});
}

void StageSolver::set_rows(const std::vector<std::size_t>& rows) {
  rows_ = rows;
  multipliers_.setZero(index(rows_.size()), index(s_));
  residual_.setZero(index(unknowns()));
  have_factors_ = false;
}

void StageSolver::guess(double h, std::span<const double> v, std::span<const double> a, std::span<const double> lambda) {
  for (std::size_t j = 0; j < s_; ++j) {
    for (std::size_t i = 0; i < n_; ++i)
      velocities_(index(i), index(j)) = v[i] + static_cast<double>(tableau_.c[j]) * h * a[i];
    for (std::size_t k = 0; k < rows_.size(); ++k) multipliers_(index(k), index(j)) = lambda[rows_[k]];
  }
}

void StageSolver::extrapolate(const StageSolver& last, long double begin, long double length) {
  MatrixXd weights(index(s_), index(s_));
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t j = 0; j < s_; ++j)
      weights(index(j), index(i)) = static_cast<double>(tableau_.basis(j, begin + length * tableau_.c[i]));
  velocities_ = last.velocities_ * weights;
  if (constrained()) multipliers_ = last.multipliers_ * weights;
}

void StageSolver::fill_point(std::size_t i) {
  std::fill(point_.begin(), point_.end(), 0.0);
  for (std::size_t k = 0; k < n_; ++k) {
    point_[k] = positions_at_(index(k), index(i));
    point_[n_ + k] = velocities_(index(k), index(i));
  }
  for (std::size_t k = 0; k < rows_.size(); ++k)
    point_[functions_.motion.lambda_at(rows_[k])] = multipliers_(index(k), index(i));
  point_.back() = t_begin_ + static_cast<double>(tableau_.c[i]) * h_;
}

void StageSolver::place_nodes() {
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t k = 0; k < n_; ++k) {
      long double sum = begin_->q[k].lo;
      for (std::size_t j = 0; j < s_; ++j)
        sum += h_ * tableau_.at(tableau_.a, i, j) * velocities_(index(k), index(j));
      positions_at_(index(k), index(i)) = static_cast<double>(begin_->q[k].hi + sum);
    }
}

bool StageSolver::residual() {
  place_nodes();
  MatrixXd& p = forces_at_;  // first the forces; the momenta are compared with their sums below
  std::vector<double> momenta_now(n_ * s_);
  for (std::size_t i = 0; i < s_; ++i) {
    fill_point(i);
    const auto f = forces_.values(point_);
    for (std::size_t k = 0; k < n_; ++k) p(index(k), index(i)) = f[k];
    const auto momentum = momenta_.values(point_);
    std::copy(momentum.begin(), momentum.end(), momenta_now.begin() + static_cast<std::ptrdiff_t>(i * n_));
    if (i == 0 || !constrained()) continue;
    const auto phi = positions_.values(point_);
    for (std::size_t k = 0; k < rows_.size(); ++k)
      residual_[index(s_ * n_ + (i - 1) * rows_.size() + k)] = phi[rows_[k]] / h_;
  }
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t k = 0; k < n_; ++k) {
      long double sum = begin_->p[k].lo;
      for (std::size_t j = 0; j < s_; ++j) sum += h_ * tableau_.at(tableau_.dual, i, j) * forces_at_(index(k), index(j));
      residual_[index(i * n_ + k)] = static_cast<double>((momenta_now[i * n_ + k] - static_cast<long double>(begin_->p[k].hi)) - sum);
    }
  return residual_.allFinite();
}

bool StageSolver::jacobian() {
  const Index n = index(n_), r = index(rows_.size());
  const std::size_t inputs = point_.size();
  std::vector<MatrixXd> pq(s_), pv(s_), fq(s_), fv(s_), fl(s_), phi(s_);
  MatrixXd all(n, index(inputs)), all_rows(index(m_), index(inputs));
  weights_.setZero();
  for (std::size_t i = 0; i < s_; ++i) {
    fill_point(i);
    momenta_.linearize(point_);
    forces_.linearize(point_);
    if (!momenta_.finite() || !forces_.finite()) return false;
    momenta_.block(0, all);
    pq[i] = all.leftCols(n), pv[i] = all.middleCols(n, n);
    forces_.block(0, all);
    fq[i] = all.leftCols(n), fv[i] = all.middleCols(n, n);
    weights_ = weights_.cwiseMax(pv[i].diagonal().cwiseAbs());
    if (!constrained()) continue;
    fl[i].resize(n, r), phi[i].resize(r, n);
    positions_.linearize(point_);
    positions_.block(0, all_rows);
    for (Index k = 0; k < r; ++k) {
      const auto row = rows_[static_cast<std::size_t>(k)];
      fl[i].col(k) = all.col(index(functions_.motion.lambda_at(row)));
      phi[i].row(k) = all_rows.row(index(row)).head(n);
    }
  }
  weights_ = weights_.cwiseSqrt();

  // Unknowns: V_1 … V_s, then h Λ_1 … h Λ_{s−1}.
  MatrixXd j = MatrixXd::Zero(index(unknowns()), index(unknowns()));
  const auto a = [&](std::size_t row, std::size_t column) { return static_cast<double>(tableau_.at(tableau_.a, row, column)); };
  const auto dual = [&](std::size_t row, std::size_t column) { return static_cast<double>(tableau_.at(tableau_.dual, row, column)); };
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t k = 0; k < s_; ++k) {
      auto block = j.block(index(i) * n, index(k) * n, n, n);
      if (i == k) block += pv[i];
      block += h_ * a(i, k) * pq[i] - h_ * dual(i, k) * fv[k];
      for (std::size_t l = 0; l < s_; ++l) block -= h_ * h_ * dual(i, l) * a(l, k) * fq[l];
      if (!constrained()) continue;
      if (k + 1 < s_) j.block(index(i) * n, index(s_) * n + index(k) * r, n, r) = -dual(i, k) * fl[k];
      if (i > 0) j.block(index(s_) * n + index(i - 1) * r, index(k) * n, r, n) = a(i, k) * phi[i];
    }
  equilibrate(j, row_scale_, column_scale_);
  factored_.compute(j);
  have_factors_ = true;
  factored_h_ = h_;
  return true;
}

StageStatus StageSolver::iterate() {
  const Index n = index(n_), r = index(rows_.size());
  double last = std::numeric_limits<double>::infinity();
  bool fresh = false;
  const auto renew = [&] { return fresh = jacobian(); };
  if ((!have_factors_ || factored_h_ != h_ || iterations_ > slow) && (place_nodes(), !renew())) return StageStatus::NonFinite;
  for (iterations_ = 1; iterations_ <= most_iterations; ++iterations_) {
    if (!residual()) return StageStatus::NonFinite;
    const VectorXd change = column_scale_.cwiseProduct(factored_.solve(row_scale_.cwiseProduct(residual_)));
    if (!change.allFinite()) return factored_.rcond() > singular ? StageStatus::NonFinite : StageStatus::Singular;
    double size = 0, reference = 0, resolution = 0;
    for (std::size_t i = 0; i < s_; ++i) {
      const VectorXd step = change.segment(index(i) * n, n);
      size = std::max(size, weights_.cwiseProduct(step).norm());
      reference = std::max(reference, weights_.cwiseProduct(velocities_.col(index(i))).norm());
      resolution = std::max(resolution, weights_.cwiseProduct(positions_at_.col(index(i))).norm() * epsilon / std::abs(h_));
      velocities_.col(index(i)) -= step;
      if (constrained() && i + 1 < s_) multipliers_.col(index(i)) -= change.segment(index(s_) * n + index(i) * r, r) / h_;
    }
    // Corrections that no longer shrink are rounding if they are small; the next one is foreseen from the last two.
    const bool small = size <= 1e-11 * reference + 1e3 * resolution;
    const double next = std::isfinite(last) ? size * size / last : size;
    if (size == 0 || (small && size >= 0.8 * last) || next <= 0.01 * epsilon * reference) return StageStatus::Ok;
    if (!small && size > 0.5 * last && (iterations_ > 3 || !fresh)) {
      if (place_nodes(), !renew()) return StageStatus::NonFinite;
      last = std::numeric_limits<double>::infinity();
    } else {
      last = size;
    }
  }
  return factored_.rcond() > singular ? StageStatus::NoConvergence : StageStatus::Singular;
}

StageStatus StageSolver::solve(const Phase& begin, double h, double end_time, Phase& end) {
  begin_ = &begin;
  t_begin_ = begin.t;
  h_ = h;
  for (std::size_t k = 0; k < n_; ++k) q_begin_[k] = begin.q[k].hi;
  if (const StageStatus status = iterate(); status != StageStatus::Ok) return status;
  return finish(end_time, end);
}

/// q₁, p₁ by compensated sums; then v₁ with p₁ = ∂L/∂v(q₁,v₁) and, under constraints, the last multiplier, which only
/// gives p₁ its last part so that φ̇(q₁,v₁) = 0.
StageStatus StageSolver::finish(double end_time, Phase& end) {
  const Index n = index(n_), r = index(rows_.size());
  if (constrained()) multipliers_.col(index(s_ - 1)).setZero();
  if (!residual()) return StageStatus::NonFinite;
  std::vector<Compensated> q = begin_->q, p = begin_->p;
  for (std::size_t k = 0; k < n_; ++k) {
    long double dq = 0, dp = 0;
    for (std::size_t j = 0; j < s_; ++j) {
      dq += tableau_.b[j] * velocities_(index(k), index(j));
      dp += tableau_.b[j] * forces_at_(index(k), index(j));
    }
    for (const auto& [sum, increment] : {std::pair(&q[k], h_ * dq), std::pair(&p[k], h_ * dp)}) {
      const auto leading = static_cast<double>(increment);
      sum->add(leading);
      sum->add(static_cast<double>(increment - leading));
    }
  }

  std::vector<double>& x = point_end_;
  std::fill(x.begin(), x.end(), 0.0);
  for (std::size_t k = 0; k < n_; ++k) {
    x[k] = q[k].hi;
    x[n_ + k] = velocity_at(1, k);
  }
  x.back() = end_time;
  const Index inputs = index(x.size());
  MatrixXd all(n, inputs), all_rows(index(m_), inputs), bordered = MatrixXd::Zero(n + r, n + r), normals(n, r);
  VectorXd right(n + r), impulse = VectorXd::Zero(r), rows_scaled, columns_scaled;
  if (constrained()) {
    forces_.linearize(x);
    forces_.block(0, all);
    for (Index k = 0; k < r; ++k) normals.col(k) = all.col(index(functions_.motion.lambda_at(rows_[static_cast<std::size_t>(k)])));
  }
  double last = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < most_iterations; ++turn) {
    momenta_.linearize(x);
    if (!momenta_.finite()) return StageStatus::NonFinite;
    momenta_.block(n_, bordered.topLeftCorner(n, n));
    const VectorXd pushed = normals * impulse;
    for (std::size_t k = 0; k < n_; ++k)
      right[index(k)] = momenta_.value(k) - p[k].hi - p[k].lo - (constrained() ? pushed[index(k)] : 0);
    if (constrained()) {
      rates_.linearize(x);
      rates_.block(0, all_rows);
      for (Index k = 0; k < r; ++k) {
        const auto row = rows_[static_cast<std::size_t>(k)];
        bordered.row(n + k).head(n) = all_rows.row(index(row)).segment(n, n);
        right[n + k] = rates_.value(row);
      }
      bordered.topRightCorner(n, r) = -normals;
      bordered.bottomRightCorner(r, r).setZero();
    }
    MatrixXd scaled = bordered;
    equilibrate(scaled, rows_scaled, columns_scaled);
    const Eigen::PartialPivLU<MatrixXd> lu(scaled);
    const VectorXd change = columns_scaled.cwiseProduct(lu.solve(rows_scaled.cwiseProduct(right)));
    if (!change.allFinite()) return StageStatus::Singular;
    double size = 0, reference = 0;
    for (std::size_t k = 0; k < n_; ++k) {
      x[n_ + k] -= change[index(k)];
      size += std::pow(weights_[index(k)] * change[index(k)], 2);
      reference += std::pow(weights_[index(k)] * x[n_ + k], 2);
    }
    impulse -= change.tail(r);
    const bool small = size <= 1e-20 * reference;
    if (size == 0 || (small && size >= 0.1 * last) || size < 1e-32 * reference) break;
    if (turn > 20 && size >= last) return lu.rcond() > singular ? StageStatus::NoConvergence : StageStatus::Singular;
    last = size;
  }
  if (constrained()) {
    const VectorXd pushed = normals * impulse;
    for (std::size_t k = 0; k < n_; ++k) p[k].add(pushed[index(k)]);
    multipliers_.col(index(s_ - 1)) = impulse / (h_ * static_cast<double>(tableau_.b.back()));
  }
  end.t = end_time;
  end.q = std::move(q);
  end.p = std::move(p);
  end.v.assign(x.begin() + static_cast<std::ptrdiff_t>(n_), x.begin() + static_cast<std::ptrdiff_t>(2 * n_));
  return StageStatus::Ok;
}

void StageSolver::momenta(double t, std::span<const double> q, std::span<const double> v, std::span<double> p) {
  std::fill(point_.begin(), point_.end(), 0.0);
  std::copy(q.begin(), q.end(), point_.begin());
  std::copy(v.begin(), v.end(), point_.begin() + static_cast<std::ptrdiff_t>(n_));
  point_.back() = t;
  const auto values = momenta_.values(point_);
  std::copy(values.begin(), values.end(), p.begin());
}

double StageSolver::velocity_at(long double x, std::size_t component) const {
  long double sum = 0;
  for (std::size_t j = 0; j < s_; ++j) sum += tableau_.basis(j, x) * velocities_(index(component), index(j));
  return static_cast<double>(sum);
}

double StageSolver::position_at(long double x, std::size_t component) const {
  long double sum = 0;
  for (std::size_t j = 0; j < s_; ++j) sum += tableau_.basis_integral(j, x) * velocities_(index(component), index(j));
  return static_cast<double>(q_begin_[component] + h_ * sum);
}

std::span<const double> StageSolver::node_point(std::size_t i) {
  fill_point(i);
  return point_;
}

}  // namespace maupertuis::variational
