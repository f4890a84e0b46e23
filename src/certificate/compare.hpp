#pragma once
#include "certificate/route_results.hpp"
#include "certificate/routes.hpp"

#include <algorithm>

namespace maupertuis::certification {

inline std::size_t orders_needed(const evaluation::Tape& tape) {
  return std::max<std::size_t>(3, 2 + evaluation::depth_of_time_derivatives(tape));
}

template <class Value>
void append(std::vector<Value>& to, const std::vector<Value>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// d'Alembert's principle where quaternions turn bodies: along a path of rotations.
template <class Numbers>
std::vector<typename Numbers::Value> dalembert_among_rotations(const Questions& questions, const evaluation::Tape& tape,
                                                               Numbers& numbers, std::size_t orders,
                                                               std::vector<typename Numbers::Value> direction,
                                                               std::vector<Jet<typename Numbers::Value>>& values) {
  RandomPath<Numbers> path(questions, numbers, orders, direction);
  path.keep_to_rotations(questions, direction);
  JetNumbers<Numbers> jets(numbers, orders, [&](Expr symbol) { return path(symbol); });
  evaluation::run(tape, jets, values);
  std::vector<typename Numbers::Value> out;
  for (std::size_t k = 0; k < questions.answers(); ++k)
    append(out, dalembert_route(PathValues<Numbers>{questions, k, jets, tape, values, direction}));
  return out;
}

/// Walks the questions once along the random path that belongs to `numbers` and the direction; the differences of all
/// answers. Positions of the tape that are not `chosen` keep their values.
template <class Numbers, class Chosen>
std::array<std::vector<typename Numbers::Value>, RouteCount> differences(
    const Questions& questions, const evaluation::Tape& tape, Numbers& numbers, std::size_t orders,
    const std::vector<typename Numbers::Value>& direction, std::vector<Jet<typename Numbers::Value>>& values,
    Chosen chosen) {
  RandomPath<Numbers> path(questions, numbers, orders, direction);
  JetNumbers<Numbers> jets(numbers, orders, [&](Expr symbol) { return path(symbol); });
  evaluation::run(tape, jets, values, chosen);
  std::array<std::vector<typename Numbers::Value>, RouteCount> out;
  const bool rotations = !questions.unit_quaternions.empty();
  for (std::size_t k = 0; k < questions.answers(); ++k) {
    const PathValues<Numbers> along{questions, k, jets, tape, values, direction};
    append(out[Action], action_route(along));
    if (questions.has_matter && !rotations) append(out[Dalembert], dalembert_route(along));
    append(out[Power], power_route(along));
    if (!questions.constraints.empty()) append(out[ConstraintRows], constraint_route(along));
  }
  if (questions.has_matter && rotations)
    out[Dalembert] = dalembert_among_rotations(questions, tape, numbers, orders, direction, values);
  return out;
}

inline bool every_position(evaluation::Position) { return true; }

/// The direction of one equation alone.
template <class Numbers>
std::vector<typename Numbers::Value> unit_direction(const Numbers& numbers, std::size_t n, std::size_t row) {
  std::vector<typename Numbers::Value> direction(n, numbers.number(0));
  direction[row] = numbers.number(1);
  return direction;
}

}  // namespace maupertuis::certification
