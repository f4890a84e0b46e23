#include "kernel/workspace/inverse.hpp"

namespace maupertuis::workspace {

Inverse::Inverse(const Expansion& x, const ResidualPlaces& residual, const Tangents& tangents)
    : x_(x), residual_(residual), tangents_(tangents) {
  if (x.unknowns <= packed::most_by_inverse) values_.assign(x.padded_unknowns() * x.padded_unknowns(), 0.0);
  if (!tangents.are_of_each()) return;
  answers_.assign(x.unknowns * x.memory.stride, 0.0);
  find_own_vectors();
}

/// Which unknowns a corrected slot follows, by the graph of the tangents.
void Inverse::find_own_vectors() {
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

bool Inverse::find(FullMatrix& matrix) {
  const std::vector<double>& values = matrix.values();
  if (is_of(values)) return true;
  inverted_.clear();
  if (!x_.engine.negative_inverse(values.data(), x_.unknowns, values_.data())) return false;
  inverted_ = values;
  return true;
}

bool Inverse::find(FullMatrix& matrix, const FullFactors& factors) {
  const std::vector<double>& values = matrix.values();
  if (is_of(values)) return true;
  inverted_.clear();
  if (!factors.negative_inverse(values_.data(), x_.padded_unknowns())) return false;
  inverted_ = values;
  return true;
}

bool Inverse::solve(const double* row, double* x) const {
  return x_.engine.solve_by_inverse(values_.data(), x_.padded_unknowns(), row, residual_.slots.data(), x_.unknowns, x);
}

packed::InverseSolution Inverse::for_engine() {
  return {values_.data(), residual_.slots.data(), residual_.side_by_side, tangents_.matrix(),
          own_.data(),    answers_.data()};
}

}  // namespace maupertuis::workspace
