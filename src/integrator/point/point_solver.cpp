#include "integrator/point/point_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double singular = 1e-14;   // reciprocal condition of the scaled bordered matrix
constexpr double dependent = 1e-10;  // of scaled constraint rows

Index index(std::size_t i) { return static_cast<Index>(i); }

}  // namespace

PointSolver::PointSolver(const MotionFunctions& functions, std::span<const double> parameters)
    : functions_(functions),
      balance_(functions.balance_by_unknowns, parameters),
      accelerations_(functions.accelerations_by_unknowns, parameters),
      full_balance_(functions.balance, parameters),
      full_accelerations_(functions.accelerations, parameters),
      rates_(functions.rates, parameters),
      positions_(functions.positions, parameters),
      scales_work_(functions.constraint_scales),
      n_(functions.freedoms),
      m_(functions.constraints),
      point_(functions.inputs()),
      scales_(2 * functions.constraints),
      mass_(n_, n_),
      to_forces_(n_, m_),
      a_matrix_(m_, n_) {
  scales_work_.set_parameters(parameters);
}

void PointSolver::set_point(double t, std::span<const double> q, std::span<const double> v) {
  std::copy(q.begin(), q.end(), point_.begin());
  std::copy(v.begin(), v.end(), point_.begin() + static_cast<std::ptrdiff_t>(n_));
  std::fill(point_.begin() + static_cast<std::ptrdiff_t>(2 * n_), point_.end(), 0.0);
  point_.back() = t;
}

void PointSolver::choose_rows() {
  rows_.clear();
  determined_.assign(m_, true);
  rows_chosen_ = true;
  if (m_ == 0) return;
  MatrixXd columns = (a_matrix_ * scale_.head(index(n_)).asDiagonal()).transpose();
  for (Index k = 0; k < columns.cols(); ++k)
    if (const double size = columns.col(k).norm(); size > 0) columns.col(k) /= size;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  qr.setThreshold(dependent);
  for (Index k = 0; k < qr.rank(); ++k) rows_.push_back(static_cast<std::size_t>(qr.colsPermutation().indices()[k]));
  std::sort(rows_.begin(), rows_.end());
  if (rows_.size() == m_) return;
  Eigen::FullPivLU<MatrixXd> lu(columns);
  lu.setThreshold(dependent);
  const MatrixXd dependences = lu.kernel();
  for (std::size_t k = 0; k < m_; ++k) determined_[k] = dependences.row(index(k)).cwiseAbs().maxCoeff() < 1e-8;
}

PointStatus PointSolver::factor() {
  balance_.linearize(point_);
  accelerations_.linearize(point_);
  if (!balance_.finite() || !accelerations_.finite()) return PointStatus::NonFinite;
  balance_.block(functions_.a_at(0), mass_);
  if (m_ > 0) {
    balance_.block(functions_.lambda_at(0), to_forces_);
    accelerations_.block(functions_.a_at(0), a_matrix_);
  }
  const double largest = mass_.cwiseAbs().maxCoeff();
  scale_.resize(index(n_));
  for (Index i = 0; i < index(n_); ++i) {
    const double m = std::abs(mass_(i, i));
    scale_[i] = m > 0 ? 1 / std::sqrt(m) : largest > 0 ? 1 / std::sqrt(largest) : 1;
  }
  for (int turn = 0; turn < 2; ++turn) {
    const bool fresh = !rows_chosen_;
    if (fresh) choose_rows();
    const Index r = index(rows_.size()), n = index(n_);
    scale_.conservativeResize(n + r);
    bordered_.setZero(n + r, n + r);
    bordered_.topLeftCorner(n, n) = mass_;
    for (Index k = 0; k < r; ++k) {
      const Index row = index(rows_[static_cast<std::size_t>(k)]);
      bordered_.col(n + k).head(n) = to_forces_.col(row);
      bordered_.row(n + k).head(n) = a_matrix_.row(row);
      const double size = (a_matrix_.row(row).transpose().array() * scale_.head(n).array()).matrix().norm();
      scale_[n + k] = size > 0 ? 1 / size : 1;
    }
    bordered_ = scale_.asDiagonal() * bordered_ * scale_.asDiagonal();
    factored_.compute(bordered_);
    if (factored_.rcond() > singular) return PointStatus::Ok;
    if (fresh || m_ == 0) break;
    rows_chosen_ = false;
    scale_.conservativeResize(n);
  }
  return PointStatus::Singular;
}

VectorXd PointSolver::unscaled(const VectorXd& right) const {
  return scale_.cwiseProduct(factored_.solve(scale_.cwiseProduct(right)));
}

PointStatus PointSolver::solve(double t, std::span<const double> q, std::span<const double> v) {
  set_point(t, q, v);
  if (const PointStatus status = factor(); status != PointStatus::Ok) return status;
  VectorXd right(index(n_ + rows_.size()));
  for (std::size_t i = 0; i < n_; ++i) right[index(i)] = -balance_.value(i);
  for (std::size_t k = 0; k < rows_.size(); ++k) right[index(n_ + k)] = -accelerations_.value(rows_[k]);
  const VectorXd x = unscaled(right);
  if (!x.allFinite()) return PointStatus::NonFinite;
  for (std::size_t i = 0; i < n_; ++i) point_[functions_.a_at(i)] = x[index(i)];
  for (std::size_t k = 0; k < rows_.size(); ++k) point_[functions_.lambda_at(rows_[k])] = x[index(n_ + k)];
  return PointStatus::Ok;
}

