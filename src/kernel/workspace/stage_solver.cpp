#include "kernel/workspace/stage_solver.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace maupertuis::workspace {
namespace {

/// What a rough solution may be wrong by. Beyond, the error bounds of LiftedSolve decide, since M₀ may be badly
/// conditioned.
constexpr double largest_correction = 1e-9;

}  // namespace

StageSolver::StageSolver(Expansion& x, ExpansionInCode& in_code)
    : x_(x),
      in_code_(in_code),
      by_matrix_(x.unknowns <= most_by_matrix),
      solution_(x.padded_unknowns(), 0.0),
      rough_(solution_),
      residual_vectors_(find_residual_vectors()),
      tangent_(by_matrix_ ? x.unknowns * x.memory.stride : x.memory.stride, 0.0),
      tangents_{tangent_.data(), x.memory.stride, x.unknowns, static_cast<Slot>(x.padded_unknowns()), {}} {
  unknown_ = {solution_.data(), x.unknowns};
  std::copy_n(x.program.stored_end.begin(), tangents_.end.size(), tangents_.end.begin());
  if (by_matrix_) answers_.assign(tangent_.size(), 0.0);
  for (std::size_t d = 0; by_matrix_ && d < x.unknowns; ++d) tangent_[d * x.memory.stride + d] = 1;
  if (!by_matrix_ && x.unknowns == x.program.freedoms)
    lifted_.emplace(x.kernel.program(), x.strip, x.packed, x.memory.stride);
  if (x.unknowns <= packed::most_by_inverse) inverse_.assign(x.padded_unknowns() * x.padded_unknowns(), 0.0);
  residual_side_by_side_ = is_residual_side_by_side();
  mass_in_eights_ = has_mass_in_eights();
  find_own_vectors();
}

void StageSolver::constants_changed() {
  if (lifted_) lifted_->set_constants(x_.memory);
  has_probe_ = false;
}

void StageSolver::compile(const CompileOptions& options) {
  if (lifted_) lifted_->compile(options);
}

void StageSolver::adopt_code() {
  in_code_.arguments.inverse = inverse_.data();
  if (!in_code_.code.stage) return;
  probe_.assign(x_.memory.stride, 0.0);
  largest_rest_.assign(x_.memory.stride, std::numeric_limits<double>::infinity());
}

void StageSolver::find_tangents(std::size_t directions) {
  const auto compiled = in_code_.code.tangents;
  if (!compiled) return x_.engine.tangents(x_.tables, tangent_.data(), x_.memory.stride, directions);
  for (std::size_t d = 0; d < directions; ++d) compiled(&in_code_.arguments, tangent_.data() + d * x_.memory.stride);
}

/// All tangents in the direction of `unknown`.
void StageSolver::find_direction() {
  std::copy(unknown_.begin(), unknown_.end(), tangent_.begin());
  find_tangents(1);
}

/// What the solutions of so many stages need, and how the later ones are to be found: by an inverse, if there is one of
/// few unknowns or code for it. (Rolled code may be without a solution.)
KernelStatus StageSolver::factor(int stages) {
  has_full_ = by_inverse_ = by_lifting_ = false;
  later_ = LaterStages::StepByStep;
  if (lifted_ && lifted_->has_pivots(x_.memory)) {
    if (stages > 1 && in_code_.code.solve && lifted_->negative_inverse(x_.memory, inverse_.data()) && inverts()) {
      later_ = LaterStages::ByInverse;
      return KernelStatus::Ok;
    }
    by_lifting_ = lifted_->factor(x_.memory);
  }
  if (by_lifting_) {
    if (stages > 1) later_ = LaterStages::ByLifting;
    return KernelStatus::Ok;
  }
  const KernelStatus status = factor_full();
  if (status == KernelStatus::Ok && stages > 1 && x_.unknowns > 0 && (in_code_.code.solve || !in_code_.code.stage) &&
      (by_inverse_ || inverts_bordered()))
    later_ = LaterStages::ByInverse;
  return status;
}

/// Where the inverse does not solve.
KernelStatus StageSolver::factor_anew() {
  by_lifting_ = lifted_->factor(x_.memory);
  later_ = by_lifting_ ? LaterStages::ByLifting : LaterStages::StepByStep;
  return by_lifting_ ? KernelStatus::Ok : factor_full();
}

KernelStatus StageSolver::solve_and_look(int stage) {
  if (const auto status = solve(stage); status != KernelStatus::Ok) return status;
  if (stage == 0 && !constraints_agree()) return KernelStatus::Contradiction;
  set_accelerations(stage, solution_.data(), 1);
  if (!alone_) correct(stage);
  return KernelStatus::Ok;
}

/// unknown → its solution.
void StageSolver::solve_factored() {
  if (by_lifting_)
    lifted_->solve(unknown_);
  else
    solver_->solve(unknown_);
}

/// unknown = q̈_k.
KernelStatus StageSolver::solve(int stage) {
  const double* const row = x_.memory.row(stage);
  excess_ = nullptr;
  if (by_inverse_) {
    const bool finite = x_.engine.solve_by_inverse(inverse_.data(), x_.padded_unknowns(), row,
                                                   x_.program.residual.data(), x_.unknowns, solution_.data());
    return finite ? KernelStatus::Ok : KernelStatus::NonFinite;
  }
  const auto finite = [this] {
    return x_.engine.are_finite(unknown_.data(), x_.unknowns, 1, x_.unknowns) ? KernelStatus::Ok
                                                                              : KernelStatus::NonFinite;
  };
  if (later_ == LaterStages::ByInverse && stage == 0 && lifted_) {
    if (solve_twice_by_inverse(stage)) return finite();
    if (const KernelStatus status = factor_anew(); status != KernelStatus::Ok) return status;
  }
  if (by_lifting_ && lifted_->is_rough(stage) && solve_twice(stage)) return finite();
  has_direction_ = false, excess_ = nullptr;
  fetch_residual(stage);
  if (stage > 0 || !by_lifting_) {
    solve_factored();
  } else if (!lifted_->solve_first(x_.memory, unknown_)) {
    by_lifting_ = false;
    if (const KernelStatus status = factor_full(); status != KernelStatus::Ok) return status;
    solve_factored();
  }
  return finite();
}

