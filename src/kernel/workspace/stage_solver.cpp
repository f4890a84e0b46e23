#include "kernel/workspace/stage_solver.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::workspace {

StageSolver::StageSolver(Expansion& x, ExpansionInCode& in_code)
    : x_(x),
      in_code_(in_code),
      residual_(x),
      unknowns_(x),
      tangents_(x, in_code),
      matrix_(x, residual_, tangents_),
      factors_(x),
      constraints_(x),
      inverse_(x, residual_, tangents_),
      probe_(x, residual_) {
  if (!tangents_.are_of_each() && !is_constrained())
    lifted_.emplace(x.kernel.program(), x.strip, x.packed, x.memory.stride);
}

void StageSolver::constants_changed() {
  if (lifted_) lifted_->set_constants(x_.memory);
  probe_.constants_changed();
}

void StageSolver::compile(const CompileOptions& options) {
  if (lifted_) lifted_->compile(options);
}

void StageSolver::adopt_code() {
  in_code_.arguments.inverse = inverse_.values();
  if (in_code_.code.stage) probe_.make_room();
}

// ------------------------------------------------------------------------------------------------------------ choosing

/// How the later stages are to be solved: by an inverse, if there is one of few unknowns or code for it. (Rolled code
/// may be without a solution.)
KernelStatus StageSolver::factor(int stages) {
  later_ = LaterStages::StepByStep;
  if (lifted_ && lifted_->has_pivots(x_.memory)) {
    if (stages > 1 && finds_inverse_by_code()) {
      first_ = FirstStage::ByInverseOfCode;
      later_ = LaterStages::ByInverse;
      return KernelStatus::Ok;
    }
    if (lifted_->factor(x_.memory)) {
      first_ = FirstStage::ByLifting;
      if (stages > 1) later_ = LaterStages::ByLifting;
      return KernelStatus::Ok;
    }
  }
  const KernelStatus status = factor_full();
  if (status != KernelStatus::Ok || stages == 1 || x_.unknowns == 0 || (in_code_.code.stage && !in_code_.code.solve))
    return status;
  // With constraints the first stage is solved by the factors, which tell whether they are met; the later ones are
  // products.
  if (first_ == FirstStage::ByInverse ||
      (tangents_.are_of_each() && is_constrained() && inverse_.find(matrix_, factors_)))
    later_ = LaterStages::ByInverse;
  return status;
}

bool StageSolver::finds_inverse_by_code() {
  return in_code_.code.solve && lifted_->negative_inverse(x_.memory, inverse_.values()) &&
         probe_.holds(inverse_, unknowns_, tangents_);
}

KernelStatus StageSolver::factor_full() {
  first_ = FirstStage::ByFactors;
  if (!matrix_.is_finite()) return KernelStatus::NonFinite;
  if (tangents_.are_of_each() && !is_constrained() && matrix_.has_symmetric_pattern() && inverse_.find(matrix_)) {
    first_ = FirstStage::ByInverse;
    return KernelStatus::Ok;
  }
  return factors_.find(matrix_) ? KernelStatus::Ok : KernelStatus::SingularMass;
}

/// Where the inverse that code has found does not solve.
KernelStatus StageSolver::factor_anew() {
  later_ = LaterStages::StepByStep;
  if (!lifted_->factor(x_.memory)) return factor_full();
  first_ = FirstStage::ByLifting;
  later_ = LaterStages::ByLifting;
  return KernelStatus::Ok;
}

// ------------------------------------------------------------------------------------------------------------- solving

KernelStatus StageSolver::solve_and_look(int stage) {
  if (const auto status = solve(stage); status != KernelStatus::Ok) return status;
  if (stage == 0 && is_constrained() && !constraints_.agree(matrix_.values(), factors_, unknowns_.values()))
    return KernelStatus::Contradiction;
  set_accelerations(stage, unknowns_.data(), 1);
  if (!matrix_.is_of_point_alone()) correct(stage);
  return KernelStatus::Ok;
}

