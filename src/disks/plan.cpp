#include "disks/plan.hpp"

#include "disks/degrees.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

DiskPlan::DiskPlan(const Program& of, std::span<const std::uint32_t> slots) : program(of) {
  std::vector<bool> made(program.slots, false);
  maker.assign(program.slots, -1);
  for (const maupertuis::Term& t : program.terms) terms.push_back({0, t.coefficient, t.a, t.b, t.shift});
  for (const Section section : {Dynamics, Along})
    for (const Run& run : program.runs[section])
      for (std::uint32_t i = run.first; i < run.last; ++i) {
        const Instruction& instruction = program.instructions[i];
        maker[instruction.out] = static_cast<int>(nodes.size());
        nodes.push_back({instruction, 0});
        made[instruction.out] = true;
        if (instruction.second != no_slot) made[instruction.second] = true;
      }
  for (const Slot slot : program.residual) residual.push_back(slot == no_slot ? -1 : maker[slot]);
  find_degrees();
  find_series(made);
  find_bases();
  find_needs(slots, true);
}

void DiskPlan::bound_only(std::span<const std::uint32_t> slots) {
  needed.clear();
  derived.clear();
  most_rates = 0;
  find_needs(slots, false);
  few.clear();
  for (const std::uint32_t at : needed)
    for (const Slot slot : {nodes[at].instruction.out, nodes[at].instruction.second})
      if (slot != no_slot && has_series[slot]) few.push_back(slot);
  constexpr std::size_t much_less = 8;
  only_few = few.size() * much_less < program.stored_end[2];
}

/// Backwards from the tails that are asked for. The tail of a sum needs the tails of its terms and the reaches of what
/// it multiplies; that of a function needs the reach of its operand.
void DiskPlan::find_needs(std::span<const std::uint32_t> slots, bool residual) {
  needs_reach.assign(program.slots, 0);
  needs_tail.assign(program.slots, 0);
  for (const Slot slot : program.residual)
    if (residual && slot != no_slot) needs_tail[slot] = 1;
  for (const Slot slot : slots) needs_tail[slot] = needs_reach[slot] = 1;
  for (std::size_t at = nodes.size(); at-- > 0;) {
    const Instruction& i = nodes[at].instruction;
    const auto needs = [&](Slot slot) { return slot != no_slot && (needs_tail[slot] || needs_reach[slot]); };
    if (!needs(i.out) && !needs(i.second)) continue;
    needed.push_back(static_cast<std::uint32_t>(at));
    need_operands(nodes[at]);
  }
  std::reverse(needed.begin(), needed.end());
  find_derived();
}

/// What is differentiated other than coordinates, and what that is made of.
void DiskPlan::find_derived() {
  std::vector<bool> wanted(program.slots, false);
  const auto want = [&](Slot slot) {
    if (slot != no_slot && slot >= program.unknowns && slot != program.time) wanted[slot] = true;
  };
  for (const std::uint32_t at : needed) {
    const Instruction& i = nodes[at].instruction;
    if (i.op == Op::Derivative && needs_reach[i.out]) want(i.a);
    const std::uint32_t last = i.op == Op::Linear ? i.last_term : i.op == Op::Products ? i.first_product : i.first_term;
    for (std::uint32_t t = i.first_term; t < last && needs_reach[i.out]; ++t)
      if (terms[t].shift > 0) want(terms[t].a);
  }
  for (auto at = needed.rbegin(); at != needed.rend(); ++at) {
    const Instruction& i = nodes[*at].instruction;
    if (!wanted[i.out] && !(i.second != no_slot && wanted[i.second])) continue;
    derived.push_back(*at);
    want(i.a), want(i.b);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) want(terms[t].a), want(terms[t].b);
  }
  std::reverse(derived.begin(), derived.end());
}

void DiskPlan::need_operands(const Node& node) {
  const Instruction& i = node.instruction;
  const auto need = [this](Slot slot, std::uint32_t shift, bool reach) {
    needs_tail[slot] = 1;
    if (!reach) return;
    needs_reach[slot] = 1;
    if (slot < program.unknowns) most_rates = std::max(most_rates, static_cast<int>(shift));
  };
  const bool hands_on = i.op == Op::Linear || i.op == Op::Products || i.op == Op::Derivative || i.op == Op::Select;
  const bool reach = needs_reach[i.out] != 0;
  for (const Slot slot : {i.a, i.b})
    if (slot != no_slot) need(slot, i.op == Op::Derivative ? 1 : 0, !hands_on || reach);
  if (!hands_on) return;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = terms[t];
    const bool multiplies = is_product(i, t);
    need(term.a, term.shift, multiplies || reach);
    if (multiplies) need(term.b, 0, true);
  }
}

