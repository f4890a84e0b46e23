#include "verification/matrix_claims.hpp"

#include "verification/judge.hpp"

#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

std::string name_of(const expectation::MatrixVariable& v, const MechanicalSystem& system) {
  if (v.order < 0) return system.inputs[v.index].name;
  if (v.order == 2) return system.rates[v.index].name;
  return system.coordinates[v.index].name + (v.order == 1 ? "'" : "");
}

const RealMatrix& matrix_of(char letter, const Linearization& l) {
  switch (letter) {
    case 'A':
      return l.a;
    case 'B':
      return l.b;
    case 'C':
      return l.damping;
    case 'G':
      return l.gyroscopic;
    case 'K':
      return l.stiffness;
    default:
      return l.circulatory;
  }
}

/// Its row: of the states positions first, then velocities. Nothing for a coordinate that depends on others.
std::optional<std::size_t> place_of(const expectation::MatrixVariable& v, const Linearization& l) {
  if (v.order < 0) return v.index;
  const std::vector<std::size_t>& list = v.order == 0 ? l.independent : l.independent_velocities;
  const auto found = std::find(list.begin(), list.end(), v.index);
  if (found == list.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.begin()) + (v.order == 0 ? 0 : l.independent.size());
}

std::string independent_names(const Linearization& l, const MechanicalSystem& system) {
  std::string out;
  for (const std::size_t i : l.independent) out += (out.empty() ? "" : ", ") + system.coordinates[i].name;
  for (const std::size_t i : l.independent_velocities)
    out += (out.empty() ? "" : ", ") + system.coordinates[i].name + "'";
  return out;
}

bool asks_for_rates(const expectation::Matrix& e) {
  const auto is_rate = [](const expectation::MatrixVariable& v) { return v.order == 2; };
  return std::any_of(e.rows.begin(), e.rows.end(), is_rate) || std::any_of(e.columns.begin(), e.columns.end(), is_rate);
}

/// A and B in positions and rates of the model.
void decide_in_rates(const expectation::Matrix& e, const MechanicalSystem& system, const Linearization& l,
                     ExpectationResult& result) {
  const auto undefined = [&](std::string message) {
    result.actual = "not defined";
    result.message = std::move(message);
  };
  const auto found = in_rates(l, 0, system.rates.size());
  if (!found)
    return undefined(
        fmt::format("The rates of the model are {}, and there are {} independent velocities here, which they have to "
                    "determine.",
                    system.rates.size(), l.independent_velocities.size()));
  const auto place = [&](const expectation::MatrixVariable& v) -> std::optional<std::size_t> {
    if (v.order < 0) return v.index;
    if (v.order == 2) return found->positions.size() + v.index;
    const auto at = std::find(found->positions.begin(), found->positions.end(), v.index);
    if (v.order == 1 || at == found->positions.end()) return std::nullopt;
    return static_cast<std::size_t>(at - found->positions.begin());
  };
  std::vector<double> actual;
  for (const expectation::MatrixVariable& row : e.rows)
    for (const expectation::MatrixVariable& column : e.columns) {
      const auto i = place(row), j = place(column);
      if (!i || !j)
        return undefined(
            fmt::format("{} is no state where the rates are: positions that are independent here, and rates.",
                        name_of(i ? column : row, system)));
      actual.push_back((e.letter == 'A' ? found->a : found->b).at(*i, *j));
    }
  judge_entries(e, system, actual, result);
}

}  // namespace

void decide_mass_matrix(const expectation::Matrix& e, const EquationsOfMotion& equations, const MotionState& start,
                        ExpectationResult& result) {
  const MechanicalSystem& system = *equations.system;
  const ExprMatrix m = mass_matrix(equations);
  Bindings at = parameter_bindings(system);
  at[system.context->time()] = start.t;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    at[system.coordinates[i].q] = start.q[i];
    at[system.coordinates[i].velocity] = start.v[i];
  }
  for (const StartValue& s : e.at) {
    const Coordinate& c = system.coordinates[s.coordinate];
    at[s.order == 0 ? c.q : c.velocity] = number_of(system, s.value);
  }
  std::vector<double> actual;
  for (const expectation::MatrixVariable& row : e.rows)
    for (const expectation::MatrixVariable& column : e.columns) {
      const Expr entry = m.at(row.index, column.index);
      actual.push_back(evaluate(expand_time_derivatives(in_terms_of_motion(system, {&entry, 1}).front()), at));
    }
  judge_entries(e, system, actual, result);
}

void decide_linearization(const expectation::Matrix& e, const MechanicalSystem& system, const Linearization& l,
                          ExpectationResult& result) {
  const char letter = e.letter;
  result.expected = fmt::format("{} as written", letter);
  if (asks_for_rates(e)) return decide_in_rates(e, system, l, result);
  if (letter != 'A' && letter != 'B' && !l.second_order()) {
    result.actual = "not defined";
    result.message =
        fmt::format("Constraints between velocities leave no second-order form, and no {}; A and B there are.", letter);
    return;
  }
  const RealMatrix& matrix = matrix_of(letter, l);
  std::vector<double> actual;
  for (const expectation::MatrixVariable& row : e.rows)
    for (const expectation::MatrixVariable& column : e.columns) {
      const auto i = place_of(row, l), j = place_of(column, l);
      if (!i || !j) {
        result.actual = "not defined";
        result.message = fmt::format("{} depends on the others here; independent are {}.",
                                     name_of(i ? column : row, system), independent_names(l, system));
        return;
      }
      actual.push_back(matrix.at(*i, *j));
    }
  judge_entries(e, system, actual, result);
}

}  // namespace maupertuis
