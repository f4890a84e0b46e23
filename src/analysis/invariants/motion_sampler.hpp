#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include "analysis/invariants/field_linear_algebra.hpp"
#include "analysis/invariants/given_numbers.hpp"
#include "symbolic/evaluate/stale_nodes.hpp"

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace maupertuis::invariants {

/// In q, q', q'', t and parameters alone: inputs and definitions put in, each d/dt carried out.
ExprVector in_state_variables(const MechanicalSystem& system, const ExprVector& v);

/// The rows that determine the motion, in q, q', t and parameters alone (inputs and definitions put in):
///     M q̈ − Aᵀλ = −h,   A q̈ = b,   and for the velocities A q̇ = a₀.
struct MotionRows {
  std::shared_ptr<const MechanicalSystem> system;
  ExprMatrix mass;            // M [n × n]
  ExprVector bias;            // h [n]
  ExprMatrix constraint;      // A [m × n], in q, t alone
  ExprVector acceleration;    // b [m]
  ExprVector velocity;        // a₀ [m]
  ExprMatrix reaction;        // in the place of Aᵀ [n × m], where it is another one; else empty
  bool conservative = false;  // without Q and ∂D/∂q̇, and without constraints
};
/// Accelerations that nothing determines are symbols of their own: what is conserved is so whatever they are.
MotionRows motion_rows(const EquationsOfMotion& equations);
/// Of L alone: forces, dissipation and constraints left out.
MotionRows conservative_rows(const EquationsOfMotion& equations);
/// d/dt ∂L/∂q̇ − ∂L/∂q [n].
ExprVector conservative_residual(const EquationsOfMotion& equations);
/// Whether A holds velocities: constraints that are not linear in them.
bool is_nonlinear_in_velocities(const EquationsOfMotion& equations);

/// Values of the parameters: each the square of a root that is itself a square, so that √(k/m) exists and is a
/// fraction of roots.
using ParameterRoots = std::vector<Value>;  // [parameters]

/// Values of functions, and of their rates along the motion, at random points of (q, q', t) over one prime field.
/// q̇ is drawn on the velocity constraints (those of positions differentiated), q̈ and λ are solved over the field.
class MotionSampler {
 public:
  struct Sample {
    std::vector<Value> values, rates;  // [functions]; rates empty unless asked for
    std::vector<Value> velocities;     // [n]
  };
  /// `functions` in q, q', t, parameters, inputs, definitions.
  MotionSampler(const MotionRows& rows, std::vector<Expr> functions, bool with_rates, std::uint64_t seed);

  MotionSampler(const MotionSampler&) = delete;  // its numbers refer to its hints

  const PrimeField& field() const;
  const std::vector<Expr>& parameters() const { return parameters_; }
  ParameterRoots draw_parameters();
  /// Such that a point can be drawn; nothing after some attempts: roots of parameters alone may have no value.
  std::optional<ParameterRoots> usable_parameters();
  /// Where no point is found at which all roots exist, roots are numbers of their own from then on. Nothing where the
  /// accelerations are not determined.
  std::optional<Sample> draw(const ParameterRoots& roots);
  /// Whether accelerations were not determined at the points that were met.
  bool singular() const { return singular_; }
  /// Nodes that a point takes to evaluate.
  std::size_t nodes() const { return tape_->size(); }

 private:
  void bind_parameters(const ParameterRoots& roots);
  void find_orders();
  void evaluate_again(int from_order);
  bool bind_velocities();
  bool bind_accelerations();
  Sample collect() const;
  std::optional<Sample> attempt(const ParameterRoots& roots);

  std::shared_ptr<const MechanicalSystem> system_;
  std::size_t n_, m_, functions_;
  bool with_rates_, singular_ = false;
  bool own_reaction_ = false;   // Aᵀ is not that of the constraints
  bool lost_in_roots_ = false;  // the last point was given up, for roots of what is negative
  // The first root of A, a₀, and with rates of M, h, b and dB/dt; the functions themselves come first.
  std::size_t constraint_ = 0, reaction_ = 0, velocity_ = 0, mass_ = 0, bias_ = 0, acceleration_ = 0, rates_ = 0;
  std::vector<Expr> parameters_;
  std::unique_ptr<evaluation::Tape> tape_;
  std::unique_ptr<evaluation::StaleNodes> stale_;
  std::vector<Value> at_;                    // [nodes] values at the point
  std::vector<std::uint8_t> parametric_;     // [nodes] holds parameters alone
  std::vector<std::uint8_t> highest_order_;  // [nodes] of the coordinates below: 0, 1, 2; what a solved q̇ or q̈ changes
  evaluation::FieldHints hints_;
  std::unique_ptr<GivenNumbers> numbers_;
  std::uint64_t seed_;
};

}  // namespace maupertuis::invariants
