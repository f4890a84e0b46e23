#include "kernel/program/point_orders.hpp"
#include "kernel/unrolled/unrolling.hpp"

namespace maupertuis::unrolled {

using packed::Pack;

Slots Unrolling::slots_of(std::uint32_t block) const {
  const packed::Block& b = packed_.blocks[block];
  return {b.slots.begin(), b.slots.begin() + b.width};
}

static Slots range(Slot first, std::size_t count) {
  Slots out;
  for (Slot s = first; s < first + count; ++s) out.push_back(s);
  return out;
}

Value Unrolling::constant(ConstantId id) {
  const Constant& c = p_.constants[id];
  return c.kind == Kind::Number ? to_.literal(c.value) : to_.given(Constants, id);
}

/// Numbers of the model's text are numbers of the code.
Value Unrolling::coefficients(std::uint32_t first, std::size_t count) {
  std::vector<Value> lanes;
  for (std::uint32_t i = 0; i < width_of(count); ++i) {
    lanes.push_back(constant(packed_.coefficients[first + i]));
    if (!to_.is_literal(lanes.back())) return to_.wide_given(Coefficients, first, width_of(count));
  }
  return to_.gather(lanes);
}

void Unrolling::add(Step step) {
  for (const Slot slot : step.out) step_of_[slot] = static_cast<int>(steps_.size());
  steps_.push_back(std::move(step));
}

void Unrolling::add_steps(const Pack& pack) {
  Step step{.lag = pack.lag, .out = range(pack.out, pack.width)};
  switch (pack.kind) {
    case Pack::Sum:
      return add_sum(pack, std::move(step));
    case Pack::Integral:
      step.kind = Step::Integral;
      step.products = {{slots_of(pack.a), slots_of(pack.b), coefficients(pack.coefficients, pack.width)}};
      for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f)
        step.functions.push_back(packed_.functions[f]);
      return add(std::move(step));
    case Pack::Quotient:
      step.kind = Step::Quotient;
      step.products = {{slots_of(pack.a), slots_of(pack.b), none}};
      return add(std::move(step));
    case Pack::SquareRoot:
      step.kind = Step::Root;
      step.products = {{slots_of(pack.a), {}, none}};
      return add(std::move(step));
    case Pack::Scalar:
      return add_instruction(p_.instructions[pack.instruction]);
    // of large systems alone, which are not unrolled
    case Pack::Scan:
    case Pack::ScanDown:
    case Pack::Strand:
    case Pack::Join:
    case Pack::JoinDown:
      return;
  }
}

void Unrolling::add_sum(const Pack& pack, Step step) {
  for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c) {
    const packed::Column& column = packed_.columns[c];
    Slots slots(pack.width, column.source);
    if (column.kind != packed::Column::Broadcast) slots = {column.sources.begin(), column.sources.begin() + pack.width};
    step.columns.push_back({std::move(slots), column.shift, coefficients(column.coefficients, pack.width)});
  }
  for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
    const packed::ProductTerm& t = packed_.products[i];
    step.products.push_back({slots_of(t.a), slots_of(t.b), coefficients(t.coefficients, pack.width)});
  }
  add(std::move(step));
}

/// An instruction as a step of one lane.
void Unrolling::add_instruction(const Instruction& i) {
  if (std::optional<Step> step = step_for(i)) add(std::move(*step));
}

void Unrolling::add_points() {
  const std::vector<int> orders = point_orders(p_);
  for (const Run& run : p_.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (orders[i] >= 0) points_.push_back({*step_for(p_.instructions[i]), orders[i]});
}

/// Empty for leaves, and for pairs in section Dynamics, which are packs.
std::optional<Step> Unrolling::step_for(const Instruction& i) {
  Step step{.lag = i.lag, .out = {i.out}};
  const Value one = to_.literal(1);
  switch (i.op) {
    case Op::Linear:
    case Op::Products:
    case Op::Function:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const auto& [coefficient, a, b, shift] = p_.terms[t];
        if (b == no_slot)
          step.columns.push_back({{a}, static_cast<int>(shift), constant(coefficient)});
        else if (i.op == Op::Function)
          step.products.push_back({{b}, {a}, constant(coefficient)});
        else
          step.products.push_back({{a}, {b}, constant(coefficient)});
      }
      if (i.op == Op::Function)
        step.kind = Step::Integral, step.functions = {static_cast<std::uint32_t>(&i - p_.instructions.data())};
      return step;
    case Op::Square:
      step.products = {{{i.a}, {i.a}, one}};
      return step;
    case Op::Derivative:
      step.columns = {{{i.a}, 1, one}};
      return step;
    case Op::Quotient:
      step.kind = Step::Quotient, step.products = {{{i.a}, {i.b}, none}};
      return step;
    case Op::SquareRoot:
      step.kind = Step::Root, step.products = {{{i.a}, {}, none}};
      return step;
    case Op::Power:
      step.kind = Step::Power, step.products = {{{i.a}, {}, constant(i.constant)}};
      return step;
    case Op::SinCos:
    case Op::SinhCosh:
      step.kind = Step::Integral, step.out = {i.out, i.second};
      step.functions = {static_cast<std::uint32_t>(&i - p_.instructions.data())};
      return step;
    // leaves, and what is not unrolled
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
    case Op::Select:
      break;
  }
  return std::nullopt;
}

}  // namespace maupertuis::unrolled
