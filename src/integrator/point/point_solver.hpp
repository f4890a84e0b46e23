#pragma once
#include "linear_algebra/dense.hpp"

#include <maupertuis/motion_functions.hpp>

#include <span>
#include <vector>

namespace maupertuis {

/// Values of a DifferentiableKernel and its derivatives by blocks of columns.
class LinearizedRows {
 public:
  LinearizedRows(const DifferentiableKernel& kernel, std::span<const double> parameters);
  /// Values alone, or with derivatives. The result stays until the next call.
  std::span<const double> values(std::span<const double> point);
  void linearize(std::span<const double> point);
  double value(std::size_t row) const { return out_[row]; }
  /// ∂ values / ∂ point[first .. first + block.cols()), written into `block` (what vanishes identically is set to 0).
  void block(std::size_t first, Eigen::Ref<Eigen::MatrixXd> block) const;
  bool finite() const;

 private:
  DifferentiableKernel kernel_;
  FunctionWorkspace values_work_, all_work_;
  std::vector<double> out_;  // [rows + entries]
};

enum class PointStatus { Ok, Singular, NonFinite };

/// The motion at one point: q̈ and λ from the bordered system, with the derivatives that an implicit method needs.
///
///     | M  −Aᵀ | | a |   | −h |
///     | A   0  | | λ | = |  b |
///
/// Rows and columns are scaled by the diagonal of M. Where rows of A depend on each other (redundant constraints) an
/// independent subset is chosen by pivoting, once, and again only when it stops being independent; the motion does not
/// depend on the choice; the multipliers of the other rows are 0.
class PointSolver {
 public:
  PointSolver(const MotionFunctions& functions, std::span<const double> parameters);

  /// Chooses the rows anew.
  void forget_rows() { rows_chosen_ = false; }
  PointStatus solve(double t, std::span<const double> q, std::span<const double> v);
  std::span<const double> a() const { return {&point_[functions_.a_at(0)], functions_.freedoms}; }
  std::span<const double> lambda() const {
    return {&point_[functions_.a_at(0)] + functions_.freedoms, functions_.constraints};
  }
  /// Whether the equations determine λ_k: no dependence between rows of A involves row k.
  bool determined(std::size_t k) const { return determined_[k]; }
  /// The point (q, v, a, λ, t) of the last solve, for other kernels.
  std::span<const double> point() const { return point_; }
  const std::vector<std::size_t>& rows() const { return rows_; }
  /// After solve: ∂a/∂q and ∂a/∂v, [n × n] each.
  void derivatives(Eigen::MatrixXd& by_q, Eigen::MatrixXd& by_v);
  /// After solve: ∂a/∂F for forces F beside the balance, [n × n].
  Eigen::MatrixXd mobility() const;
  /// Moves (q, v) by the least kinetic change onto φ = 0, then rates = 0, to rounding. False if it does not converge.
  /// Costs one solve, and nothing without constraints.
  bool project(double t, std::span<double> q, std::span<double> v);
  /// After solve: the largest of φ and the rates, each by the sizes of its terms and by what a motion over h does to
  /// it.
  double constraint_residual(double h);
  /// Takes out of (dq, dv) what is normal to the constraints at the point of the last solve.
  void make_tangent(std::span<double> dq, std::span<double> dv);

 private:
  PointStatus factor();
  void choose_rows();
  bool move_onto(LinearizedRows& rows, std::span<double> changed, std::size_t first);
  void set_point(double t, std::span<const double> q, std::span<const double> v);
  /// The solution of the bordered system for a right side [n + rows].
  Eigen::VectorXd unscaled(const Eigen::VectorXd& right) const;

  MotionFunctions functions_;
  LinearizedRows balance_, accelerations_;            // with derivatives by a and λ
  LinearizedRows full_balance_, full_accelerations_;  // … by q and v too
  LinearizedRows rates_, positions_;
  FunctionWorkspace scales_work_;
  std::size_t n_, m_;
  std::vector<double> point_;
  std::vector<double> scales_;  // [2m]
  bool rows_chosen_ = false;
  std::vector<std::size_t> rows_;  // independent constraints
  std::vector<bool> determined_;   // [m]
  Eigen::MatrixXd mass_, to_forces_, a_matrix_, bordered_;
  Eigen::VectorXd scale_;  // [n + rows]
  Eigen::PartialPivLU<Eigen::MatrixXd> factored_;
};

}  // namespace maupertuis
