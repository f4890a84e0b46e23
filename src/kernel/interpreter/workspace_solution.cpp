#include "kernel/interpreter/workspace.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

/// The solution of a stage: M₀, its factors, q̈_k, and what the coefficients of the stage owe to it.
namespace maupertuis {
namespace {

/// A point alone (an output between steps) needs M₀ but no corrections: beyond this the instructions that M₀ goes through are fewer.
constexpr std::size_t most_swept_at_point = 8;

/// What a rough solution may be wrong by. Beyond, the error bounds of LiftedSolve decide, since M₀ may be badly conditioned.
constexpr double largest_correction = 1e-9;

/// What the inverse may leave of a right side: beyond, the sparse factors solve better.
constexpr double largest_rest_of_inverse = 1e-11;

}  // namespace

/// Those of the residual in 8 directions.
void KernelWorkspace::Impl::sweep_block(std::size_t first) {
  std::fill_n(block_tangent.begin(), unknowns * 8, 0.0);
  for (std::size_t d = 0; d < 8 && first + d < unknowns; ++d) block_tangent[(first + d) * 8 + d] = 1;
  interpreter::tangents<8>(memory, block_tangent.data(), of_mass);
}

/// M₀ = ∂R/∂q̈ at order 0, bordered by the constraints, column by column.
void KernelWorkspace::Impl::need_full() {
  if (has_full) return;
  has_full = true;
  const std::size_t n = unknowns;
  bordered.resize(n * n);
  const bool by_sweep = by_matrix && (!alone || n <= most_swept_at_point);
  if (!by_sweep && of_mass.empty()) {
    block_tangent.assign(program.slots * 8, 0.0);
    of_mass = interpreter::instructions_of_mass(program);
  }
  if (by_sweep) {
    find_tangents(n);
    if (mass_in_eights) return fetch_eights();
    for (std::size_t i = 0; i < n; ++i) fetch_mass(i, tangent.data() + program.residual[i], memory.stride, 0, n);
    return;
  }
  for (std::size_t d = 0; d < n; d += 8) {
    sweep_block(d);
    for (std::size_t i = 0; i < n; ++i) fetch_mass(i, block_tangent.data() + program.residual[i] * 8, 1, d, std::min(n, d + 8));
  }
}

bool KernelWorkspace::Impl::is_residual_side_by_side() const {
  for (std::size_t i = 0; i < unknowns; ++i)
    if (program.residual[i] != program.residual[0] + i) return false;
  return true;
}

/// Which unknowns a corrected slot follows, by the graph of the tangents.
void KernelWorkspace::Impl::find_own_vectors() {
  if (!by_matrix) return;
  std::vector<std::uint32_t> followed(packed.cells, 0);  // a bit for each unknown
  for (std::size_t d = 0; d < unknowns; ++d) followed[d] = 1u << d;
  for (const sparse::Edge& edge : sparse::tangent_edges(program)) followed[edge.out] |= followed[edge.operand];
  for (std::size_t slot = padded_unknowns(); slot < program.stored_end[2]; slot += packed::lanes) {
    const auto follows_own = [&](std::size_t vector) {
      for (std::size_t lane = 0; lane < packed::lanes; ++lane)
        if ((followed[slot + lane] & ~(std::uint64_t{1} << (vector * packed::lanes + lane))) != 0) return false;
      return true;
    };
    own.push_back(follows_own(0) ? 0 : padded_unknowns() > packed::lanes && follows_own(1) ? 1 : -1);
  }
}

/// Whether the residuals are side by side, in whole vectors, and all depend on q̈.
bool KernelWorkspace::Impl::has_mass_in_eights() const {
  const auto follows = [this](Slot slot) { return program.tangent_lags[slot] == 2; };
  return by_matrix && unknowns > 0 && unknowns % packed::lanes == 0 && residual_side_by_side &&
         std::all_of(program.residual.begin(), program.residual.end(), follows);
}

/// M₀ from its tangents in all directions, which are its columns.
void KernelWorkspace::Impl::fetch_eights() {
  for (std::size_t d = 0; d < unknowns; d += packed::lanes)
    for (std::size_t i = 0; i < unknowns; i += packed::lanes)
      engine.transpose(tangent.data() + d * memory.stride + program.residual[i], memory.stride, bordered.data() + i * unknowns + d, unknowns);
}

/// Row i of M₀ from its tangents in the directions `first` to `last` − 1.
void KernelWorkspace::Impl::fetch_mass(std::size_t i, const double* tangents, std::size_t step, std::size_t first, std::size_t last) {
  double *const row = bordered.data() + i * unknowns, *const end = row + last;
  if (program.tangent_lags[program.residual[i]] != 2) return std::fill(row + first, end, 0.0);
#pragma GCC unroll 4
  for (double* entry = row + first; entry != end; ++entry, tangents += step) *entry = *tangents;
}

/// A symmetric M₀ is inverted without pivoting, and its inverse read by rows or columns alike.
bool KernelWorkspace::Impl::has_symmetric_pattern() {
  if (!symmetric_pattern) symmetric_pattern = sparse::has_symmetric_pattern(kernel.program());
  return *symmetric_pattern;
}

/// Its factors.
KernelStatus KernelWorkspace::Impl::factor_full() {
  const std::size_t n = unknowns;
  need_full();
  if (!engine.are_finite(bordered.data(), n, n, n)) return KernelStatus::NonFinite;
  by_inverse = by_matrix && n == program.freedoms && has_symmetric_pattern() && engine.negative_inverse(bordered.data(), n, inverse.data());
  if (by_inverse) return KernelStatus::Ok;
  if (!solver) solver.emplace(program.freedoms, n - program.freedoms, n > program.freedoms || has_symmetric_pattern());
  std::copy(bordered.begin(), bordered.end(), solver->matrix().begin());
  if (const auto undetermined = solver->factor()) {
    singular = *undetermined;
    return KernelStatus::SingularMass;
  }
  return KernelStatus::Ok;
}

/// What the solutions of so many stages need, and how the later ones are to be found: by an inverse, if there is one of few unknowns or code for it.
/// (Rolled code may be without a solution.)
KernelStatus KernelWorkspace::Impl::factor(int stages) {
  has_full = by_inverse = by_lifting = false;
  later = LaterStages::StepByStep;
  if (lifted && lifted->has_pivots(memory)) {
    if (stages > 1 && compiled.solve && lifted->negative_inverse(memory, inverse.data()) && inverts()) {
      later = LaterStages::ByInverse;
      return KernelStatus::Ok;
    }
    by_lifting = lifted->factor(memory);
  }
  if (by_lifting) {
    if (stages > 1) later = LaterStages::ByLifting;
    return KernelStatus::Ok;
  }
  const KernelStatus status = factor_full();
  if (stages > 1 && by_inverse && unknowns > 0 && (compiled.solve || !compiled.stage)) later = LaterStages::ByInverse;
  return status;
}

/// Where the inverse does not solve.
KernelStatus KernelWorkspace::Impl::factor_anew() {
  by_lifting = lifted->factor(memory);
  later = by_lifting ? LaterStages::ByLifting : LaterStages::StepByStep;
  return by_lifting ? KernelStatus::Ok : factor_full();
}

/// unknown → its solution.
void KernelWorkspace::Impl::solve_factored() {
  if (by_lifting) lifted->solve(unknown);
  else solver->solve(unknown);
}

/// unknown = q̈_k.
KernelStatus KernelWorkspace::Impl::solve(int stage) {
  const double* const row = memory.row(stage);
  owed = nullptr;
  if (by_inverse) {
    const bool finite = engine.solve_by_inverse(inverse.data(), padded_unknowns(), row, program.residual.data(), unknowns, solution.data());
    return finite ? KernelStatus::Ok : KernelStatus::NonFinite;
  }
  const auto finite = [this] { return engine.are_finite(unknown.data(), unknowns, 1, unknowns) ? KernelStatus::Ok : KernelStatus::NonFinite; };
  if (later == LaterStages::ByInverse && stage == 0) {
    if (solve_twice_by_inverse(stage)) return finite();
    if (const KernelStatus status = factor_anew(); status != KernelStatus::Ok) return status;
  }
  if (by_lifting && lifted->is_rough(stage) && solve_twice(stage)) return finite();
  has_direction = false, owed = nullptr;
  fetch_residual(stage);
  if (stage > 0 || !by_lifting) {
    solve_factored();
  } else if (!lifted->solve_first(memory, unknown)) {
    by_lifting = false;
    if (const KernelStatus status = factor_full(); status != KernelStatus::Ok) return status;
    solve_factored();
  }
  return finite();
}

/// Whether −M₀⁻¹ solves for a right side in which all coordinates take part, each in its own measure: it was mirrored, which only a symmetric M₀
/// allows, and solutions by it are not corrected.
bool KernelWorkspace::Impl::inverts() {
  if (!has_probe) set_probe();
  engine.solve_by_inverse(inverse.data(), padded_unknowns(), probe.data(), program.residual.data(), unknowns, solution.data());
  find_direction();
  const auto [first, last] = residual_vectors;
  if (first != last) return engine.cancel(tangent.data() + first, probe.data() + first, largest_rest.data() + first, last - first);
  bool solves = true;
  for (const Slot slot : program.residual) solves &= std::abs(tangent[slot] + probe[slot]) <= largest_rest[slot];
  return solves;
}

/// Numbers of any sign, in the measure that the inverse gives a coordinate where it is asked first and has one for each.
void KernelWorkspace::Impl::set_probe() {
  std::uint32_t random = 1;
  has_probe = true;
  for (std::size_t i = 0; i < unknowns; ++i) {
    random = random * 1664525u + 1013904223u;
    const double part = (random & 0x10000) != 0 ? -1 - random * 0x1p-32 : 1 + random * 0x1p-32;
    const double size = std::sqrt(std::abs(inverse[i * padded_unknowns() + i]));
    const Slot slot = program.residual[i];
    probe[slot] = part / size;
    has_probe &= std::isfinite(probe[slot]);
    largest_rest[slot] = largest_rest_of_inverse * std::abs(probe[slot]);
  }
}

/// Code does not look at each stage: what is not finite goes on to the stages that follow, or stays where it is.
bool KernelWorkspace::Impl::are_coefficients_finite(int stages) const {
  return engine.are_finite(memory.row(3), memory.stride, static_cast<std::size_t>(stages - 1), unknowns);
}

/// unknown = −R_k, and 0 beyond, where a solution for what is not finite leaves the like.
void KernelWorkspace::Impl::fetch_residual(int stage) {
  const double* const row = memory.row(stage);
  for (std::size_t i = 0; i < unknowns; ++i) unknown[i] = -row[program.residual[i]];
  std::fill(solution.begin() + static_cast<std::ptrdiff_t>(unknowns), solution.end(), 0.0);
}

/// A rough solution, and one for what it leaves of −R_k, which the tangents tell. False: the second is not small beside the first, as it
/// is where the first holds.
bool KernelWorkspace::Impl::solve_twice(int stage) {
  const auto solve_for = [&](const double* row) {
    const double* const x = lifted->solve_row(row);
    engine.negate(x, solution.data(), unknowns);
    return x;
  };
  solve_for(memory.row(stage));
  find_direction();
  std::copy(unknown.begin(), unknown.end(), rough.begin());
  add_residual(stage);
  owed = solve_for(tangent.data());
  has_direction = true;
  return add_rough_solution();
}

/// The same by −M₀⁻¹.
bool KernelWorkspace::Impl::solve_twice_by_inverse(int stage) {
  const auto multiply = [this](const double* row) {
    engine.solve_by_inverse(inverse.data(), padded_unknowns(), row, program.residual.data(), unknowns, solution.data());
  };
  multiply(memory.row(stage));
  find_direction();
  std::copy(unknown.begin(), unknown.end(), rough.begin());
  add_residual(stage);
  multiply(tangent.data());
  return add_rough_solution();
}

/// To the tangents of the residual; where it stands alone, in vectors.
void KernelWorkspace::Impl::add_residual(int stage) {
  const double* const row = memory.row(stage);
  const auto [first, last] = residual_vectors;
  if (first != last) engine.add(tangent.data() + first, row + first, 1, last - first);
  else
    for (const Slot slot : program.residual) tangent[slot] += row[slot];
}

/// Slots from the residual's first vector to its last, if no coefficients that later orders read are among them, and no more besides than the residual has.
/// Else none.
std::pair<Slot, Slot> KernelWorkspace::Impl::find_residual_vectors() const {
  if (program.residual.empty()) return {0, 0};
  const auto [lowest, highest] = std::minmax_element(program.residual.begin(), program.residual.end());
  const Slot first = *lowest / packed::lanes * packed::lanes, last = static_cast<Slot>(packed::padded(*highest + 1));
  const bool stands_alone = first >= packed::padded(*std::max_element(program.stored_end.begin(), program.stored_end.end()));
  return stands_alone && last - first <= 2 * padded_unknowns() ? std::pair{first, last} : std::pair{Slot{0}, Slot{0}};
}

/// To its correction.
bool KernelWorkspace::Impl::add_rough_solution() {
  const packed::Sizes size = engine.add(rough.data(), unknown.data(), 1, unknowns);
  std::copy(rough.begin(), rough.begin() + static_cast<std::ptrdiff_t>(unknowns), unknown.begin());
  return size.change <= largest_correction * size.values;
}

/// All tangents in the direction of `unknown`.
void KernelWorkspace::Impl::find_direction() {
  std::copy(unknown.begin(), unknown.end(), tangent.begin());
  find_tangents(1);
}

/// Whether the rows of A that were dropped as dependent hold for the accelerations of the others.
bool KernelWorkspace::Impl::constraints_agree() {
  const std::size_t n = program.freedoms;
  for (std::size_t j = 0; n + j < unknowns; ++j) {
    if (keeps(j)) continue;
    const Slot slot = program.residual[n + j];
    double rest = memory.row(0)[slot], size = interpreter::term_size(memory, producer[slot], slot);
    for (std::size_t i = 0; i < n; ++i) {
      const double term = bordered[(n + j) * unknowns + i] * unknown[i];
      rest += term;
      size += std::abs(term);
    }
    if (std::abs(rest) <= 1e-6 * size) continue;
    contradicting = j;
    return false;
  }
  return true;
}

/// Coefficient k + 2 − ℓ of a slot of lag ℓ follows q̈_k with its order-0 tangents: one by one, or the tangent in the direction of q̈_k.
void KernelWorkspace::Impl::correct(int stage) {
  if (by_matrix) return engine.correct(tables, stage, tangents, solution.data());
  const double* const known = by_lifting && later != LaterStages::ByInverse ? lifted->tangents(stage) : nullptr;
  if (!known && !std::exchange(has_direction, false)) find_direction();
  correct(stage, known ? known : tangent.data(), 1);
  if (owed) correct(stage, std::exchange(owed, nullptr), -1);
}

/// By the tangents in one direction.
void KernelWorkspace::Impl::correct(int stage, const double* direction, double weight) {
  packed::TangentMatrix matrix = tangents;
  matrix.values = direction;
  matrix.directions = 1;
  engine.correct(tables, stage, matrix, &weight);
}

}  // namespace maupertuis
