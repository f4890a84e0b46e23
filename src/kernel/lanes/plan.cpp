#include "kernel/lanes/plan.hpp"

#include "kernel/lanes/lanes.hpp"

#include <algorithm>

namespace maupertuis::lanes {
namespace {

/// Calls f(operand, factor) for every operand of `out` (the instruction's first or second result) that has the lag of the
/// instruction: the others hold lower derivatives and are constants here. As in kernel/interpreter/tangents.cpp.
template <class F>
void for_partials(const Program& program, const Instruction& i, Slot out, F&& f) {
  using K = Factor::Kind;
  const auto pass = [&](Slot operand, Factor factor, std::uint32_t shift = 0) {
    if (program.tangent_lags[operand] + static_cast<int>(shift) == i.lag) f(operand, factor);
  };
  switch (i.op) {
    case Op::Linear:
    case Op::Products:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const Term& term = program.terms[t];
        if (term.b == no_slot) { pass(term.a, {K::Constant, term.coefficient}, term.shift); continue; }
        pass(term.a, {K::Scaled, term.coefficient, term.b});
        pass(term.b, {K::Scaled, term.coefficient, term.a});
      }
      return;
    case Op::Square: return pass(i.a, {K::Twice, 0, i.a});
    case Op::Quotient:
      pass(i.a, {K::Reciprocal, 0, i.b});
      pass(i.b, {K::Slope, 0, i.out, i.b});
      return;
    case Op::SquareRoot: return pass(i.a, {K::HalfRoot, 0, i.out});
    case Op::Power: return pass(i.a, {K::Exponent, i.constant, i.out, i.a});
    case Op::SinCos: return pass(i.a, out == i.out ? Factor{K::Plus, 0, i.second} : Factor{K::Minus, 0, i.out});
    case Op::SinhCosh: return pass(i.a, {K::Plus, 0, out == i.out ? i.second : i.out});
    case Op::Function:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        pass(program.terms[t].b, {K::Scaled, program.terms[t].coefficient, program.terms[t].a});
      return;
    case Op::Derivative: return pass(i.a, {K::One}, 1);
    case Op::Select:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        pass(program.terms[t].a, {K::Chosen, i.first_term, t, i.last_term});
      return;
    case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: return;
  }
  throw unknown_op(i.op, "the plan of lanes");
}

template <class F>
void for_results(const Instruction& i, F&& f) {
  f(i.out);
  if (i.second != no_slot) f(i.second);
}

bool is_moved(const Program& program, const Instruction& i) {
  return program.tangent_lags[i.out] != Program::unmoved;
}

}  // namespace

Plan::Plan(const Program& program) : program_(program), needed_(program.slots, false), moves_(program.slots) {
  find_needed(program);
  for (std::uint32_t d = 0; d < program.unknowns; ++d) moves_[d] = {{d}, 0};  // tangent 0 is the number 1
  tangents_ = 1;
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (is_moved(program, program.instructions[i])) add_instruction(program, program.instructions[i]);
  for (std::uint32_t row = 0; row < program.unknowns; ++row) {
    const Slot slot = program.residual[row];
    if (program.tangent_lags[slot] != 2) continue;
    for (const std::uint32_t d : moves_[slot].directions) mass_.push_back({row, d, tangent_of(slot, d)});
  }
  add_corrections(program);
}

/// Backwards from the residual and the stored slots along the operands that pass the highest derivative on.
void Plan::find_needed(const Program& program) {
  for (const Slot slot : program.residual) needed_[slot] = program.tangent_lags[slot] == 2;
  for (Slot slot = 0; slot < program.stored_end[2]; ++slot) needed_[slot] = true;
  const auto& runs = program.runs[Dynamics];
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    for (std::uint32_t i = run->last; i-- > run->first;)
      for_results(program.instructions[i], [&](Slot out) {
        if (needed_[out] && is_moved(program, program.instructions[i]))
          for_partials(program, program.instructions[i], out, [&](Slot operand, const Factor&) { needed_[operand] = true; });
      });
}

void Plan::add_instruction(const Program& program, const Instruction& i) {
  for_results(i, [&](Slot out) {
    if (!needed_[out]) return;
    edges_.clear();
    for_partials(program, i, out, [&](Slot operand, const Factor& factor) {
      if (moves_[operand].directions.empty()) return;
      edges_.push_back({static_cast<std::uint32_t>(factors_.size()), operand});
      factors_.push_back(factor);
    });
    Moves& moves = moves_[out];
    for (const Edge& edge : edges_)
      moves.directions.insert(moves.directions.end(), moves_[edge.operand].directions.begin(),
                              moves_[edge.operand].directions.end());
    std::sort(moves.directions.begin(), moves.directions.end());
    moves.directions.erase(std::unique(moves.directions.begin(), moves.directions.end()), moves.directions.end());
    moves.first = tangents_;
    for (const std::uint32_t direction : moves.directions) {
      const auto first = static_cast<std::uint32_t>(pairs_.size());
      for (const Edge& edge : edges_) {
        const auto& of_operand = moves_[edge.operand].directions;
        if (std::binary_search(of_operand.begin(), of_operand.end(), direction))
          pairs_.push_back({edge.factor, tangent_of(edge.operand, direction)});
      }
      combinations_.push_back({tangents_++, first, static_cast<std::uint32_t>(pairs_.size()), i.op == Op::Select});
    }
  });
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
