#include "analysis/action/kinks.hpp"

#include <maupertuis/across_switches.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::action {
namespace {

constexpr int looks_an_element = 24;
constexpr double touches = 1e-9;  // of the largest |g| along the path

}  // namespace

std::vector<Expr> kinks_of(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const Expr lagrangian = in_terms_of_motion(system, {&equations.lagrangian_expanded, 1}).front();
  const SwitchSearch search = search_of_states(system);
  ExprMap values;
  for (const Parameter& p : system.parameters) values.emplace(p.symbol, p.value);
  const auto moves = [&](Expr g) {
    const std::vector<Expr> symbols = symbols_of({&g, 1});
    return std::any_of(symbols.begin(), symbols.end(), [&](Expr s) { return s.role() == Role::Coordinate; });
  };
  std::vector<Expr> switches;
  for (const Expr& g : switches_of({&lagrangian, 1}))
    if (moves(g)) switches.push_back(g);
  if (switches.empty()) return {};
  std::vector<Expr> slopes;
  for (const Coordinate& c : system.coordinates)
    for (const Expr& s : {c.q, c.velocity}) slopes.push_back(s);
  const std::vector<Expr> derivatives = substitute(gradient(lagrangian, slopes), values);
  std::vector<Expr> out;
  for (const SwitchSample& s : sample_switches(derivatives, substitute(switches, values), search)) {
    const bool jumps = std::any_of(s.jump.begin(), s.jump.end(), [](double x) { return std::abs(x) > 0; });
    if (jumps && std::find(out.begin(), out.end(), switches[s.which]) == out.end()) out.push_back(switches[s.which]);
  }
  return out;
}

std::vector<double> kink_values(const std::vector<Expr>& kinks, const MotionState& s, const MechanicalSystem& system) {
  Bindings at = parameter_bindings(system);
  at[system.context->time()] = s.t;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    at[system.coordinates[i].q] = s.q[i], at[system.coordinates[i].velocity] = s.v[i];
  return evaluate(kinks, at);
}

std::optional<KinkPassed> kink_passed(const ActionPath& path, const std::vector<Expr>& kinks,
                                      const MechanicalSystem& system) {
  const int looks = looks_an_element * static_cast<int>(path.elements());
  std::vector<std::vector<double>> along(kinks.size());
  const auto time_of = [&](int k) { return path.start + (path.end - path.start) * k / looks; };
  for (int k = 0; k <= looks && !kinks.empty(); ++k) {
    const std::vector<double> g = kink_values(kinks, path.at(k == looks ? path.end : time_of(k)), system);
    for (std::size_t j = 0; j < kinks.size(); ++j) along[j].push_back(g[j]);
  }
  std::optional<KinkPassed> first;
  for (std::size_t j = 0; j < kinks.size(); ++j) {
    double largest = 0;
    for (const double g : along[j]) largest = std::max(largest, std::abs(g));
    for (int k = 0; k <= looks; ++k) {
      const double here = along[j][static_cast<std::size_t>(k)],
                   before = along[j][static_cast<std::size_t>(std::max(0, k - 1))];
      const bool passed = std::abs(here) <= touches * largest || here * before < 0;
      if (passed && (!first || time_of(k) < first->t)) first = KinkPassed{time_of(k), kinks[j]};
      if (passed) break;
    }
  }
  return first;
}

}  // namespace maupertuis::action
