#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/function_kernel.hpp>

#include <cmath>
#include <eigen3/Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace maupertuis::action {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// What stands below the integral at a point: F = L + Σ λ_k G_k, and each G_k. Derivatives are by (q, q').
struct Density {
  double lagrangian = 0;
  Vector integrals;           // [k] G
  Vector gradient;            // [2n] of F
  Matrix integral_gradients;  // [2n × k]
  Matrix hessian;             // [2n × 2n] of F
  bool finite = true;
};

/// By how much rounding in its parts can change L + Σ |λ_k| |G_k|, in units of the rounding of one operation.
struct Sensitivity {
  double terms = 0;   // Σ |terms|
  Vector by_q, by_v;  // [n] derivatives, absolute values
  double by_time = 0;
};

constexpr double rounding_unit = 1.1102230246251565e-16;  // of one operation

/// A sum with the rounding of one addition (Neumaier).
class ExactSum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0, rest_ = 0;
};

/// Where q'' stands in L, coordinates are (q, v, p) of L* = L(q, v, v') + p (q' − v). Of others all are `tops`.
struct OrderOfCoordinates {
  explicit OrderOfCoordinates(const MechanicalSystem& system);

  std::vector<Index> configurations;           // all but p: what the ends of a path fix, and δq of Jacobi fields
  std::vector<Index> tops;                     // the v, and coordinates without q'': those with a velocity term in L*
  std::vector<std::pair<Index, Index>> rates;  // (q, v): places among the configurations and the tops
  std::vector<Index> bases, rates_of_others;   // the q of the v, and the v
  std::vector<Index> momenta;                  // the p

  bool higher() const { return !momenta.empty(); }
};

/// The functions of an action problem in numbers, with exact derivatives.
class Functional {
 public:
  explicit Functional(const EquationsOfMotion& equations);

  Index freedoms() const { return n_; }
  Index integrals() const { return k_; }
  Index constraints() const { return r_; }
  const OrderOfCoordinates& orders() const { return orders_; }
  const Vector& wanted() const { return wanted_; }  // [k] the values of ∫ G
  bool explicit_time() const { return explicit_time_; }

  /// order 0: values; 1: and gradients; 2: and the Hessian.
  void evaluate(double t, const double* q, const double* v, const Vector& multipliers, int order, Density& out);

  /// What rounding at a point does to the density.
  Sensitivity sensitivity(double t, const double* q, const double* v, const Vector& multipliers);

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
  void build_sizes(const FunctionSource& density, const ExprVector& functions, Expr time);
  void build_constraints(const EquationsOfMotion& equations);
  void prepare(Order& order, const FunctionSource& source);

  Index n_ = 0, k_ = 0, r_ = 0;
  OrderOfCoordinates orders_;
  bool explicit_time_ = false;
  Vector wanted_;
  std::vector<double> parameters_, in_, constraint_in_;
  Order density_[3], sizes_, positions_, curvature_;
  std::vector<std::pair<Index, Index>> entries_;  // of the Hessian, upper triangle
  Density density_here_;
  std::vector<std::pair<Index, Index>> position_entries_, curvature_entries_;
};

}  // namespace maupertuis::action
