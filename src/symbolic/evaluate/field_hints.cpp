#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/interval.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

#include <maupertuis/kinds.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace maupertuis::evaluation {
namespace {

constexpr std::uint64_t largest_multiple = 1u << 22;

void note_multiple_of_pi(const Tape& tape, Position at, FieldHints& hints) {
  if (tape.kind(at) == Kind::Sum) {
    for (const Position term : tape.arguments(at)) note_multiple_of_pi(tape, term, hints);
    return;
  }
  const TermView term = term_view(tape, at);
  const auto c = term.coefficient.small();
  if (tape.kind(term.rest) != Kind::Pi || !c || c->denominator > 4096) return;
  const std::uint64_t used =
      std::lcm(std::max<std::uint64_t>(hints.m_used, 2), 2 * static_cast<std::uint64_t>(c->denominator));
  if (std::lcm(used, std::uint64_t{840}) > largest_multiple) return;
  hints.m_used = used;
  hints.m = std::lcm(used, std::uint64_t{840});
}

/// Whether the sign of this node is asked of its first argument.
bool asks_sign(const Tape& tape, Position at) {
  const Kind kind = tape.kind(at);
  if (kind == Kind::Log || family_of(kind) == Family::Switch) return true;
  if (kind != Kind::Power) return false;
  const Expr exponent = tape.expression(tape.argument(at, 1));
  return !exponent.is_number() || !exponent.number().is_integer();
}

/// Ranges over the whole line; a rate d/dt may be anything.
struct RangeNumbers : RealNumbers<Interval<double>> {
  using RealNumbers::RealNumbers;
  Value function(const Tape& tape, Position at, const std::vector<Value>& values) const {
    return tape.kind(at) == Kind::TimeDerivative ? Value::whole() : RealNumbers::function(tape, at, values);
  }
};

/// Signs that hold for all real values of the symbols, by interval arithmetic over the whole line.
std::vector<std::int8_t> definite_signs(const Tape& tape) {
  using Range = Interval<double>;
  RangeNumbers numbers([](Expr) { return Range::whole(); });
  std::vector<Range> values;
  run(tape, numbers, values);
  std::vector<std::int8_t> signs(tape.size(), 0);
  for (Position at = 0; at < tape.size(); ++at) signs[at] = values[at].low >= 0 ? 1 : values[at].high <= 0 ? -1 : 0;
  return signs;
}

/// What matters only where a piece is in force: a value or a later condition of piecewise, a factor beside one that
/// switches and may be 0 (derivatives of pieces are written so: log x · piecewise(0 < x : 1, else : 0)), and what
/// stands below these and nowhere else.
std::vector<bool> nodes_in_pieces(const Tape& tape) {
  std::vector<bool> in_a_piece(tape.size(), true), switches(tape.size(), false);
  for (Position at = 0; at < tape.size(); ++at) {
    switches[at] = has_switch(tape.kind(at));
    for (const Position argument : tape.arguments(at)) switches[at] = switches[at] || switches[argument];
  }
  for (const Position root : tape.roots()) in_a_piece[root] = false;
  for (Position at = static_cast<Position>(tape.size()); at-- > 0;) {
    if (in_a_piece[at]) continue;
    const auto arguments = tape.arguments(at);
    const auto switching = std::count_if(arguments.begin(), arguments.end(), [&](Position x) { return switches[x]; });
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const bool guarded = tape.kind(at) == Kind::Piecewise ? i > 0
                           : tape.kind(at) == Kind::Product ? switching > (switches[arguments[i]] ? 1 : 0)
                                                            : false;
      if (!guarded) in_a_piece[arguments[i]] = false;
    }
  }
  return in_a_piece;
}

/// Which nodes ask for a sign, and of each symbol below them the first.
void find_askers(const Tape& tape, const std::vector<Position>& askers, FieldHints& hints) {
  std::vector<char> met(tape.size(), 0);
  for (Position k = 0; k < askers.size(); ++k) {
    hints.asking.emplace(askers[k], tape.expression(tape.argument(askers[k], 0)));
    std::vector<Position> open{tape.argument(askers[k], 0)};
    while (!open.empty()) {
      const Position node = open.back();
      open.pop_back();
      if (std::exchange(met[node], 1)) continue;
      if (tape.kind(node) == Kind::Symbol) hints.met_by.emplace(tape.expression(node).id(), k);
      for (const Position argument : tape.arguments(node)) open.push_back(argument);
    }
  }
}

}  // namespace

int mends_allowed(const Tape& tape) {
  return static_cast<int>(std::min<std::size_t>(4000, 20'000'000 / (tape.size() + 1)));
}

int definite_sign(Expr e) { return definite_signs(Tape({&e, 1})).back(); }

FieldHints field_hints(const Tape& tape) {
  FieldHints hints;
  hints.in_a_piece = nodes_in_pieces(tape);
  std::vector<Position> askers;
  for (Position at = 0; at < tape.size(); ++at) {
    const Kind kind = tape.kind(at);
    if (kind == Kind::Sin || kind == Kind::Cos || kind == Kind::Tan)
      note_multiple_of_pi(tape, tape.argument(at, 0), hints);
    if (!asks_sign(tape, at)) continue;
    askers.push_back(at);
    const Expr argument = tape.expression(tape.argument(at, 0));
    const bool under_root = kind == Kind::Log || kind == Kind::Power;
    if (argument.is_symbol() && under_root && !hints.in_a_piece[at]) hints.positive.insert(argument.id());
  }
  if (askers.empty()) return hints;
  hints.sign = definite_signs(tape);
  find_askers(tape, askers, hints);
  return hints;
}

}  // namespace maupertuis::evaluation
