#pragma once
#include "linear_algebra/dense.hpp"

#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/function_kernel.hpp>

#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis {

/// A row of ∂g/∂q or ∂v_t/∂q̇ without its zeros.
using SparseRow = std::vector<std::pair<std::size_t, double>>;

/// What contacts and frictions are at one point.
struct ContactValues {
  std::vector<double> gap, gap_scale;  // [contacts] g, Σ |terms of g|
  std::vector<double> rate, drive;     // [contacts] ġ, and its part ∂g/∂t
  std::vector<double> rate_scale;      // [contacts] Σ |∂g/∂q_i q̇_i| + |∂g/∂t|
  std::vector<SparseRow> normal;       // [contacts] ∂g/∂q
  std::vector<double> slip, slip_scale;  // [contacts + frictions] v_t, Σ |∂v_t/∂q̇_i q̇_i| + |rest|; 0 without friction
  std::vector<SparseRow> tangent;         // [contacts + frictions] ∂v_t/∂q̇
  std::vector<double> second_slip;        // [contacts] of friction in space the second component of v_t; else 0
  std::vector<SparseRow> second_tangent;  // [contacts] and its ∂v_t/∂q̇; else empty
  std::vector<double> kinetic, fixed;     // [contacts + frictions] μ and μ_s, or the limits of the force
  std::vector<double> restitution;        // [contacts]
  double t = 0;                           // of the point
};

/// Σ |terms|, those of sums that are factors too: 2 (b − x) is known no better than 2 b − 2 x.
Expr size_of_nested_terms(Expr e);

/// Functions of q, q̇, t and the parameters of a system, with its lets and inputs put in and derivatives carried out.
FunctionSource function_of_motion(const MechanicalSystem& system, const ExprVector& outputs);

/// The programs of what contacts and frictions are, and of M and A: for any number of runs and threads.
class ContactPrograms {
 public:
  /// `equations`: of the system with its contacts, none of them in force.
  /// Cost: the symbolic gradients of the gaps and of L.
  explicit ContactPrograms(const EquationsOfMotion& equations);

  std::size_t coordinates, constraints, contacts, frictions;  // frictions: those of contacts counted
  DifferentiableKernel gaps, slips;                           // by q; by q̇
  FunctionKernel rates, matrices;
  /// d²g/dt² and dv_t/dt without their terms in q̈. Cost of the first call: the second derivatives of all gaps.
  const FunctionKernel& drifts() const;

 private:
  std::shared_ptr<const MechanicalSystem> system_;
  mutable std::mutex guard_;
  mutable std::optional<FunctionKernel> drifts_;
};

/// The functions of contacts and frictions, and M and A, at points. Inputs: q, q̇, t.
class ContactFunctions {
 public:
  ContactFunctions(std::shared_ptr<const ContactPrograms> programs, std::span<const double> parameters);
  ContactFunctions(const EquationsOfMotion& equations, std::span<const double> parameters)
      : ContactFunctions(std::make_shared<const ContactPrograms>(equations), parameters) {}

  const ContactValues& at(double t, std::span<const double> q, std::span<const double> v);
  /// x [n × columns] of M x = rows, A x = 0: what impulses along `rows` change in q̇. M may be singular where A is not.
  /// `held`: rows h besides those of A, with h x = 0.
  Eigen::MatrixXd response(double t, std::span<const double> q, std::span<const double> v,
                           std::span<const SparseRow> rows, std::span<const SparseRow> held = {});
  /// ∂φ/∂q or ∂ψ/∂q̇ of the constraints of the system.
  std::vector<SparseRow> constraint_rows(double t, std::span<const double> q, std::span<const double> v);
  /// The shortest λ [constraints + held] with M `change` = `force` + (A, held)ᵀ λ: what constraints do where a force
  /// [n] changes q̈ [n].
  Eigen::VectorXd multipliers(double t, std::span<const double> q, std::span<const double> v,
                              const Eigen::VectorXd& change, const Eigen::VectorXd& force,
                              std::span<const SparseRow> held);
  /// What g̈ and v̇_t are where q̈ = 0: [contacts], then [contacts + frictions], then second components [contacts]. Cost
  /// of the first call: the second derivatives of all gaps.
  std::span<const double> drifts(double t, std::span<const double> q, std::span<const double> v);

 private:
  void evaluate(FunctionWorkspace& work, std::vector<double>& out, double t, std::span<const double> q,
                std::span<const double> v);

  std::shared_ptr<const ContactPrograms> programs_;
  std::vector<double> parameters_;
  std::size_t n_, m_, contacts_, frictions_;
  FunctionWorkspace gaps_work_, slips_work_, rates_work_, matrices_work_;
  std::optional<FunctionWorkspace> drifts_work_;
  std::vector<double> drifts_out_;
  std::vector<double> point_, gaps_out_, slips_out_, rates_out_, matrices_out_;
  double t_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> q_, v_;  // where values_ are
  ContactValues values_;
};

/// Whether impacts do not change it: no velocities, accelerations or forces stand in it.
bool is_of_positions(Expr function);

/// The coordinates (order 0) and velocities (order 1) that a function depends on.
struct StateRead {
  std::size_t coordinate;
  int order;
};
/// Nothing where accelerations or forces stand in it as well.
std::optional<std::vector<StateRead>> state_read_by(Expr function, const MechanicalSystem& system);

/// Whether it stays what it is, whatever moves.
bool is_of_parameters(Expr value);

inline Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
double dot(const SparseRow& row, const Eigen::VectorXd& x);
double product(const SparseRow& row, std::span<const double> x);
/// A row with its zeros.
std::vector<double> whole_row(const SparseRow& row, std::size_t n);
/// a + factor b
SparseRow sum_of(const SparseRow& a, const SparseRow& b, double factor);
/// |v_t| of a contact, in the plane or in space.
double slip_speed(std::size_t contact, const ContactValues& values);

}  // namespace maupertuis
