#include <maupertuis/across_switches.hpp>

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/switch_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace maupertuis {
namespace {

constexpr std::size_t many_switches = 256;  // from here on each is passed at a few points
constexpr double at_rest = 1e-30;           // of ġ at 1e-40 beside the switch: it vanishes there

bool knows(const SwitchSearch& search, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::all_of(symbols.begin(), symbols.end(), [&](Expr s) { return search.center.count(s) != 0; });
}

bool moves(const SwitchSearch& search, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(), [&](Expr s) { return search.center.count(s) != 0; });
}

/// atan2(y, x) jumps at y = 0 where x < 0: written by its switch function y, s (π/2 − atan2(x, s y)) with the side s.
Expr with_cuts_as_switches(Expr e) {
  ExprMap switched;
  for (const Expr& angle : topological_order({&e, 1})) {
    if (!angle.is(Kind::Atan2)) continue;
    Context& c = e.context();
    const Expr y = angle[0], x = angle[1], quarter = c.pi() / Rational(2);
    const auto atan2 = [&](Expr a, Expr b) { return c.function(Kind::Atan2, std::array{a, b}); };
    const Expr is_up = c.function(Kind::LessEqual, std::array{c.number(0), y});
    const std::array pieces{is_up, quarter - atan2(x, y), atan2(x, -y) - quarter};
    switched.emplace(angle, c.function(Kind::Piecewise, pieces));
  }
  return switched.empty() ? e : substitute(e, switched);
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
  const auto moving = [&](Expr e) { return in_terms_of_motion(system, expand_time_derivatives({&e, 1})).front(); };
  function = with_cuts_as_switches(moving(function));
  const ExprVector all = switches_of({&function, 1});
  if (all.empty()) return out;
  SwitchSearch search = search_of_states(system);
  ExprVector named;
  for (const Expr& g : all)
    if (moves(search, g)) named.push_back(g);
  if (named.empty()) return out;
  ExprMap values;
  for (const Parameter& p : system.parameters) values.emplace(p.symbol, p.value);
  if (named.size() > many_switches) search.points = 4;
  function = substitute(function, values);
  if (!knows(search, function)) return out;

  const ExprVector places = substitute(named, values);
  const SwitchUses uses({&function, 1});
  std::optional<SwitchSampler> sampler;
  std::vector<bool> passed(named.size(), false);
  for (std::size_t k = 0; k < named.size(); ++k) {
    const ExprVector decided = uses.terms_with(places[k]);
    // The pieces of one function are sampled one after the other.
    if (!sampler || sampler->functions() != decided) sampler.emplace(decided, search);
    Expr passing = rate ? substitute(rate(named[k]), values) : Expr();
    if (!passing || !knows(search, passing)) passing = system.context->number(1);
    for (const SwitchSample& s : sampler->sample(places[k], {&passing, 1})) {
      if (std::isnan(s.jump[0]) || !(std::max(std::abs(s.below[1]), std::abs(s.above[1])) > at_rest)) continue;
      ++out.points;
      passed[k] = true;
      if (s.jump[0] != 0 && !out.jump) out.jump = JumpAcross{named[k], s.jump[0], s.at, switch_text(named[k], order)};
    }
  }
  out.switches = static_cast<std::size_t>(std::count(passed.begin(), passed.end(), true));
  return out;
}

}  // namespace maupertuis
