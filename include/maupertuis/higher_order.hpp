#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <string>
#include <vector>

/// Lagrangians that hold q'' (Ostrogradsky): the equations as a textbook has them, of the system that is computed with
/// L* = L(q, v, v', t) + p (q' − v).
namespace maupertuis {

struct HigherOrderForm {
  std::vector<std::size_t> coordinates;  // those of the text; rows and velocities follow them
  ExprVector residual;  // R = d/dt ∂L/∂q' − ∂L/∂q − d²/dt² ∂L/∂q'' + ∂D/∂q' − Q, in q … q'''', t
  ExprVector momenta;               // ∂L/∂q' − d/dt ∂L/∂q'', which is p₁ where q'' stands in L
  ExprVector acceleration_momenta;  // p₂ = ∂L/∂q'', 0 where it does not
  Expr energy_function;             // h_E = Σ p₁ q' + p₂ q'' − L
  Expr power;                       // dh_E/dt along the motion: −∂L/∂t − q'·∂D/∂q' + Q·q'
};

/// What a reader calls a coordinate of L*: "q'" the v of q'', and "" Ostrogradsky's p, which no text names.
std::string written_name(const MechanicalSystem& system, std::size_t coordinate);

/// Precondition: system.higher is not empty. Cost: two total time derivatives of the gradient of L.
HigherOrderForm higher_order_form(const EquationsOfMotion& equations);

struct HigherOrderProof {
  const char* name;
  const char* statement;
  ZeroTest test;
};
/// That R is what the system of L*, whose rows are certified by themselves, leaves when v and p are eliminated, and
/// that dh_E/dt = q'·R − ∂L/∂t − q'·∂D/∂q' + Q·q' for any path.
std::vector<HigherOrderProof> higher_order_proofs(const EquationsOfMotion& equations);

/// ∂L/∂q, ∂L/∂q', ∂L/∂q'' and the momenta, line by line.
std::vector<DerivationStep> higher_order_steps(const EquationsOfMotion& equations);
/// Momenta and the energy function.
std::vector<DerivationStep> higher_order_lines(const EquationsOfMotion& equations);

}  // namespace maupertuis
