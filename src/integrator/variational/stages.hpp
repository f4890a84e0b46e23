#pragma once
#include "integrator/dense_output/dense_output.hpp"
#include "integrator/point/point_solver.hpp"
#include "integrator/variational/tableau.hpp"
#include "linear_algebra/dense.hpp"

#include <limits>
#include <span>
#include <vector>

namespace maupertuis::variational {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double singular = 1e-15;  // reciprocal condition of a scaled matrix
inline constexpr int most_iterations = 60;

/// Scales rows and columns of m by their largest entries, so that units do not decide what is small.
void equilibrate(Eigen::MatrixXd& m, Eigen::VectorXd& rows, Eigen::VectorXd& columns);

/// A point of the discrete motion: what one step begins and ends with.
struct Phase {
  double t = 0;
  std::vector<Compensated> q, p;  // [n]
  std::vector<double> v;          // [n] of p = ∂L/∂v, on the constraints
};

enum class StageStatus { Ok, Singular, NonFinite, NoConvergence };

/// The discrete Euler-Lagrange equations of one step, in the velocities V_i and multipliers Λ_i at the nodes.
///
///     Q_i = q₀ + h Σ_j a_ij V_j,     ∂L/∂v(Q_i,V_i) = p₀ + h Σ_j â_ij (∂L/∂q + F + AᵀΛ)_j,     φ(Q_i) = 0, i ≥ 2
///     q₁ = q₀ + h Σ_j b_j V_j,       p₁ = p₀ + h Σ_j b_j (∂L/∂q + F + AᵀΛ)_j,                  φ̇(q₁,v₁) = 0
///
/// Simplified Newton iteration until the corrections stop shrinking: to rounding. Sums are in long double.
class StageSolver {
 public:
  StageSolver(const VariationalFunctions& functions, std::span<const double> parameters, Tableau tableau);

  /// Constraints that are taken into account.
  void set_rows(const std::vector<std::size_t>& rows);
  /// What the iteration begins from: V_i = v + c_i h a, Λ_i = λ.
  void guess(double h, std::span<const double> v, std::span<const double> a, std::span<const double> lambda);
  /// The same from the last step solved, of length h_last: its polynomials carried on to [begin, begin +
  /// length]·h_last.
  void extrapolate(const StageSolver& last, long double begin, long double length);
  StageStatus solve(const Phase& begin, double h, double end_time, Phase& end);
  /// p = ∂L/∂v; where rows are given, v is on the constraints.
  void momenta(double t, std::span<const double> q, std::span<const double> v, std::span<double> p);

  const Tableau& tableau() const { return tableau_; }
  /// V at node i; its polynomial at the fraction x of the step; q there, from the point that the step began at.
  double velocity(std::size_t i, std::size_t component) const { return velocities_(index(component), index(i)); }
  double velocity_at(long double x, std::size_t component) const;
  double position_at(long double x, std::size_t component) const;
  /// The point (q, v, 0, λ, t) of node i, for other kernels.
  std::span<const double> node_point(std::size_t i);
  int iterations() const { return iterations_; }

 private:
  struct NodeDerivatives {
    Eigen::MatrixXd p_q, p_v, f_q, f_v;  // [n × n]
    Eigen::MatrixXd f_lambda, phi_q;     // [n × rows], [rows × n]
  };
  /// Sizes in the metric of the diagonal of M: of a correction, of the velocities, of what rounding of q does to them.
  struct Correction {
    double size = 0, speed = 0, resolution = 0;
  };

  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  bool constrained() const { return !rows_.empty(); }
  std::size_t unknowns() const { return s_ * n_ + (s_ - 1) * rows_.size(); }

  void place_nodes();
  /// The residual of the stage equations at the present V, Λ; false where it is not finite.
  bool residual();
  bool linearize_nodes();
  bool jacobian();
  Correction apply(const Eigen::VectorXd& change);
  StageStatus iterate();
  StageStatus finish(double end_time, Phase& end);
  StageStatus end_velocity(Phase& end);
  Eigen::MatrixXd normals_at(std::span<const double> point);
  bool legendre_equations(std::span<const double> point, const Phase& end, const Eigen::MatrixXd& normals,
                          const Eigen::VectorXd& impulse, Eigen::MatrixXd& matrix, Eigen::VectorXd& right);
  void fill_point(std::size_t i);

  VariationalFunctions functions_;
  LinearizedRows momenta_, forces_, positions_, rates_;
  Tableau tableau_;
  std::size_t n_, m_, s_;
  std::vector<std::size_t> rows_;
  std::vector<double> point_, point_end_;

  const Phase* begin_ = nullptr;  // while a step is being solved
  double t_begin_ = 0, h_ = 0, factored_h_ = 0;
  Eigen::MatrixXd positions_at_, velocities_, forces_at_;  // [n × s]
  Eigen::MatrixXd multipliers_;                            // [rows × s]
  std::vector<double> q_begin_;                            // [n]
  std::vector<NodeDerivatives> nodes_;                     // [s]
  Eigen::VectorXd residual_, weights_;                     // [unknowns]; [n] √|M_ii|
  Eigen::VectorXd row_scale_, column_scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factored_;
  bool have_factors_ = false;
  int iterations_ = 0;
};

}  // namespace maupertuis::variational