void PointSolver::derivatives(MatrixXd& by_q, MatrixXd& by_v) {
  full_balance_.linearize(point_);
  full_accelerations_.linearize(point_);
  const Index n = index(n_), r = index(rows_.size());
  MatrixXd moved(n + r, 2 * n), of_balance(n, 2 * n), of_rows(index(m_), 2 * n);
  full_balance_.block(0, of_balance);
  full_accelerations_.block(0, of_rows);
  moved.topRows(n) = of_balance;
  for (Index k = 0; k < r; ++k) moved.row(n + k) = of_rows.row(index(rows_[static_cast<std::size_t>(k)]));
  const MatrixXd solved = scale_.asDiagonal() * factored_.solve(MatrixXd(scale_.asDiagonal() * moved));
  by_q = -solved.topLeftCorner(n, n);
  by_v = -solved.topRightCorner(n, n);
}

MatrixXd PointSolver::mobility() const {
  const Index n = index(n_), r = index(rows_.size());
  MatrixXd forces = MatrixXd::Zero(n + r, n);
  forces.topRows(n).setIdentity();
  return (scale_.asDiagonal() * factored_.solve(MatrixXd(scale_.asDiagonal() * forces))).topRows(n);
}

bool PointSolver::move_onto(LinearizedRows& rows, std::span<double> changed, std::size_t first) {
  double last = std::numeric_limits<double>::infinity(), first_move = 0;
  for (int turn = 0; turn < 20; ++turn) {
    const auto values = rows.values(point_);
    VectorXd right = VectorXd::Zero(index(n_ + rows_.size()));
    for (std::size_t k = 0; k < rows_.size(); ++k) right[index(n_ + k)] = -values[rows_[k]];
    const VectorXd move = unscaled(right).head(index(n_));
    const double size = move.cwiseQuotient(scale_.head(index(n_))).norm();
    if (!std::isfinite(size)) return false;
    // The constraints are met to rounding when the corrections no longer shrink; while they are large, that is a
    // failure.
    const Eigen::Map<const VectorXd> now(changed.data(), index(n_));
    const double rounding = 1e-10 * now.cwiseQuotient(scale_.head(index(n_))).norm();
    if (size == 0 || size >= 0.5 * last) return size <= std::max(1e-3 * first_move, rounding);
    for (std::size_t i = 0; i < n_; ++i) point_[first + i] = changed[i] += move[index(i)];
    if (turn == 0) first_move = size;
    last = size;
  }
  return false;
}

bool PointSolver::project(double t, std::span<double> q, std::span<double> v) {
  if (m_ == 0) return true;
  set_point(t, q, v);
  if (factor() != PointStatus::Ok) return false;
  return move_onto(positions_, q, 0) && move_onto(rates_, v, functions_.v_at(0));
}

/// |A| |q̇| over the step, by Cauchy and Schwarz in the metric of the diagonal of M; coordinates without inertia count
/// by themselves.
double PointSolver::constraint_residual(double h) {
  double largest = 0;
  if (m_ == 0) return largest;
  scales_work_.evaluate(point_, scales_);
  const auto phi = positions_.values(point_), rates = rates_.values(point_);
  const auto ratio = [](double value, double scale) { return value == 0 ? 0.0 : std::abs(value) / scale; };
  for (std::size_t k = 0; k < m_; ++k) {
    double motion = 0, gradient = 0, rest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double a = a_matrix_(index(k), index(i)), mass = mass_(index(i), index(i));
      const double speed = std::abs(point_[functions_.v_at(i)]) + std::abs(h * point_[functions_.a_at(i)]);
      if (mass > 0)
        motion += mass * speed * speed, gradient += a * a / mass;
      else
        rest += std::abs(a) * speed;
    }
    const double rate = std::sqrt(motion * gradient) + rest;
    largest =
        std::max({largest, ratio(phi[k], scales_[k] + std::abs(h) * rate), ratio(rates[k], scales_[m_ + k] + rate)});
  }
  return largest;
}

void PointSolver::make_tangent(std::span<double> dq, std::span<double> dv) {
  if (m_ == 0) return;
  for (std::span<double> d : {dq, dv}) {
    const Eigen::Map<VectorXd> vector(d.data(), index(n_));
    VectorXd right = VectorXd::Zero(index(n_ + rows_.size()));
    for (std::size_t k = 0; k < rows_.size(); ++k) right[index(n_ + k)] = -a_matrix_.row(index(rows_[k])).dot(vector);
    const VectorXd move = unscaled(right);
    for (std::size_t i = 0; i < n_; ++i) d[i] += move[index(i)];
  }
}

}  // namespace maupertuis
