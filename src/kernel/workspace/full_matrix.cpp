#include "kernel/workspace/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

/// M₀ itself, bordered by the constraints, and its factors.
namespace maupertuis::workspace {
namespace {

/// A point alone (an output between steps) needs M₀ but no corrections: beyond this the instructions that M₀ goes
/// through are fewer.
constexpr std::size_t most_swept_at_point = 8;

}  // namespace

/// Those of the residual in 8 directions.
void StageSolver::sweep_block(std::size_t first) {
  std::fill_n(block_tangent_.begin(), x_.unknowns * 8, 0.0);
  for (std::size_t d = 0; d < 8 && first + d < x_.unknowns; ++d) block_tangent_[(first + d) * 8 + d] = 1;
  reference::tangents<8>(x_.memory, block_tangent_.data(), of_mass_);
}

/// M₀ = ∂R/∂q̈ at order 0, bordered by the constraints, column by column.
void StageSolver::need_full() {
  if (has_full_) return;
  has_full_ = true;
  const std::size_t n = x_.unknowns;
  bordered_.resize(n * n);
  const bool by_sweep = by_matrix_ && (!alone_ || n <= most_swept_at_point);
  if (!by_sweep && of_mass_.empty()) {
    block_tangent_.assign(x_.program.slots * 8, 0.0);
    of_mass_ = sparse::edges_of_mass(x_.program);
  }
  if (by_sweep) {
    find_tangents(n);
    if (mass_in_eights_) return fetch_eights();
    for (std::size_t i = 0; i < n; ++i) fetch_mass(i, tangent_.data() + x_.program.residual[i], x_.memory.stride, 0, n);
    return;
  }
  for (std::size_t d = 0; d < n; d += 8) {
    sweep_block(d);
    for (std::size_t i = 0; i < n; ++i)
      fetch_mass(i, block_tangent_.data() + x_.program.residual[i] * 8, 1, d, std::min(n, d + 8));
  }
}

/// Whether the residuals are side by side, in whole vectors, and all depend on q̈.
bool StageSolver::has_mass_in_eights() const {
  const auto follows = [this](Slot slot) { return x_.program.tangent_lags[slot] == 2; };
  return by_matrix_ && x_.unknowns > 0 && x_.unknowns % packed::lanes == 0 && residual_side_by_side_ &&
         std::all_of(x_.program.residual.begin(), x_.program.residual.end(), follows);
}

/// M₀ from its tangents in all directions, which are its columns.
void StageSolver::fetch_eights() {
  for (std::size_t d = 0; d < x_.unknowns; d += packed::lanes)
    for (std::size_t i = 0; i < x_.unknowns; i += packed::lanes)
      x_.engine.transpose(tangent_.data() + d * x_.memory.stride + x_.program.residual[i], x_.memory.stride,
                          bordered_.data() + i * x_.unknowns + d, x_.unknowns);
}

/// Row i of M₀ from its tangents in the directions `first` to `last` − 1.
void StageSolver::fetch_mass(std::size_t i, const double* column, std::size_t step, std::size_t first,
                             std::size_t last) {
  double *const row = bordered_.data() + i * x_.unknowns, *const end = row + last;
  if (x_.program.tangent_lags[x_.program.residual[i]] != 2) return std::fill(row + first, end, 0.0);
#pragma GCC unroll 4
  for (double* entry = row + first; entry != end; ++entry, column += step) *entry = *column;
}

/// A symmetric M₀ is inverted without pivoting, and its inverse read by rows or columns alike.
bool StageSolver::has_symmetric_pattern() {
  if (!symmetric_pattern_) symmetric_pattern_ = sparse::has_symmetric_pattern(x_.kernel.program());
  return *symmetric_pattern_;
}

/// A matrix that is what it was, as between impacts of points, has the factors and the inverse that it had.
bool StageSolver::inverts_full() {
  if (!inverted_.empty() && inverted_ == bordered_) return true;
  inverted_.clear();
  if (!x_.engine.negative_inverse(bordered_.data(), x_.unknowns, inverse_.data())) return false;
  inverted_ = bordered_;
  return true;
}

/// Its factors.
KernelStatus StageSolver::factor_full() {
  const std::size_t n = x_.unknowns;
  need_full();
  if (!x_.engine.are_finite(bordered_.data(), n, n, n)) return KernelStatus::NonFinite;
  by_inverse_ = by_matrix_ && n == x_.program.freedoms && has_symmetric_pattern() && inverts_full();
  if (by_inverse_) return KernelStatus::Ok;
  if (!solver_)
    solver_.emplace(x_.program.freedoms, n - x_.program.freedoms, n > x_.program.freedoms || has_symmetric_pattern());
  if (!factored_.empty() && factored_ == bordered_) return KernelStatus::Ok;
  factored_.clear();
  std::copy(bordered_.begin(), bordered_.end(), solver_->matrix().begin());
  if (const auto undetermined = solver_->factor()) {
    singular_ = *undetermined;
    return KernelStatus::SingularMass;
  }
  factored_ = bordered_;
  return KernelStatus::Ok;
}

/// The first stage is solved by the factors, which constraints need to be met; the later ones are products.
bool StageSolver::inverts_bordered() {
  if (!by_matrix_ || x_.unknowns == x_.program.freedoms) return false;
  if (!inverted_.empty() && inverted_ == bordered_) return true;
  inverted_.clear();
  if (!solver_->negative_inverse(inverse_.data(), x_.padded_unknowns())) return false;
  inverted_ = bordered_;
  return true;
}

/// How large the acceleration is that the terms of one equation would give alone. Where they balance, what is left of
/// it is their rounding.
double StageSolver::acceleration_of_terms(std::size_t i) const {
  const std::size_t n = x_.program.freedoms;
  const Slot slot = x_.program.residual[i];
  const double mass = std::abs(bordered_[i * x_.unknowns + i]);
  double force = reference::term_size(x_.memory, x_.producer[slot], slot);
  for (std::size_t k = n; k < x_.unknowns; ++k) force += std::abs(bordered_[k * x_.unknowns + i] * unknown_[k]);
  const double usual = usual_accelerations_.empty() ? 0 : usual_accelerations_[i];
  return mass > 0 ? std::max(usual, force / mass) : usual;
}

/// Whether the rows of A that were dropped as dependent hold for the accelerations of the others. Where forces balance
/// (a ladder at rest between rough walls, a beam on three supports) accelerations are rounding, and ask nothing.
bool StageSolver::constraints_agree() {
  constexpr double rounding = 1e-12;
  const std::size_t n = x_.program.freedoms;
  for (std::size_t j = 0; n + j < x_.unknowns; ++j) {
    if (keeps(j)) continue;
    const Slot slot = x_.program.residual[n + j];
    double rest = x_.memory.row(0)[slot], size = reference::term_size(x_.memory, x_.producer[slot], slot), left = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double a = bordered_[(n + j) * x_.unknowns + i];
      rest += a * unknown_[i];
      size += std::abs(a * unknown_[i]);
      if (a != 0) left += std::abs(a) * acceleration_of_terms(i);
    }
    if (std::abs(rest) <= 1e-6 * size + rounding * left) continue;
    contradicting_ = j;
    return false;
  }
  return true;
}

}  // namespace maupertuis::workspace