/// unknowns = q̈_k and λ_k.
KernelStatus StageSolver::solve(int stage) {
  excess_ = nullptr;
  if (first_ == FirstStage::ByInverse)
    return inverse_.solve(x_.memory.row(stage), unknowns_.data()) ? KernelStatus::Ok : KernelStatus::NonFinite;
  if (first_ == FirstStage::ByInverseOfCode && stage == 0) {
    if (solve_twice_by_inverse(stage)) return finite();
    if (const KernelStatus status = factor_anew(); status != KernelStatus::Ok) return status;
  }
  if (first_ == FirstStage::ByLifting && lifted_->is_rough(stage) && solve_twice(stage)) return finite();
  excess_ = nullptr;
  return solve_once(stage);
}

KernelStatus StageSolver::solve_once(int stage) {
  unknowns_.take_residual(x_.memory.row(stage));
  if (first_ == FirstStage::ByLifting) {
    if (stage > 0) {
      lifted_->solve(unknowns_.values());
      return finite();
    }
    if (lifted_->solve_first(x_.memory, unknowns_.values())) return finite();
    if (const KernelStatus status = factor_full(); status != KernelStatus::Ok) return status;
  }
  factors_.solve(unknowns_.values());
  return finite();
}

/// A rough solution, and one for what it leaves of −R_k, which the tangents tell. False: the second is not small beside
/// the first, as it is where the first holds.
bool StageSolver::solve_twice(int stage) {
  const double* const row = x_.memory.row(stage);
  const auto solve_for = [&](const double* right_side) {
    const double* const x = lifted_->solve_row(right_side);
    x_.engine.negate(x, unknowns_.data(), x_.unknowns);
    return x;
  };
  solve_for(row);
  tangents_.find_along(unknowns_.values());
  unknowns_.keep_as_rough();
  residual_.add(x_.engine, tangents_.along(), row);
  excess_ = solve_for(tangents_.along());
  return unknowns_.add_rough();
}

/// The same by −M₀⁻¹.
bool StageSolver::solve_twice_by_inverse(int stage) {
  const double* const row = x_.memory.row(stage);
  inverse_.solve(row, unknowns_.data());
  tangents_.find_along(unknowns_.values());
  unknowns_.keep_as_rough();
  residual_.add(x_.engine, tangents_.along(), row);
  inverse_.solve(tangents_.along(), unknowns_.data());
  return unknowns_.add_rough();
}

/// Code does not look at each stage: what is not finite goes on to the stages that follow, or stays where it is.
bool StageSolver::are_coefficients_finite(int stages) const {
  return x_.engine.are_finite(x_.memory.row(3), x_.memory.stride, static_cast<std::size_t>(stages - 1), x_.unknowns);
}

/// By the tangents of each unknown, or by those in the direction of q̈_k: the lifted solution has them, or the first of
/// two solutions, or they are found.
void StageSolver::correct(int stage) {
  if (tangents_.are_of_each()) return tangents_.correct(stage, unknowns_.data());
  const double* const excess = std::exchange(excess_, nullptr);
  const double* direction = first_ == FirstStage::ByLifting ? lifted_->tangents(stage) : nullptr;
  if (!direction) {
    if (!excess) tangents_.find_along(unknowns_.values());
    direction = tangents_.along();
  }
  tangents_.correct_along(stage, direction, 1);
  if (excess) tangents_.correct_along(stage, excess, -1);
}

void StageSolver::solve_for(std::span<const double> error, std::span<double> out) {
  const std::size_t n = x_.program.freedoms;
  const std::span<double> b = unknowns_.values();
  std::fill_n(b.begin(), n, 0.0);
  std::copy(error.begin(), error.end(), b.begin() + static_cast<std::ptrdiff_t>(n));
  factors_.solve(b);
  std::copy_n(b.begin(), n, out.begin());
}

}  // namespace maupertuis::workspace
