#pragma once
#include <maupertuis/across_switches.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis {

/// On what ground a difference vanishes; `constrained`: along the motion of a system with constraints.
std::string ground_of(const ZeroTest& test, bool constrained);

/// The column of a trajectory that holds formula `index` of `Experiment::asked`. Where contacts and friction act a
/// formula in accelerations and forces has another value in each mode, so the run itself fills its column; without them
/// the state says it, and there is no such column.
std::string asked_column(std::size_t index);

/// Proofs about functions along the motion. Without constraints q̈ is replaced by −M⁻¹ h as a shared DAG, and the rest
/// is the zero test's. With constraints nothing is put in: the test looks at points that satisfy the constraints and
/// the equations with their multipliers, near the start, to 60 digits. So with degenerate Lagrangians, at points that
/// fulfil all that the constraint algorithm found.
class AlongMotion {
 public:
  explicit AlongMotion(const EquationsOfMotion& equations);
  /// With other equations than the derived ones, to see whether a claim follows from a known mistake.
  AlongMotion(const EquationsOfMotion& equations, const ExprVector& residual);

  /// False where M is singular: then nothing can be said.
  bool solvable() const { return constrained() || accelerations(); }
  /// e with q̈ put in; lets, inputs and reactions as well.
  Expr put_in(Expr e) const;
  ZeroTest vanishes(Expr e) const;
  /// At states on which all of `level`, functions of q, q', t, vanish: to 60 digits at random ones near the start, as
  /// with constraints.
  ZeroTest vanishes_on(Expr e, std::span<const Expr> level) const;
  /// dI/dt along the motion, q̈ put in.
  Expr rate(Expr integral) const;
  /// Whether dI/dt vanishes along the motion. Of functions of the energy that is seen from the equations as they are:
  /// of n coordinates M⁻¹ takes n³ nodes.
  ZeroTest is_constant(Expr integral) const;
  /// Whether an integral of each side goes on where a motion passes a switch.
  AcrossSwitches across(Expr integral) const;
  /// Where the motion starts: points near it are looked at.
  void set_start(const MotionState& start) { start_ = start; }

 private:
  ZeroTest as_formula(Expr plain) const;
  std::optional<ZeroTest> is_constant_with_energy(Expr integral) const;
  const ExprMap* accelerations() const;
  Expr in_motion(Expr e) const;
  bool constrained() const { return equations_.system->constrained() || equations_.degenerate; }
  /// What points along the motion fulfil, in which unknowns, and where to look for them.
  struct Where {
    std::vector<Expr> relations, unknowns;
    Bindings center;
  };
  Where relations_for(Expr e) const;
  std::vector<Expr> relations() const;
  Bindings center() const;

  const EquationsOfMotion& equations_;
  ExprVector residual_;
  std::optional<MotionState> start_;
  mutable bool looked_for_accelerations_ = false;  // at first use
  mutable std::optional<ExprMap> accelerations_;
  struct Manifold;
  Manifold& manifold(const ExprVector& relations, const ExprVector& unknowns, const Bindings& center) const;
  mutable std::vector<std::shared_ptr<Manifold>> manifolds_;  // on which formulas were tested, the last ones
};

}  // namespace maupertuis
