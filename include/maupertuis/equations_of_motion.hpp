#pragma once
#include <maupertuis/layout.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

struct DegenerateAnalysis;  // degenerate.hpp

/// Lagrange's equations of a system in two forms. Rows follow system.coordinates.
///
///     R(q,q̇,q̈,u,t) = d/dt ∂L/∂q̇ − ∂L/∂q + ∂D/∂q̇ − Q = M q̈ + h = Aᵀλ,   A q̈ = b
struct EquationsOfMotion {
  std::shared_ptr<const MechanicalSystem> system;
  ReadingOrder order;

  Expr lagrangian;                // computational form; may hold TimeDerivative nodes
  Expr lagrangian_expanded;       // in q, q', u, t alone
  ExprVector generalized_forces;  // Q [n], in q, q', u, t
  ExprVector dissipative_terms;   // ∂D/∂q̇ [n]
  ExprVector residual;            // R [n], computational form with d/dt as an operator; without Aᵀλ
  // With constraints, [m] in the order of system.constraints; empty without.
  ExprVector multipliers;               // λ, symbols
  ExprVector constraint_forces;         // Aᵀλ [n], by reverse mode
  ExprVector constraint_rates;          // dφ/dt or ψ; computational form
  ExprVector constraint_accelerations;  // d²φ/dt² or dψ/dt = A q̈ − b; computational form
  ExprVector momenta;                   // ∂L/∂q̇ [n], in q, q', u, t
  Expr energy_function;                 // h_E = q̇·∂L/∂q̇ − L
  Expr power;  // dh_E/dt along the motion: −∂L/∂t − q̇·∂D/∂q̇ + Q·q̇ + λ·A q̇

  /// The same with the symbols of parameter definitions kept (`let I = 1/2 m R^2`); null if the model has none.
  std::shared_ptr<const EquationsOfMotion> written;
  /// Where M is singular and the constraints of the model do not make up for it: equations of the same motion that
  /// determine all accelerations (degenerate.hpp). Runs and linearizations take them. Null for all other systems.
  std::shared_ptr<const EquationsOfMotion> determined;
  std::shared_ptr<const DegenerateAnalysis> degenerate;  // from which they are
  /// What is shown to a reader: `written` where it exists. Computations and proofs use *this.
  const EquationsOfMotion& shown() const { return written ? *written : *this; }
  /// R − Aᵀλ [n]: vanishes along the motion. What kernels lower.
  ExprVector balance() const;
};

/// Derives the computational form. Precondition: `system` passed the physics lint, which tells of a singular M.
/// Cost O(nodes of L).
std::optional<EquationsOfMotion> euler_lagrange(std::shared_ptr<const MechanicalSystem> system,
                                                Diagnostics& diagnostics);

/// M = ∂²L/∂q̇∂q̇ [n × n] and h [n]; in q, q', u, t. Cost O(n · cost of L).
ExprMatrix mass_matrix(const EquationsOfMotion& equations);
ExprVector bias(const EquationsOfMotion& equations);
/// A = ∂φ/∂q or ∂ψ/∂q̇ [m × n] and b [m] of A q̈ = b; in q, q', t. Cost O(m · cost of the constraints).
ExprMatrix constraint_matrix(const EquationsOfMotion& equations);
ExprVector constraint_bias(const EquationsOfMotion& equations);

/// q̈ = −M⁻¹ h as a shared DAG, by Gaussian elimination with division: O(n³) nodes, nothing expanded. For proofs (dI/dt
/// along the motion); runs solve with numbers instead. Nothing where M is singular as a function. The form that takes
/// the equations solves the bordered system where there are constraints.
std::optional<ExprVector> accelerations(const ExprVector& residual, const MechanicalSystem& system);
std::optional<ExprVector> accelerations(const EquationsOfMotion& equations);

/// q̈ [n] and λ [m] of the bordered system M q̈ + h = Aᵀλ, A q̈ = b in the same way; M may be singular. Nothing where the
/// bordered matrix is singular as a function of q and q̇, as it is with redundant constraints.
struct ConstrainedMotion {
  ExprVector accelerations, multipliers;
};
std::optional<ConstrainedMotion> accelerations_and_multipliers(const EquationsOfMotion& equations);
/// From R − Aᵀλ and A q̈ − b, of which the caller may have replaced symbols (inputs by their formulas).
std::optional<ConstrainedMotion> accelerations_and_multipliers(const ExprVector& balance,
                                                               const ExprVector& constraint_accelerations,
                                                               const MechanicalSystem& system);

