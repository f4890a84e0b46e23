#pragma once
#include "kernel/dense/bordered_solver.hpp"
#include "kernel/workspace/expansion.hpp"
#include "kernel/workspace/lifted_solve.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace maupertuis::workspace {

/// Solves the stages of an expansion: M₀ q̈_k = −R_k, bordered by constraints, and what coefficients of the stage change
/// by q̈_k.
///
///     by matrix    up to 16 unknowns: the tangents of all slots in the direction of each unknown are kept, so that
///                  corrections are products
///     by inverse   −M₀⁻¹, of up to 16 unknowns where M₀ is positive definite, or of up to 48 where there is code that
///                  finds it; with constraints of up to 16 unknowns, in the stages after the first
///     lifted       more unknowns, without constraints: through the tangents (LiftedSolve)
///     bordered     with constraints, and wherever else the others do not hold: factors of the full matrix, with pivots
class StageSolver {
 public:
  /// Up to here the correction of a stage is a product with a small matrix, and so is the solution where M is positive
  /// definite.
  static constexpr std::size_t most_by_matrix = 16;

  /// How the stages after the first are solved: with a look at each solution; or directly, by −M⁻¹ (of few unknowns, or
  /// by code) or by sparse factors, with one look at the end.
  enum class LaterStages { StepByStep, ByInverse, ByLifting };

  StageSolver(Expansion& x, ExpansionInCode& in_code);
  StageSolver(const StageSolver&) = delete;

  /// After the constants have changed.
  void constants_changed();
  void set_usual_accelerations(std::span<const double> a) { usual_accelerations_.assign(a.begin(), a.end()); }
  /// Before a point: `alone` if its coefficients are not corrected.
  void begin(bool alone) { alone_ = alone; }
  /// What the solutions of so many stages need.
  KernelStatus factor(int stages);
  /// One stage with a look at the solution before it is used: q̈_k, q_{k+2}, corrections.
  KernelStatus solve_and_look(int stage);
  /// One stage without. False: nothing is done, it has to be done with a look.
  template <class RunStage>
  bool solve_directly(int stage, RunStage&& run_stage);
  /// Of the engine, all stages from 1 on. False: a q̈ is not finite.
  packed::InverseSolution inverse_solution();
  LaterStages later() const { return later_; }
  bool are_coefficients_finite(int stages) const;
  /// Code has run all stages.
  void forget_point() { has_full_ = false; }

  // What is read of it.
  double bordered(std::size_t row, std::size_t column) { return need_full(), bordered_[row * x_.unknowns + column]; }
  /// −A δ = error, for [m] errors; δ [n].
  void solve_for(std::span<const double> error, std::span<double> out);
  bool keeps(std::size_t constraint) const { return by_lifting_ || !solver_ || solver_->keeps(constraint); }
  bool determines(std::size_t constraint) const { return by_lifting_ || !solver_ || solver_->determines(constraint); }
  double pivot_ratio() const { return by_lifting_ ? lifted_->least_pivot() : solver_ ? solver_->pivot_ratio() : 1; }
  std::size_t singular() const { return singular_; }
  std::size_t contradicting() const { return contradicting_; }

  /// Solutions of large systems become machine code.
  void compile(const CompileOptions& options);
  void adopt_code();

 private:
  void find_tangents(std::size_t directions);
  void find_direction();

  // Full matrix (full_matrix.cpp).
  void need_full();
  void sweep_block(std::size_t first);
  bool has_mass_in_eights() const;
  void fetch_eights();
  void fetch_mass(std::size_t i, const double* column, std::size_t step, std::size_t first, std::size_t last);
  bool inverts_full();
  KernelStatus factor_full();
  bool has_symmetric_pattern();
  bool inverts_bordered();
  double acceleration_of_terms(std::size_t i) const;
  bool constraints_agree();

  // Inverse (inverse_solution.cpp).
  bool is_residual_side_by_side() const;
  void find_own_vectors();
  bool inverts();
  void set_probe();

  // Solution (stage_solver.cpp).
  KernelStatus factor_anew();
  KernelStatus solve(int stage);
  void solve_factored();
  void fetch_residual(int stage);
  bool solve_twice(int stage);
  bool solve_twice_by_inverse(int stage);
  bool add_rough_solution();
  void add_residual(int stage);
  std::pair<Slot, Slot> find_residual_vectors() const;
  void set_accelerations(int stage, const double* solution, int sign) {
    x_.engine.set_accelerations(x_.tables, stage, solution, x_.unknowns, sign);
  }
  void correct(int stage);
  void correct(int stage, const double* direction, double weight);

  Expansion& x_;
  ExpansionInCode& in_code_;
  const bool by_matrix_;
  bool by_inverse_ = false, by_lifting_ = false;
  LaterStages later_ = LaterStages::StepByStep;
  bool alone_ = false;
  std::size_t singular_ = 0, contradicting_ = 0;

  std::vector<double> usual_accelerations_;  // [n] or empty
  Doubles solution_;                         // q̈_k and λ_k, padded
  std::span<double> unknown_;                // [n + m] of it: −R_k, then q̈_k and λ_k
  Doubles rough_;                            // a first solution that a second one improves, padded
  /// Tangents in the direction of the second solution: `tangent_` is that of the first one, and the corrections of the
  /// stage are to take these off. Null: there was no second solution.
  const double* excess_ = nullptr;
  std::pair<Slot, Slot> residual_vectors_;  // see find_residual_vectors()

  Doubles tangent_;  // by_matrix: ∂slot/∂q^(lag) for each unknown [n + m × stride], else for one direction
  packed::TangentMatrix tangents_;  // by_matrix: the engine's view of it
  bool has_direction_ = false;      // it is that of q̈_k, if `excess_` is taken from it

  std::vector<double> bordered_;       // [(n + m) × (n + m)] ∂R/∂(q̈, λ) at order 0; empty until it is asked for
  bool has_full_ = false;              // it is that of this point
  std::vector<double> block_tangent_;  // [slots × 8]
  std::vector<sparse::Edge> of_mass_;  // through which M₀ goes
  bool mass_in_eights_ = false;        // see has_mass_in_eights()
  std::optional<bool> symmetric_pattern_;  // of M₀, once it was asked for
  std::optional<dense::BorderedSolver> solver_;

  Doubles inverse_;                          // −M⁻¹, padded rows and columns
  std::vector<double> inverted_, factored_;  // the M₀ that it, and that the factors belong to; empty: none
  Doubles answers_;                          // scratch of Engine::run_stages_by_inverse
  std::vector<std::int8_t> own_;             // see packed::InverseSolution
  bool residual_side_by_side_ = false;
  Doubles probe_;           // [stride] the right side of inverts()
  Doubles largest_rest_;    // [stride] that a solution for it may leave; what is no residual may be anything
  bool has_probe_ = false;  // for these parameters

  std::optional<LiftedSolve> lifted_;
};

/// −M₀⁻¹ by code solves it together with its corrections; else the lifted solution gives the tangents in its direction,
/// too.
template <class RunStage>
bool StageSolver::solve_directly(int stage, RunStage&& run_stage) {
  if (later_ == LaterStages::StepByStep ||
      (later_ == LaterStages::ByLifting && !(by_lifting_ && lifted_->is_direct(stage))))
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
    correct(stage, arguments.tangents, -1);
  }
  return true;
}

}  // namespace maupertuis::workspace