/// Code does not look at each stage: what is not finite goes on to the stages that follow, or stays where it is.
bool StageSolver::are_coefficients_finite(int stages) const {
  return x_.engine.are_finite(x_.memory.row(3), x_.memory.stride, static_cast<std::size_t>(stages - 1), x_.unknowns);
}

/// unknown = −R_k, and 0 beyond, where a solution for what is not finite leaves the like.
void StageSolver::fetch_residual(int stage) {
  const double* const row = x_.memory.row(stage);
  for (std::size_t i = 0; i < x_.unknowns; ++i) unknown_[i] = -row[x_.program.residual[i]];
  std::fill(solution_.begin() + static_cast<std::ptrdiff_t>(x_.unknowns), solution_.end(), 0.0);
}

/// A rough solution, and one for what it leaves of −R_k, which the tangents tell. False: the second is not small beside
/// the first, as it is where the first holds.
bool StageSolver::solve_twice(int stage) {
  const auto solve_for = [&](const double* row) {
    const double* const x = lifted_->solve_row(row);
    x_.engine.negate(x, solution_.data(), x_.unknowns);
    return x;
  };
  solve_for(x_.memory.row(stage));
  find_direction();
  std::copy(unknown_.begin(), unknown_.end(), rough_.begin());
  add_residual(stage);
  excess_ = solve_for(tangent_.data());
  has_direction_ = true;
  return add_rough_solution();
}

/// The same by −M₀⁻¹.
bool StageSolver::solve_twice_by_inverse(int stage) {
  const auto multiply = [this](const double* row) {
    x_.engine.solve_by_inverse(inverse_.data(), x_.padded_unknowns(), row, x_.program.residual.data(), x_.unknowns,
                               solution_.data());
  };
  multiply(x_.memory.row(stage));
  find_direction();
  std::copy(unknown_.begin(), unknown_.end(), rough_.begin());
  add_residual(stage);
  multiply(tangent_.data());
  return add_rough_solution();
}

/// To the tangents of the residual; where it stands alone, in vectors.
void StageSolver::add_residual(int stage) {
  const double* const row = x_.memory.row(stage);
  const auto [first, last] = residual_vectors_;
  if (first != last)
    x_.engine.add(tangent_.data() + first, row + first, 1, last - first);
  else
    for (const Slot slot : x_.program.residual) tangent_[slot] += row[slot];
}

/// Slots from the residual's first vector to its last, if no coefficients that later orders read are among them, and no
/// more besides than the residual has. Else none.
std::pair<Slot, Slot> StageSolver::find_residual_vectors() const {
  if (x_.program.residual.empty()) return {0, 0};
  const auto [lowest, highest] = std::minmax_element(x_.program.residual.begin(), x_.program.residual.end());
  const Slot first = *lowest / packed::lanes * packed::lanes, last = static_cast<Slot>(packed::padded(*highest + 1));
  const bool stands_alone =
      first >= packed::padded(*std::max_element(x_.program.stored_end.begin(), x_.program.stored_end.end()));
  return stands_alone && last - first <= 2 * x_.padded_unknowns() ? std::pair{first, last}
                                                                  : std::pair{Slot{0}, Slot{0}};
}

/// To its correction.
bool StageSolver::add_rough_solution() {
  const packed::Sizes size = x_.engine.add(rough_.data(), unknown_.data(), 1, x_.unknowns);
  std::copy(rough_.begin(), rough_.begin() + static_cast<std::ptrdiff_t>(x_.unknowns), unknown_.begin());
  return size.change <= largest_correction * size.values;
}

/// Coefficient k + 2 − ℓ of a slot of lag ℓ follows q̈_k with its order-0 tangents: one by one, or the tangent in the
/// direction of q̈_k.
void StageSolver::correct(int stage) {
  if (by_matrix_) return x_.engine.correct(x_.tables, stage, tangents_, solution_.data());
  const double* const known = by_lifting_ && later_ != LaterStages::ByInverse ? lifted_->tangents(stage) : nullptr;
  if (!known && !std::exchange(has_direction_, false)) find_direction();
  correct(stage, known ? known : tangent_.data(), 1);
  if (excess_) correct(stage, std::exchange(excess_, nullptr), -1);
}

/// By the tangents in one direction.
void StageSolver::correct(int stage, const double* direction, double weight) {
  packed::TangentMatrix matrix = tangents_;
  matrix.values = direction;
  matrix.directions = 1;
  x_.engine.correct(x_.tables, stage, matrix, &weight);
}

void StageSolver::solve_for(std::span<const double> error, std::span<double> out) {
  const std::size_t n = x_.program.freedoms;
  std::fill_n(unknown_.begin(), n, 0.0);
  std::copy(error.begin(), error.end(), unknown_.begin() + static_cast<std::ptrdiff_t>(n));
  solve_factored();
  std::copy_n(unknown_.begin(), n, out.begin());
}

}  // namespace maupertuis::workspace
