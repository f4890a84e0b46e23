#include <maupertuis/scattered_point.hpp>
#include <maupertuis/seen_nonzero.hpp>

#include "symbolic/evaluate/witness.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include "symbolic/evaluate/interval.hpp"
#include "symbolic/evaluate/prime_field.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis::evaluation {

Bindings random_real_point(const Tape& tape, int trial, std::uint64_t seed) {
  Bindings point;
  for (Position at = 0; at < tape.size(); ++at) {
    if (tape.kind(at) != Kind::Symbol) continue;
    const Expr symbol = tape.expression(at);
    const std::uint64_t random = mix(mix(seed ^ static_cast<std::uint64_t>(trial)) ^ symbol.id());
    const double unit = static_cast<double>(random >> 11) * 0x1p-53;  // [0, 1)
    double value = 0.25 + 2 * unit;
    if (trial % 4 == 3) value = std::pow(10.0, 8 * unit - 3);  // for what happens far out
    // Parameters are positive in most models; the others have either sign, and all have it in every other trial.
    const bool may_be_negative = symbol.role() != Role::Parameter && symbol.role() != Role::Constant;
    if ((trial % 2 == 1 || may_be_negative) && trial % 3 != 2 && (mix(random) & 1)) value = -value;
    point.emplace(symbol, value);
  }
  return point;
}

namespace {

using Range = Interval<double>;

bool excludes_zero(const Range& v) {
  return !v.is_nan() && !v.contains_zero() && std::isfinite(v.low) && std::isfinite(v.high);
}

}  // namespace

std::optional<Witness> find_witness(const Tape& tape, int points, std::uint64_t seed) {
  std::vector<Range> values;
  for (int trial = 0; trial < points; ++trial) {
    interrupt_of(tape.expression(0).context()).throw_if_asked();
    const Bindings point = random_real_point(tape, trial, seed);
    RealNumbers<Range> numbers([&](Expr symbol) {
      const double x = point.at(symbol);
      return Range{x, x};
    });
    run(tape, numbers, values);
    for (std::size_t i = 0; i < tape.roots().size(); ++i) {
      const Range& v = values[tape.roots()[i]];
      if (excludes_zero(v)) return Witness{point, v.low / 2 + v.high / 2, i};
    }
  }
  return std::nullopt;
}

}  // namespace maupertuis::evaluation

namespace maupertuis {

std::vector<bool> seen_nonzero(std::span<const Expr> expressions) {
  using namespace evaluation;
  std::vector<bool> seen(expressions.size(), false);
  if (expressions.empty()) return seen;
  const Tape tape(expressions);
  std::vector<Range> values;
  for (int trial = 0; trial < 2; ++trial) {
    const Bindings point = random_real_point(tape, trial, ZeroTestOptions{}.seed);
    RealNumbers<Range> numbers([&](Expr symbol) {
      const double x = point.at(symbol);
      return Range{x, x};
    });
    run(tape, numbers, values);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (excludes_zero(values[tape.roots()[i]])) seen[i] = true;
  }
  return seen;
}

Bindings scattered_point(std::span<const Expr> symbols, int turn) {
  constexpr double golden = 0.6180339887498949, another = 0.2763932022500211, least = 0.4;
  Bindings point;
  double place = 0.31;
  for (const Expr& symbol : symbols) {
    place = std::fmod(place + golden, 1.0);
    const bool held = symbol.role() == Role::Parameter || symbol.role() == Role::Constant;
    point[symbol] = least + (held ? place : std::fmod(place + another * turn, 1.0));
  }
  return point;
}

}  // namespace maupertuis