/// Polynomials in t alone have no tail. A power with a constant exponent is not looked into.
void DiskPlan::find_degrees() {
  degree = degrees_in_time(program, not_polynomial);
  linear.assign(program.slots, true);
  for (const Node& node : nodes) {
    const Instruction& i = node.instruction;
    bool is_linear = false;
    if (i.op == Op::Linear || i.op == Op::Products || i.op == Op::Select) {
      is_linear = true;
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const bool is_known = !is_product(i, t) || degree[terms[t].a] + degree[terms[t].b] < not_polynomial;
        is_linear = is_linear && linear[terms[t].a] && is_known;
      }
    } else if (i.op == Op::Square) {
      is_linear = degree[i.out] < not_polynomial;
    } else if (i.op == Op::Derivative) {
      is_linear = linear[i.a];
    }
    linear[i.out] = is_linear;
    if (i.second != no_slot) linear[i.second] = false;
  }
  for (const Slot slot : program.residual)
    residual_has_tails = residual_has_tails || (slot != no_slot && !linear[slot]);
}

/// Stored slots hold all orders; so do those that nothing corrects, since no acceleration moves them.
void DiskPlan::find_series(const std::vector<bool>& made) {
  has_series.assign(program.slots, 0);
  for (Slot slot = static_cast<Slot>(program.unknowns); slot < program.slots; ++slot) {
    if (!made[slot]) continue;
    const bool stored = slot < program.stored_end[2];
    has_series[slot] = stored || program.tangent_lags[slot] == Program::unmoved;
    if (has_series[slot] && !stored) alone.push_back(slot);
  }
}

/// What is divided by or raised to a power, has all its known orders in the rows and is of degree 2 at most in q.
void DiskPlan::find_bases() {
  constexpr int more = 3;
  std::vector<int> in_q(program.slots, more);
  std::fill_n(in_q.begin(), program.unknowns, 1);
  if (program.one != no_slot) in_q[program.one] = 0;
  is_base.assign(program.slots, 0);
  std::vector<bool> is_kept_from_zero(program.slots, false);
  for (const Node& node : nodes) {
    const Instruction& i = node.instruction;
    if (i.op == Op::Quotient) is_kept_from_zero[i.b] = true;
    if (i.op == Op::Power || i.op == Op::SquareRoot) is_kept_from_zero[i.a] = true;
    const bool is_sum = i.op == Op::Linear || i.op == Op::Products;
    int highest = is_sum ? 0 : i.op == Op::Square ? 2 * in_q[i.a] : more;
    for (std::uint32_t t = i.first_term; is_sum && t < i.last_term; ++t) {
      const Term& term = terms[t];
      const bool multiplies = is_product(i, t);
      highest = std::max(highest, term.shift > 0 ? more : in_q[term.a] + (multiplies ? in_q[term.b] : 0));
    }
    in_q[i.out] = std::min(highest, more);
  }
  // A product keeps from 0 what its factors keep from 0: w of 1/w⁶.
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    const Instruction& i = node->instruction;
    if (!is_kept_from_zero[i.out]) continue;
    if (i.op == Op::Square) is_kept_from_zero[i.a] = true;
    if (i.op == Op::Products && i.first_product == i.first_term && i.last_term - i.first_term == 1)
      is_kept_from_zero[terms[i.first_term].a] = is_kept_from_zero[terms[i.first_term].b] = true;
  }
  for (const Node& node : nodes) {
    const Instruction& i = node.instruction;
    if (!is_kept_from_zero[i.out] || !has_series[i.out] || in_q[i.out] == 0 || in_q[i.out] == more) continue;
    is_base[i.out] = 1;
    bases.push_back(i.out);
  }
}

void DiskPlan::set_constants(const double* values) {
  constants = values;
  for (Term& term : terms) term.size = std::abs(values[term.coefficient]);
  constexpr double most_halves = 32;
  for (Node& node : nodes) {
    if (node.instruction.op != Op::Power) continue;
    node.exponent = values[node.instruction.constant];
    const double twice = 2 * node.exponent;
    const bool is_half = std::abs(twice) <= most_halves && std::abs(std::remainder(twice, 2)) == 1;
    node.halves = is_half ? static_cast<int>(twice) : 0;
  }
}

}  // namespace maupertuis
