#include "kernel/lanes/plan.hpp"

#include "kernel/lanes/lanes.hpp"

#include <algorithm>

namespace maupertuis::lanes {

Plan::Plan(const Program& program) : program_(program), moves_(program.slots) {
  for (std::uint32_t d = 0; d < program.unknowns; ++d) moves_[d] = {{d}, 0};  // tangent 0 is the number 1
  tangents_ = 1;
  std::vector<bool> needed(program.slots, false);  // stored slots, and the residual
  for (const Slot slot : program.residual) needed[slot] = program.tangent_lags[slot] == 2;
  for (Slot slot = 0; slot < program.stored_end[2]; ++slot) needed[slot] = true;
  const std::vector<sparse::Edge> edges = sparse::edges_to(program, std::move(needed));
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last =
        std::find_if(first, edges.end(), [&](const sparse::Edge& edge) { return edge.out != first->out; });
    add_result({&*first, static_cast<std::size_t>(last - first)});
    first = last;
  }
  for (std::uint32_t row = 0; row < program.unknowns; ++row) {
    const Slot slot = program.residual[row];
    if (program.tangent_lags[slot] != 2) continue;
    for (const std::uint32_t d : moves_[slot].directions) mass_.push_back({row, d, tangent_of(slot, d)});
  }
  add_corrections(program);
}

/// The edges of one slot: a tangent in each direction in which one of its operands moves.
void Plan::add_result(std::span<const sparse::Edge> edges) {
  const auto first_factor = static_cast<std::uint32_t>(factors_.size());
  factors_.insert(factors_.end(), edges.begin(), edges.end());
  Moves& moves = moves_[edges[0].out];
  for (const sparse::Edge& edge : edges)
    moves.directions.insert(moves.directions.end(), moves_[edge.operand].directions.begin(),
                            moves_[edge.operand].directions.end());
  std::sort(moves.directions.begin(), moves.directions.end());
  moves.directions.erase(std::unique(moves.directions.begin(), moves.directions.end()), moves.directions.end());
  moves.first = tangents_;
  for (const std::uint32_t direction : moves.directions) {
    const auto first = static_cast<std::uint32_t>(pairs_.size());
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      const auto& of_operand = moves_[edges[e].operand].directions;
      if (std::binary_search(of_operand.begin(), of_operand.end(), direction))
        pairs_.push_back({first_factor + e, tangent_of(edges[e].operand, direction)});
    }
    combinations_.push_back(
        {tangents_++, first, static_cast<std::uint32_t>(pairs_.size()), edges[0].rule == sparse::Rule::Choice});
  }
}

std::uint32_t Plan::tangent_of(Slot slot, std::size_t direction) const {
  const Moves& moves = moves_[slot];
  const auto at = std::lower_bound(moves.directions.begin(), moves.directions.end(), direction);
  return moves.first + static_cast<std::uint32_t>(at - moves.directions.begin());
}

void Plan::add_corrections(const Program& program) {
  Slot slot = static_cast<Slot>(program.unknowns);
  for (std::size_t lag = 0; lag <= 2; ++lag) {
    for (; slot < program.stored_end[lag]; ++slot) {
      const auto first = static_cast<std::uint32_t>(correction_terms_.size());
      for (const std::uint32_t d : moves_[slot].directions) correction_terms_.push_back({d, tangent_of(slot, d)});
      const auto last = static_cast<std::uint32_t>(correction_terms_.size());
      if (last > first) corrections_.push_back({slot, first, last});
    }
    corrections_end_[lag] = corrections_.size();
  }
}

PlanView Plan::view() const {
  PlanView v{};
  v.instructions = program_.instructions.data();
  v.terms = program_.terms.data();
  v.runs = program_.runs[Dynamics].data();
  v.run_count = program_.runs[Dynamics].size();
  v.factors = factors_.data();
  v.factor_count = factors_.size();
  v.pairs = pairs_.data();
  v.combinations = combinations_.data();
  v.combination_count = combinations_.size();
  v.tangent_count = tangents_;
  v.mass = mass_.data();
  v.mass_count = mass_.size();
  v.corrections = corrections_.data();
  v.correction_terms = correction_terms_.data();
  for (std::size_t lag = 0; lag < 3; ++lag) v.corrections_end[lag] = corrections_end_[lag];
  v.residual = program_.residual.data();
  v.unknowns = program_.unknowns;
  v.stride = row_stride(program_);
  v.first_stage = program_.first_stage;
  return v;
}

}  // namespace maupertuis::lanes