/// Masses before g before lengths before rates, then as declared; coordinates as declared.
ReadingOrder reading_order(const MechanicalSystem& system);

/// What is conserved at a glance, without a search: cyclic coordinates and the energy function.
struct ConservedQuantities {
  std::vector<std::size_t> cyclic;             // coordinates absent from L
  std::vector<std::size_t> conserved_momenta;  // cyclic, and Q, ∂D/∂q̇ and Aᵀλ vanish
  bool energy_conserved = false;               // power ≡ 0, proved
  bool energy_is_t_plus_v = false;             // h_E ≡ T + V, proved
  std::string energy_case;                     // one sentence: why h_E is or is not T + V
};
ConservedQuantities conserved_quantities(const EquationsOfMotion& equations);

/// One line of the textbook derivation.
struct DerivationStep {
  std::string section;                      // "Coordinates", "Kinetic energy", "∂L/∂q̇", …
  std::string rule;                         // "chain rule", "definition of L", "Euler-Lagrange"
  Layout left;                              // d/dt ∂L/∂θ1'; empty if the step is a sentence alone
  Expr right;                               // readable; empty if the step is a sentence alone
  std::string sentence;                     // shown instead of, or after, the formula
  std::vector<Intermediate> intermediates;  // that `right` uses

  /// 0 = right, which is read as right = 0.
  bool is_equation() const { return left.shape == Shape::Number && left.text == "0"; }
};

/// A constraint as two sides whose difference is φ or ψ, term by term as the model has them.
struct ConstraintEquation {
  std::string name;  // `rod`; "constraint 2" where it has none
  Expr left, right;
};

struct Derivation {
  std::vector<DerivationStep> steps;
  std::vector<ReadableForm> equations;          // row i: equations[i].value = 0, or = constraint_forces[i].value
  std::vector<ReadableForm> constraint_forces;  // (Aᵀλ)[i], collected by multipliers; empty without constraints
  std::vector<ConstraintEquation> constraints;
  std::vector<Intermediate>
      intermediates;  // the legend: definitions of the model that are used, then named sub-expressions
};

/// The equations in readable form (steps left empty), and with the textbook path.
Derivation readable_derivation(const EquationsOfMotion& equations, bool with_steps);

/// The definitions of the model (`let I = 1/2 m R^2`) whose symbols stand in `roots`, in the order of the text: the
/// legend.
std::vector<Intermediate> definitions_used(const MechanicalSystem& system, std::span<const Expr> roots);

/// One block of the equations solved for its accelerations. Coordinates that M does not couple are separate blocks.
struct SolvedAcceleration {
  std::size_t coordinate = 0;
  ReadableForm right;                     // q̈ = right; an empty handle where the block is too large to be written out
  std::vector<std::size_t> coupled_with;  // the coordinates of its block, itself included
};

/// q̈ by Cramer's rule for blocks of at most two coordinates, and for those of up to six where each right side takes no
/// more than 400 characters; longer or singular blocks are left to the numerical solve. With constraints in terms of λ.
std::vector<SolvedAcceleration> solved_accelerations(const EquationsOfMotion& equations);

/// λ = (A M⁻¹ F)⁻¹ (b + A M⁻¹ h) [m] with F = Aᵀ − ∂h/∂λ (friction may be made of λ; h is without it), for at most two
/// constraints on coordinates as in solved_accelerations; else empty.
std::vector<ReadableForm> solved_multipliers(const EquationsOfMotion& equations);

/// The equations with the multipliers eliminated: Zᵀ(M q̈ + h) = 0 with Zᵀ F = 0, a row for each independent
/// acceleration; F and h as for solved_multipliers, so that Zᵀ F = 0 is A Z = 0 without friction.
struct EliminatedEquations {
  std::vector<std::size_t> dependent, independent;  // coordinates; the row's own one is independent
  std::vector<ReadableForm> rows;                   // row = 0
  bool dependent_replaced = false;                  // the dependent accelerations were put in from A q̈ = b
};
/// Nothing where A has no full row rank as a function, or a row would fill more than some lines. Each row is proved.
std::optional<EliminatedEquations> eliminate_multipliers(const EquationsOfMotion& equations);

}  // namespace maupertuis
