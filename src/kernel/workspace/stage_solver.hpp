#pragma once
#include "kernel/workspace/dependent_constraints.hpp"
#include "kernel/workspace/inverse_probe.hpp"
#include "kernel/workspace/lifted_solve.hpp"

#include <optional>
#include <span>

namespace maupertuis::workspace {

/// Solves the stages of an expansion: M₀ q̈_k = −R_k, bordered by constraints, and what coefficients of the stage change
/// by q̈_k. It chooses who does that.
///
///     by inverse   −M₀⁻¹, of up to 16 unknowns where M₀ is positive definite, or of up to 48 where there is code that
///                  finds it; with constraints of up to 16 unknowns, in the stages after the first
///     lifted       of more than 16 unknowns, without constraints: through the tangents (LiftedSolve)
///     by factors   of the full matrix, with pivots: with constraints, and wherever else the others do not hold
class StageSolver {
 public:
  /// How the stages after the first are solved: with a look at each solution; or directly, by −M⁻¹ (of few unknowns, or
  /// by code) or by sparse factors, with one look at the end.
  enum class LaterStages { StepByStep, ByInverse, ByLifting };

  StageSolver(Expansion& x, ExpansionInCode& in_code);
  StageSolver(const StageSolver&) = delete;

  /// After the constants have changed.
  void constants_changed();
  void set_usual_accelerations(std::span<const double> a) { constraints_.set_usual_accelerations(a); }
  /// Before a point: `alone` if its coefficients are not corrected.
  void begin(bool alone) { matrix_.begin(alone); }
  /// What the solutions of so many stages need.
  KernelStatus factor(int stages);
  /// One stage with a look at the solution before it is used: q̈_k, q_{k+2}, corrections.
  KernelStatus solve_and_look(int stage);
  /// One stage without. False: nothing is done, it has to be done with a look.
  template <class RunStage>
  bool solve_directly(int stage, RunStage&& run_stage);
  /// Of the engine, all stages from 1 on. False: a q̈ is not finite.
  packed::InverseSolution inverse_for_engine() { return inverse_.for_engine(); }
  LaterStages later() const { return later_; }
  bool are_coefficients_finite(int stages) const;

  // What is read of it.
  FullMatrix& matrix() { return matrix_; }
  const FullFactors& factors() const { return factors_; }
  std::size_t contradicting() const { return constraints_.contradicting(); }
  /// −A δ = error, for [m] errors; δ [n].
  void solve_for(std::span<const double> error, std::span<double> out);

  /// Solutions of large systems become machine code.
  void compile(const CompileOptions& options);
  void adopt_code();

 private:
  enum class FirstStage { ByFactors, ByInverse, ByInverseOfCode, ByLifting };

  bool is_constrained() const { return x_.unknowns > x_.program.freedoms; }
  bool finds_inverse_by_code();
  KernelStatus factor_full();
  KernelStatus factor_anew();
  KernelStatus solve(int stage);
  KernelStatus solve_once(int stage);
  bool solve_twice(int stage);
  bool solve_twice_by_inverse(int stage);
  KernelStatus finite() const { return unknowns_.are_finite() ? KernelStatus::Ok : KernelStatus::NonFinite; }
  void set_accelerations(int stage, const double* solution, int sign) {
    x_.engine.set_accelerations(x_.tables, stage, solution, x_.unknowns, sign);
  }
  void correct(int stage);

  Expansion& x_;
  ExpansionInCode& in_code_;
  FirstStage first_ = FirstStage::ByFactors;
  LaterStages later_ = LaterStages::StepByStep;
  ResidualPlaces residual_;
  StageUnknowns unknowns_;
  Tangents tangents_;
  /// Tangents along the second of two solutions: `tangents_` has those along the first one, and the corrections of the
  /// stage are to take these off. Null: there was no second solution.
  const double* excess_ = nullptr;
  FullMatrix matrix_;
  FullFactors factors_;
  DependentConstraints constraints_;
  Inverse inverse_;
  InverseProbe probe_;
  std::optional<LiftedSolve> lifted_;
};

/// −M₀⁻¹ by code solves it together with its corrections; else the lifted solution gives the tangents in its direction,
/// too.
template <class RunStage>
bool StageSolver::solve_directly(int stage, RunStage&& run_stage) {
  if (later_ == LaterStages::StepByStep ||
      (later_ == LaterStages::ByLifting && !(first_ == FirstStage::ByLifting && lifted_->is_direct(stage))))
    return false;
  run_stage();
  packed::CompiledArguments& arguments = in_code_.arguments;
  if (later_ == LaterStages::ByInverse) {
    arguments.has_copies = 0;
    in_code_.code.solve(&arguments, stage);
    return true;
  }
  arguments.tangents = lifted_->solve_row(x_.memory.row(stage));
  if (in_code_.code.correct) {
    arguments.has_copies = lifted_->solves_for_copies();
    in_code_.code.correct(&arguments, stage);
  } else {
    set_accelerations(stage, arguments.tangents, -1);
    tangents_.correct_along(stage, arguments.tangents, -1);
  }
  return true;
}

}  // namespace maupertuis::workspace
