#include "integrator/stiff/force_check.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::stiff {
namespace {

constexpr double unseen_errors = 10;  // of a step: what the unseen part of forces may do
constexpr double newton = 0.4;        // of h, the factor of the rates in Newton's matrix at high order
constexpr double pi = 3.14159265358979323846;

}  // namespace

ForceCheck::ForceCheck(Motion& motion)
    : motion_(motion),
      search_(motion.functions.balance.values, motion.parameters),
      inputs_(motion.functions.inputs()),
      path_(StepSearch::path_points * inputs_),
      state_(motion.states()),
      allowed_(motion.freedoms()),
      fitted_(motion.freedoms()),
      rest_(motion.freedoms()) {}

bool ForceCheck::sees_all(const RadauMethod& method, double begin, double end, std::span<const double> y) {
  if (!motion_.solve(end, y)) return true;  // the next step tells
  find_effect(std::abs(end - begin));
  for (std::size_t i = 0; i < allowed_.size(); ++i)
    allowed_[i] = std::max(motion_.velocity_error(i), method.rounding_of_velocity(i));
  follow(method, begin, end);
  fit(method.degree());
  const auto small = [&](std::span<const double> tails) { return is_small(tails, 0.1); };
  const auto visit = [&](double x, double, std::span<const double> forces, bool) {
    std::copy(forces.begin(), forces.end(), rest_.begin());
    const auto expected = fitted(x);
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = std::abs(rest_[i] - expected[i]);
    return is_small(rest_, 1);
  };
  return search_.visit(small, visit) == StepSearch::Outcome::Seen;
}

/// q and v of the step's polynomials; a and λ of the last solve.
void ForceCheck::follow(const RadauMethod& method, double begin, double end) {
  const auto point = motion_.at_point.point();
  const auto& x = StepSearch::path_nodes();
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double t = 0.5 * (begin + end) + 0.5 * x[j] * (end - begin);
    const std::span<double> out(&path_[j * inputs_], inputs_);
    std::copy(point.begin(), point.end(), out.begin());
    method.interpolate_at(0.5 + 0.5 * x[j], state_);
    std::copy_n(state_.begin(), 2 * motion_.freedoms(), out.begin());
    out.back() = t;
  }
  search_.set_path(path_);
}

/// h (1 − γh ∂a/∂v − (γh)² ∂a/∂q)⁻¹ ∂a/∂F: a stiff spring or damper gives way to a force no further than it lets it.
void ForceCheck::find_effect(double h) {
  motion_.at_point.derivatives(by_q_, by_v_);
  const double part = newton * h;
  const auto n = static_cast<Eigen::Index>(motion_.freedoms());
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) - part * by_v_ - part * part * by_q_;
  effect_ = (h * matrix.partialPivLu().solve(motion_.at_point.mobility())).cwiseAbs();
}

/// The polynomial of the step's order through the forces at Chebyshev's points.
void ForceCheck::fit(int order) {
  const auto count = static_cast<std::size_t>(std::max(1, order)) + 1;
  nodes_.resize(count);
  at_nodes_.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    nodes_[j] = -std::cos(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(count));
    const auto values = search_.values_at(nodes_[j]);
    at_nodes_[j].assign(values.begin(), values.end());
  }
}

std::span<const double> ForceCheck::fitted(double x) {
  std::fill(fitted_.begin(), fitted_.end(), 0.0);
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    double basis = 1;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if (k != j) basis *= (x - nodes_[k]) / (nodes_[j] - nodes_[k]);
    for (std::size_t i = 0; i < fitted_.size(); ++i) fitted_[i] += basis * at_nodes_[j][i];
  }
  return fitted_;
}

bool ForceCheck::is_small(std::span<const double> forces, double share) const {
  for (std::size_t i = 0; i < forces.size(); ++i) {
    double change = 0;
    for (std::size_t j = 0; j < forces.size(); ++j) {
      const double effect = effect_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (effect != 0) change += effect * forces[j];
    }
    if (!(change <= share * unseen_errors * allowed_[i])) return false;
  }
  return true;
}

}  // namespace maupertuis::stiff
