#pragma once
#include <maupertuis/require.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <vector>

namespace maupertuis::evaluation {

/// Walks a tape once over any kind of numbers.
///
/// `Numbers` supplies the ring (Value, number, pi, symbol, add, multiply) and `function(tape, at, values)` for every
/// other node: powers, elementary functions, switches. RealNumbers, FieldNumbers and JetNumbers are such kinds.
/// Positions that are not `chosen` keep the values they have.
template <class Numbers, class Chosen>
void run(const Tape& tape, Numbers& numbers, std::vector<typename Numbers::Value>& values, Chosen chosen) {
  values.resize(tape.size());
  for (Position at = 0; at < tape.size(); ++at) {
    if (!chosen(at)) continue;
    const auto arguments = tape.arguments(at);
    switch (tape.kind(at)) {
      case Kind::Number: values[at] = numbers.number(tape.expression(at).number()); break;
      case Kind::Pi: values[at] = numbers.pi(); break;
      case Kind::Symbol: values[at] = numbers.symbol(tape.expression(at)); break;
      case Kind::Sum: {
        auto sum = values[arguments[0]];
        for (std::size_t i = 1; i < arguments.size(); ++i) sum = numbers.add(sum, values[arguments[i]]);
        values[at] = sum;
        break;
      }
      case Kind::Product: {
        auto product = values[arguments[0]];
        for (std::size_t i = 1; i < arguments.size(); ++i) product = numbers.multiply(product, values[arguments[i]]);
        values[at] = product;
        break;
      }
      default: values[at] = numbers.function(tape, at, values);
    }
  }
}

template <class Numbers>
void run(const Tape& tape, Numbers& numbers, std::vector<typename Numbers::Value>& values) {
  run(tape, numbers, values, [](Position) { return true; });
}

/// Is condition i of a piecewise node the index of a condition (else of a value)?
inline bool is_condition(std::size_t index, std::size_t count) { return index % 2 == 0 && index + 1 < count; }

}  // namespace maupertuis::evaluation
