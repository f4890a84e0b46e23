#include "integrator/variational/stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::variational {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int slow = 7;  // iterations after which the next step begins with a new Jacobian

}  // namespace

void equilibrate(MatrixXd& m, VectorXd& rows, VectorXd& columns) {
  const auto inverse = [](double size) { return size > 0 ? 1 / size : 1; };
  rows = m.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse);
  m = rows.asDiagonal() * m;
  columns = m.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse);
  m = m * columns.asDiagonal();
}

StageSolver::StageSolver(const VariationalFunctions& functions, std::span<const double> parameters, Tableau tableau)
    : functions_(functions),
      momenta_(functions.momenta, parameters),
      forces_(functions.forces, parameters),
      positions_(functions.motion.positions, parameters),
      rates_(functions.motion.rates, parameters),
      tableau_(std::move(tableau)),
      n_(functions.motion.freedoms),
      m_(functions.motion.constraints),
      s_(tableau_.stages),
      point_(functions.motion.inputs()),
      point_end_(point_.size()) {
  for (MatrixXd* matrix : {&positions_at_, &velocities_, &forces_at_}) matrix->setZero(index(n_), index(s_));
  nodes_.resize(s_);
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

void StageSolver::guess(double h, std::span<const double> v, std::span<const double> a,
                        std::span<const double> lambda) {
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
      for (std::size_t j = 0; j < s_; ++j) sum += h_ * tableau_.at(tableau_.a, i, j) * velocities_(index(k), index(j));
      positions_at_(index(k), index(i)) = static_cast<double>(begin_->q[k].hi + sum);
    }
}

bool StageSolver::residual() {
  place_nodes();
  MatrixXd momenta_at(index(n_), index(s_));
  for (std::size_t i = 0; i < s_; ++i) {
    fill_point(i);
    const auto force = forces_.values(point_), momentum = momenta_.values(point_);
    for (std::size_t k = 0; k < n_; ++k) {
      forces_at_(index(k), index(i)) = force[k];
      momenta_at(index(k), index(i)) = momentum[k];
    }
    if (i == 0 || !constrained()) continue;
    const auto phi = positions_.values(point_);
    for (std::size_t k = 0; k < rows_.size(); ++k)
      residual_[index(s_ * n_ + (i - 1) * rows_.size() + k)] = phi[rows_[k]] / h_;
  }
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t k = 0; k < n_; ++k) {
      long double sum = begin_->p[k].lo;
      for (std::size_t j = 0; j < s_; ++j)
        sum += h_ * tableau_.at(tableau_.dual, i, j) * forces_at_(index(k), index(j));
      const long double gained = static_cast<long double>(momenta_at(index(k), index(i))) - begin_->p[k].hi;
      residual_[index(i * n_ + k)] = static_cast<double>(gained - sum);
    }
  return residual_.allFinite();
}

/// Derivatives of p, ṗ and φ at the nodes.
bool StageSolver::linearize_nodes() {
  const Index n = index(n_), r = index(rows_.size());
  MatrixXd by_all(n, index(point_.size())), by_q(index(m_), n);
  weights_.setZero(n);
  for (std::size_t i = 0; i < s_; ++i) {
    NodeDerivatives& node = nodes_[i];
    fill_point(i);
    momenta_.linearize(point_);
    forces_.linearize(point_);
    if (!momenta_.finite() || !forces_.finite()) return false;
    momenta_.block(0, by_all);
    node.p_q = by_all.leftCols(n), node.p_v = by_all.middleCols(n, n);
    forces_.block(0, by_all);
    node.f_q = by_all.leftCols(n), node.f_v = by_all.middleCols(n, n);
    weights_ = weights_.cwiseMax(node.p_v.diagonal().cwiseAbs());
    if (!constrained()) continue;
    positions_.linearize(point_);
    positions_.block(0, by_q);
    node.f_lambda.resize(n, r), node.phi_q.resize(r, n);
    for (Index k = 0; k < r; ++k) {
      const std::size_t row = rows_[static_cast<std::size_t>(k)];
      node.f_lambda.col(k) = by_all.col(index(functions_.motion.lambda_at(row)));
      node.phi_q.row(k) = by_q.row(index(row));
    }
  }
  weights_ = weights_.cwiseSqrt();
  return true;
}

