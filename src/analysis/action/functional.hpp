#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/function_kernel.hpp>

#include <eigen3/Eigen/Core>
#include <optional>
#include <vector>

namespace maupertuis::action {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// What stands below the integral at a point: F = L + Σ λ_k G_k, and each G_k. Derivatives are by (q, q').
struct Density {
  double lagrangian = 0;
  Vector integrals;             // [k] G
  Vector gradient;              // [2n] of F
  Matrix integral_gradients;    // [2n × k]
  Matrix hessian;               // [2n × 2n] of F
  bool finite = true;
};

/// The functions of an action problem in numbers, with exact derivatives.
class Functional {
 public:
  explicit Functional(const EquationsOfMotion& equations);

  Index freedoms() const { return n_; }
  Index integrals() const { return k_; }
  Index constraints() const { return r_; }
  const Vector& wanted() const { return wanted_; }  // [k] the values of ∫ G
  bool explicit_time() const { return explicit_time_; }

  /// order 0: values; 1: and gradients; 2: and the Hessian.
  void evaluate(double t, const double* q, const double* v, const Vector& multipliers, int order, Density& out);

  /// φ [r], ∂φ/∂q [r × n].
  void constraints_at(double t, const Vector& q, Vector& values, Matrix& rows);
  /// Σ μ_i ∂²φ_i/∂q∂q [n × n].
  Matrix constraint_curvature(double t, const Vector& q, const Vector& mu);

 private:
  struct Order {
    FunctionKernel kernel;
    std::optional<FunctionWorkspace> work;
    std::vector<double> out;
  };
  void build_density(const EquationsOfMotion& equations);
  void build_constraints(const EquationsOfMotion& equations);
  void prepare(Order& order, const FunctionSource& source);

  Index n_ = 0, k_ = 0, r_ = 0;
  bool explicit_time_ = false;
  Vector wanted_;
  std::vector<double> parameters_, in_, constraint_in_;
  Order density_[3], positions_, curvature_;
  std::vector<std::pair<Index, Index>> entries_;                 // of the Hessian, upper triangle
  std::vector<std::pair<Index, Index>> position_entries_, curvature_entries_;
};

}  // namespace maupertuis::action
