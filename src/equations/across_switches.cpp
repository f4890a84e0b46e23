#include <maupertuis/across_switches.hpp>

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/switch_text.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double at_rest = 1e-30;  // of ġ at 1e-40 beside the switch: it vanishes there

bool knows(const SwitchSearch& search, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::all_of(symbols.begin(), symbols.end(), [&](Expr s) { return search.center.count(s) != 0; });
}

bool moves(const SwitchSearch& search, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(), [&](Expr s) { return search.center.count(s) != 0; });
}

}  // namespace

SwitchSearch search_of_states(const MechanicalSystem& system) {
  SwitchSearch out;
  for (const Coordinate& c : system.coordinates)
    for (const Expr& e : {c.q, c.velocity}) out.moving.push_back(e), out.center.emplace(e, 1);
  out.moving.push_back(system.context->time());
  out.center.emplace(system.context->time(), 1);
  return out;
}

AcrossSwitches across_switches(const MechanicalSystem& system, Expr function, const ReadingOrder& order,
                               const std::function<Expr(Expr)>& rate) {
  AcrossSwitches out;
  const SwitchSearch search = search_of_states(system);
  ExprMap values;
  for (const Parameter& p : system.parameters) values.emplace(p.symbol, p.value);
  const auto moving = [&](Expr e) { return in_terms_of_motion(system, expand_time_derivatives({&e, 1})).front(); };
  function = moving(function);
  ExprVector named;
  for (const Expr& g : switches_of({&function, 1}))
    if (moves(search, g)) named.push_back(g);
  if (named.empty()) return out;
  ExprVector functions{function};
  std::vector<bool> has_rate;
  for (const Expr& g : named) {
    Expr passing = rate ? substitute(rate(g), values) : Expr();
    has_rate.push_back(passing && knows(search, passing));
    functions.push_back(has_rate.back() ? passing : system.context->number(1));
  }
  functions = substitute(functions, values);
  if (!knows(search, functions.front())) return out;

  std::vector<bool> passed(named.size(), false);
  for (const SwitchSample& s : sample_switches(functions, substitute(named, values), search)) {
    const double before = s.below[1 + s.which], after = s.above[1 + s.which];
    if (std::isnan(s.jump[0]) || !(std::max(std::abs(before), std::abs(after)) > at_rest)) continue;
    ++out.points;
    passed[s.which] = true;
    if (s.jump[0] != 0 && !out.jump)
      out.jump = JumpAcross{named[s.which], s.jump[0], s.at, switch_text(named[s.which], order)};
  }
  out.switches = static_cast<std::size_t>(std::count(passed.begin(), passed.end(), true));
  return out;
}

}  // namespace maupertuis
