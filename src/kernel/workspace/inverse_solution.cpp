#include "kernel/workspace/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

/// −M₀⁻¹: what the engine asks of it, and whether one that code has found can be believed.
namespace maupertuis::workspace {
namespace {

/// What the inverse may leave of a right side: beyond, the sparse factors solve better.
constexpr double largest_rest_of_inverse = 1e-11;

}  // namespace

packed::InverseSolution StageSolver::inverse_solution() {
  return {inverse_.data(), x_.program.residual.data(), residual_side_by_side_, tangents_, own_.data(), answers_.data()};
}

bool StageSolver::is_residual_side_by_side() const {
  for (std::size_t i = 0; i < x_.unknowns; ++i)
    if (x_.program.residual[i] != x_.program.residual[0] + i) return false;
  return true;
}

/// Which unknowns a corrected slot follows, by the graph of the tangents.
void StageSolver::find_own_vectors() {
  if (!by_matrix_) return;
  std::vector<std::uint32_t> followed(x_.packed.cells, 0);  // a bit for each unknown
  for (std::size_t d = 0; d < x_.unknowns; ++d) followed[d] = 1u << d;
  for (const sparse::Edge& edge : sparse::tangent_edges(x_.program)) followed[edge.out] |= followed[edge.operand];
  for (std::size_t slot = x_.padded_unknowns(); slot < x_.program.stored_end[2]; slot += packed::lanes) {
    const auto follows_own = [&](std::size_t vector) {
      for (std::size_t lane = 0; lane < packed::lanes; ++lane)
        if ((followed[slot + lane] & ~(std::uint64_t{1} << (vector * packed::lanes + lane))) != 0) return false;
      return true;
    };
    own_.push_back(follows_own(0) ? 0 : x_.padded_unknowns() > packed::lanes && follows_own(1) ? 1 : -1);
  }
}

/// Whether −M₀⁻¹ solves for a right side in which all coordinates take part, each in its own measure: it was mirrored,
/// which only a symmetric M₀ allows, and solutions by it are not corrected.
bool StageSolver::inverts() {
  if (!has_probe_) set_probe();
  x_.engine.solve_by_inverse(inverse_.data(), x_.padded_unknowns(), probe_.data(), x_.program.residual.data(),
                             x_.unknowns, solution_.data());
  find_direction();
  const auto [first, last] = residual_vectors_;
  if (first != last)
    return x_.engine.cancel(tangent_.data() + first, probe_.data() + first, largest_rest_.data() + first, last - first);
  bool solves = true;
  for (const Slot slot : x_.program.residual) solves &= std::abs(tangent_[slot] + probe_[slot]) <= largest_rest_[slot];
  return solves;
}

/// Numbers of any sign, in the measure that the inverse gives a coordinate where it is asked first and has one for
/// each.
void StageSolver::set_probe() {
  std::uint32_t random = 1;
  has_probe_ = true;
  for (std::size_t i = 0; i < x_.unknowns; ++i) {
    random = random * 1664525u + 1013904223u;
    const double part = (random & 0x10000) != 0 ? -1 - random * 0x1p-32 : 1 + random * 0x1p-32;
    const double size = std::sqrt(std::abs(inverse_[i * x_.padded_unknowns() + i]));
    const Slot slot = x_.program.residual[i];
    probe_[slot] = part / size;
    has_probe_ &= std::isfinite(probe_[slot]);
    largest_rest_[slot] = largest_rest_of_inverse * std::abs(probe_[slot]);
  }
}

}  // namespace maupertuis::workspace
