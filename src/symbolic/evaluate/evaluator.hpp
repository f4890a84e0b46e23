#pragma once
#include <maupertuis/require.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <vector>

namespace maupertuis::evaluation {

template <class Value, class Operation>
Value folded(std::span<const Position> operands, const std::vector<Value>& values, Operation operation) {
  Value result = values[operands[0]];
  for (std::size_t i = 1; i < operands.size(); ++i) result = operation(result, values[operands[i]]);
  return result;
}

/// The value of one node from those of its arguments, over any kind of numbers.
///
/// `Numbers` supplies the ring (Value, number, pi, symbol, add, multiply) and `function(tape, at, values)` for every
/// other node: powers, elementary functions, switches; it throws on a kind that it has no rule for. RealNumbers,
/// FieldNumbers and JetNumbers are such kinds.
template <class Numbers>
void run_node(const Tape& tape, Numbers& numbers, Position at, std::vector<typename Numbers::Value>& values) {
  const auto arguments = tape.arguments(at);
  const Kind kind = tape.kind(at);
  if (kind == Kind::Number)
    values[at] = numbers.number(tape.expression(at).number());
  else if (kind == Kind::Pi)
    values[at] = numbers.pi();
  else if (kind == Kind::Symbol)
    values[at] = numbers.symbol(tape.expression(at));
  else if (kind == Kind::Sum)
    values[at] = folded(arguments, values, [&](const auto& a, const auto& b) { return numbers.add(a, b); });
  else if (kind == Kind::Product)
    values[at] = folded(arguments, values, [&](const auto& a, const auto& b) { return numbers.multiply(a, b); });
  else
    values[at] = numbers.function(tape, at, values);
}

/// Walks a tape once. Positions that are not `chosen` keep the values they have.
template <class Numbers, class Chosen>
void run(const Tape& tape, Numbers& numbers, std::vector<typename Numbers::Value>& values, Chosen chosen) {
  values.resize(tape.size());
  for (Position at = 0; at < tape.size(); ++at)
    if (chosen(at)) run_node(tape, numbers, at, values);
}

template <class Numbers>
void run(const Tape& tape, Numbers& numbers, std::vector<typename Numbers::Value>& values) {
  run(tape, numbers, values, [](Position) { return true; });
}

/// Is condition i of a piecewise node the index of a condition (else of a value)?
inline bool is_condition(std::size_t index, std::size_t count) { return index % 2 == 0 && index + 1 < count; }

}  // namespace maupertuis::evaluation
