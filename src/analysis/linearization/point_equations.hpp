#pragma once
#include "analysis/linearization/matrices.hpp"

#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/function_kernel.hpp>

namespace maupertuis {

/// Functions at a point and their derivatives by its parts.
struct RowsAtPoint {
  Vector value;  // [rows]
  Matrix by_q, by_v, by_a, by_multipliers;
  Matrix by_inputs;  // [rows × 3k] by u, u', u''
};

/// Of a sum of terms: what friction takes, positive.
struct Power {
  double value = 0, size = 0;
  bool is_given() const { return value < -1e-12 * size; }
};

struct PointEquations::Impl {
  Impl(const EquationsOfMotion& equations, std::span<const Expr> measured);

  /// One family of rows: a program and its workspaces.
  struct Rows {
    DifferentiableKernel kernel;
    FunctionWorkspace values, entries;
    explicit Rows(DifferentiableKernel k)
        : kernel(std::move(k)), values(kernel.values), entries(kernel.values_and_entries) {}
  };

  Vector value(Rows& rows, const OperatingPoint& point) const;
  RowsAtPoint at(Rows& rows, const OperatingPoint& point) const;
  double energy_at(const OperatingPoint& point);      // h_E
  std::vector<double> inputs_and_rates_at(double t);  // [3k] u, u', u''
  Power power_of_friction(const OperatingPoint& point);
  void set_parameters();

  std::shared_ptr<const MechanicalSystem> system;
  ExprVector balance_rows, measured;    // as expressions: for what a kernel cannot tell
  ExprVector kept_rows, momentum_rows;  // positions, velocities, relations; momenta
  std::size_t n, m, k, holonomic;       // holonomic: how many of the m are of positions
  std::vector<double> parameters;
  std::vector<std::size_t> position_rows;                       // which constraints those are
  Rows balance, positions, velocities, accelerations, momenta;  // [n], [holonomic], [m - holonomic], [m], [n]
  Rows resting;                                                 // the balance where q̇ = q̈ = 0: much shorter
  Rows rates;                                                   // [m] dφ/dt and ψ
  Rows relations;  // of a degenerate system: what every state obeys and motions keep without a row of their own
  Rows outputs;    // what is measured
  std::vector<bool> output_switches;  // whether abs, min, piecewise … stand in it
  FunctionKernel input_formulas;
  FunctionWorkspace inputs;
  FunctionKernel energy;  // h_E: orders equilibria
  FunctionWorkspace energy_workspace;
  FunctionWorkspace friction;  // [n] ∂D/∂q̇
  Rows energy_slopes;          // [n] ∂h_E/∂q, where L is of the first order and keeps h_E(q); else none
  bool is_autonomous() const;
  ExprVector rows_in_time;        // all rows, where the time stands in them, perhaps times a parameter that is 0
  bool has_energy = false;        // that no force changes while inputs are held, but for friction
  std::vector<bool> is_periodic;  // [n]
  std::vector<bool> turns_by_parameters;  // [n] whether a turn changes nothing depends on values of parameters

  mutable std::optional<bool> known_autonomous;  // at these values of parameters; looked for when it is asked
  mutable std::optional<CloseEvaluation> entries_of_balance;  // by rows, of q, q̇, q̈; made when it is asked for

 private:
  std::vector<double> gather(const OperatingPoint& point) const;
};

/// Every symbol that the rows of the equations hold, with its value there.
Bindings values_at(const PointEquations::Impl& e, const OperatingPoint& point);

/// The parameters as exact numbers: M = m/3 is that, and no rounding of it leaves a force.
ExprMap exact_parameters(const PointEquations::Impl& e);

/// A random point of moderate size: for ranks and periods.
OperatingPoint random_point(const PointEquations::Impl& e, std::uint64_t seed);

/// The size of a coordinate that counts as far: 1 for angles and numbers, else the largest parameter of its dimension,
/// or the largest start of such a coordinate.
std::vector<double> typical_sizes(const MechanicalSystem& system, const MotionState& start);

}  // namespace maupertuis
