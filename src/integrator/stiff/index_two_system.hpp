#pragma once
#include "integrator/stiff/motion.hpp"

namespace maupertuis::stiff {

/// The index-2 form of Gear, Gupta and Leimkuhler, F(t, y, ẏ) = 0 with y = (q, v, λ, μ):
///
///     q̇ − v − Aᵀμ = 0,   M v̇ + h − Aᵀλ = 0,   dφ/dt or ψ = 0,   φ = 0
///
/// For a constraint between velocities the last row is μ = 0; for redundant constraints the last two are λ = 0 and μ =
/// 0.
class IndexTwoSystem {
 public:
  explicit IndexTwoSystem(const Motion& motion);

  std::size_t size() const { return 2 * (n_ + m_); }
  /// The constraints that take part, [independent rows] of the motion's own choice.
  void set_rows(std::span<const std::size_t> rows);
  /// False where a value is infinite or undefined.
  bool residual(double t, std::span<const double> y, std::span<const double> rate, std::span<double> out);
  /// ∂F/∂ẏ and ∂F/∂y, [size × size] each.
  bool derivatives(double t, std::span<const double> y, std::span<const double> rate, Eigen::MatrixXd& by_rate,
                   Eigen::MatrixXd& by_state);

 private:
  /// (q, v, a = v̇, λ, t)
  void set_point(double t, std::span<const double> y, std::span<const double> rate);

  const MotionFunctions& functions_;
  std::size_t n_, m_;
  LinearizedRows balance_, rates_, positions_, accelerations_;  // the last for A alone
  std::vector<bool> velocity_row_, position_row_;               // [m] whether λ and μ of a row are unknowns
  std::vector<double> point_;
  Eigen::MatrixXd a_, block_, moved_;
};

}  // namespace maupertuis::stiff
