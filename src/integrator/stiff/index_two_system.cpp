#include "integrator/stiff/index_two_system.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::stiff {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Index index(std::size_t i) { return static_cast<Index>(i); }

}  // namespace

IndexTwoSystem::IndexTwoSystem(const Motion& motion)
    : functions_(motion.functions),
      n_(functions_.freedoms),
      m_(functions_.constraints),
      balance_(functions_.balance, motion.parameters),
      rates_(functions_.rates, motion.parameters),
      positions_(functions_.positions, motion.parameters),
      accelerations_(functions_.accelerations_by_unknowns, motion.parameters),
      velocity_row_(m_),
      position_row_(m_),
      point_(functions_.inputs()),
      a_(m_, n_) {}

void IndexTwoSystem::set_rows(std::span<const std::size_t> rows) {
  velocity_row_.assign(m_, false);
  position_row_.assign(m_, false);
  for (const std::size_t k : rows) velocity_row_[k] = true;
  // What is no constraint between positions is 0 there, without derivatives.
  for (const JacobianEntry& entry : functions_.positions.entries) position_row_[entry.row] = velocity_row_[entry.row];
}

void IndexTwoSystem::set_point(double t, std::span<const double> y, std::span<const double> rate) {
  const auto v_rate = rate.subspan(n_, n_), lambda = y.subspan(2 * n_, m_);
  auto end = std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(2 * n_), point_.begin());
  end = std::copy(v_rate.begin(), v_rate.end(), end);
  std::copy(lambda.begin(), lambda.end(), end);
  point_.back() = t;
}

bool IndexTwoSystem::residual(double t, std::span<const double> y, std::span<const double> rate,
                              std::span<double> out) {
  set_point(t, y, rate);
  const auto lambda = y.subspan(2 * n_, m_), mu = y.subspan(2 * n_ + m_, m_);
  accelerations_.linearize(point_);
  accelerations_.block(functions_.a_at(0), a_);
  const VectorXd normal = a_.transpose() * Eigen::Map<const VectorXd>(mu.data(), index(m_));
  for (std::size_t i = 0; i < n_; ++i) out[i] = rate[i] - y[n_ + i] - normal[index(i)];
  const auto balance = balance_.values(point_);
  std::copy(balance.begin(), balance.end(), out.begin() + static_cast<std::ptrdiff_t>(n_));
  const auto rates = rates_.values(point_), positions = positions_.values(point_);
  for (std::size_t k = 0; k < m_; ++k) {
    out[2 * n_ + k] = velocity_row_[k] ? rates[k] : lambda[k];
    out[2 * n_ + m_ + k] = position_row_[k] ? positions[k] : mu[k];
  }
  return std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); });
}

bool IndexTwoSystem::derivatives(double t, std::span<const double> y, std::span<const double> rate,
                                 Eigen::MatrixXd& by_rate, Eigen::MatrixXd& by_state) {
  const Index n = index(n_), m = index(m_);
  set_point(t, y, rate);
  accelerations_.linearize(point_);
  accelerations_.block(functions_.a_at(0), a_);
  balance_.linearize(point_);
  rates_.linearize(point_);
  positions_.linearize(point_);
  by_rate.setZero(index(size()), index(size()));
  by_state.setZero(index(size()), index(size()));
  by_rate.topLeftCorner(n, n).setIdentity();
  balance_.block(functions_.a_at(0), by_rate.block(n, n, n, n));
  balance_.block(0, by_state.block(n, 0, n, 2 * n));
  balance_.block(functions_.lambda_at(0), by_state.block(n, 2 * n, n, m));
  rates_.block(0, by_state.block(2 * n, 0, m, 2 * n));
  positions_.block(0, by_state.block(2 * n + m, 0, m, n));
  for (Index k = 0; k < m; ++k) {
    const auto set_to_zero = [&](Index row) {
      by_state.row(row).setZero();
      by_state(row, row) = 1;
    };
    if (!velocity_row_[static_cast<std::size_t>(k)]) set_to_zero(2 * n + k);
    if (!position_row_[static_cast<std::size_t>(k)]) set_to_zero(2 * n + m + k);
  }
  // −∂(Aᵀμ)/∂q is what μ added to λ changes in the derivatives of the balance.
  moved_ = by_state.block(n, 0, n, n);
  for (std::size_t k = 0; k < m_; ++k) point_[functions_.lambda_at(k)] += y[2 * n_ + m_ + k];
  balance_.linearize(point_);
  block_.resize(n, n);
  balance_.block(0, block_);
  by_state.block(0, 0, n, n) = block_ - moved_;
  by_state.block(0, n, n, n).diagonal().setConstant(-1);
  by_state.block(0, 2 * n + m, n, m) = -a_.transpose();
  return by_rate.allFinite() && by_state.allFinite();
}

}  // namespace maupertuis::stiff