/// By the unknowns V_1 … V_s, then h Λ_1 … h Λ_{s−1}.
bool StageSolver::jacobian() {
  if (!linearize_nodes()) return false;
  const Index n = index(n_), r = index(rows_.size()), first_row = index(s_) * n;
  MatrixXd j = MatrixXd::Zero(index(unknowns()), index(unknowns()));
  const auto a = [&](std::size_t row, std::size_t column) {
    return static_cast<double>(tableau_.at(tableau_.a, row, column));
  };
  const auto dual = [&](std::size_t row, std::size_t column) {
    return static_cast<double>(tableau_.at(tableau_.dual, row, column));
  };
  for (std::size_t i = 0; i < s_; ++i)
    for (std::size_t k = 0; k < s_; ++k) {
      auto block = j.block(index(i) * n, index(k) * n, n, n);
      if (i == k) block += nodes_[i].p_v;
      block += h_ * a(i, k) * nodes_[i].p_q - h_ * dual(i, k) * nodes_[k].f_v;
      for (std::size_t l = 0; l < s_; ++l) block -= h_ * h_ * dual(i, l) * a(l, k) * nodes_[l].f_q;
      if (!constrained()) continue;
      if (k + 1 < s_) j.block(index(i) * n, first_row + index(k) * r, n, r) = -dual(i, k) * nodes_[k].f_lambda;
      if (i > 0) j.block(first_row + index(i - 1) * r, index(k) * n, r, n) = a(i, k) * nodes_[i].phi_q;
    }
  equilibrate(j, row_scale_, column_scale_);
  factored_.compute(j);
  have_factors_ = true;
  factored_h_ = h_;
  return true;
}

/// Takes a correction of the unknowns, and measures it in the metric of the diagonal of M.
StageSolver::Correction StageSolver::apply(const VectorXd& change) {
  const Index n = index(n_), r = index(rows_.size());
  Correction out;
  for (std::size_t i = 0; i < s_; ++i) {
    const auto column = index(i);
    const VectorXd step = change.segment(column * n, n);
    velocities_.col(column) -= step;
    if (constrained() && i + 1 < s_) multipliers_.col(column) -= change.segment(index(s_) * n + column * r, r) / h_;
    out.size = std::max(out.size, weights_.cwiseProduct(step).norm());
    out.speed = std::max(out.speed, weights_.cwiseProduct(velocities_.col(column)).norm());
    out.resolution =
        std::max(out.resolution, weights_.cwiseProduct(positions_at_.col(column)).norm() * epsilon / std::abs(h_));
  }
  return out;
}

StageStatus StageSolver::iterate() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool renew = !have_factors_ || factored_h_ != h_ || iterations_ > slow;
  place_nodes();
  if (renew && !jacobian()) return StageStatus::NonFinite;
  double last = infinity;
  for (iterations_ = 1; iterations_ <= most_iterations; ++iterations_) {
    if (!residual()) return StageStatus::NonFinite;
    const VectorXd change = column_scale_.cwiseProduct(factored_.solve(row_scale_.cwiseProduct(residual_)));
    if (!change.allFinite()) return factored_.rcond() > singular ? StageStatus::NonFinite : StageStatus::Singular;
    const Correction made = apply(change);
    // Corrections that no longer shrink are rounding if they are small; the next one is foreseen from the last two.
    const bool small = made.size <= 1e-11 * made.speed + 1e3 * made.resolution;
    const double next = last < infinity ? made.size * made.size / last : made.size;
    if (made.size == 0 || (small && made.size >= 0.8 * last) || next <= 0.01 * epsilon * made.speed)
      return StageStatus::Ok;
    const bool too_slow = !small && made.size > 0.5 * last;
    if (too_slow && (place_nodes(), !jacobian())) return StageStatus::NonFinite;
    last = too_slow ? infinity : made.size;
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
