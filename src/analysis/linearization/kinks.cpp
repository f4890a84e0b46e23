#include "analysis/linearization/kinks.hpp"

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/steady_state.hpp"

#include <maupertuis/switch_text.hpp>
#include <maupertuis/switches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

/// A derivative at a kink is that of one side, or none: each side is derived for itself, from the system with the
/// formulas that are in force there.
namespace maupertuis {
namespace {

constexpr double on_switch = 1e-7;  // of the change of g over typical sizes
constexpr double aside = 1e-5;  // of typical sizes: far enough to tell the sides, near enough to stay beside the point
constexpr double agreement = 1e-9;  // relative
constexpr int directions = 64;      // at random, beside those that the slopes of the switches tell

struct Place {
  Bindings at;
  std::vector<Expr> symbols;  // q, then q̇ of coordinates that no translation carries
  std::vector<double> sizes;
};

Place place_of(const PointEquations::Impl& e, const OperatingPoint& point, const std::vector<double>& sizes) {
  Place out;
  for (std::size_t i = 0; i < e.system->parameters.size(); ++i)
    out.at[e.system->parameters[i].symbol] = e.parameters[i];
  for (std::size_t i = 0; i < e.n; ++i) {
    const Coordinate& c = e.system->coordinates[i];
    out.at[c.q] = point.q[i], out.at[c.velocity] = point.v[i], out.at[c.acceleration] = 0;
    for (const Expr& s : {c.q, c.velocity}) out.symbols.push_back(s), out.sizes.push_back(sizes[i]);
  }
  out.at[e.system->context->time()] = point.t;
  for (std::size_t i = 0; i < e.system->inputs.size(); ++i) out.at[e.system->inputs[i].symbol] = point.inputs[i];
  return out;
}

bool is_known(Expr g, const Bindings& at) {
  const std::vector<Expr> symbols = symbols_of({&g, 1});
  return std::all_of(symbols.begin(), symbols.end(), [&](Expr s) { return at.count(s) != 0; });
}

/// The switches that pass through the point; those that only the time, or nothing, moves do not.
ExprVector switches_through(const ExprVector& balance, const Place& place) {
  ExprVector out;
  for (const Expr& g : switches_of(balance)) {
    if (!is_known(g, place.at)) continue;
    const std::vector<double> slopes = evaluate(gradient(g, place.symbols), place.at);
    double change = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) change += std::abs(slopes[i]) * place.sizes[i];
    if (change > 0 && std::abs(evaluate(g, place.at)) <= on_switch * change) out.push_back(g);
  }
  return out;
}

/// Ways from the point on which the switches take given signs, to first order: where their slopes are independent
/// there is one for each combination.
std::vector<Vector> ways_to_sides(const ExprVector& switches, const Place& place) {
  const auto rows = static_cast<Index>(switches.size()), columns = static_cast<Index>(place.symbols.size());
  Matrix slopes(rows, columns);
  for (Index k = 0; k < rows; ++k) {
    const std::vector<double> slope =
        evaluate(gradient(switches[static_cast<std::size_t>(k)], place.symbols), place.at);
    for (Index i = 0; i < columns; ++i)
      slopes(k, i) = slope[static_cast<std::size_t>(i)] * place.sizes[static_cast<std::size_t>(i)];
    slopes.row(k).normalize();
  }
  std::vector<Vector> out;
  for (unsigned sides = 0; sides < 1U << switches.size(); ++sides) {
    Vector signs(rows);
    for (Index k = 0; k < rows; ++k) signs[k] = (sides >> k & 1U) != 0 ? 1 : -1;
    const Vector way = least_squares(slopes, signs, 1e-9).x;
    if (way.allFinite() && way.lpNorm<Eigen::Infinity>() > 0) out.push_back(way / way.lpNorm<Eigen::Infinity>());
  }
  std::mt19937_64 random(1744);
  for (int k = 0; k < directions; ++k)
    out.push_back(
        Vector::NullaryExpr(columns, [&](Index) { return 2 * std::generate_canonical<double, 53>(random) - 1; }));
  return out;
}

/// The combinations of sides that meet at the point.
std::vector<std::vector<bool>> sides_that_meet(const ExprVector& switches, const Place& place) {
  std::vector<std::vector<bool>> out;
  for (const Vector& way : ways_to_sides(switches, place)) {
    Bindings near = place.at;
    for (std::size_t i = 0; i < place.symbols.size(); ++i)
      near[place.symbols[i]] += aside * place.sizes[i] * way[static_cast<Index>(i)];
    std::vector<bool> sides;
    for (const Expr& g : switches) sides.push_back(evaluate(g, near) > 0);
    if (std::find(out.begin(), out.end(), sides) == out.end()) out.push_back(sides);
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// The system with the formulas of one side.
std::shared_ptr<const MechanicalSystem> system_on(const MechanicalSystem& system, const ExprVector& switches,
                                                  const std::vector<bool>& above) {
  auto out = std::make_shared<MechanicalSystem>(system);
  const auto put = [&](Expr& e) {
    for (std::size_t k = 0; k < switches.size() && e; ++k) e = on_side({&e, 1}, switches[k], above[k]).front();
  };
  for (auto* terms :
       {&out->kinetic, &out->potential, &out->generalized_potential, &out->dissipation, &out->lagrangian_extra})
    for (EnergyTerm& t : *terms) put(t.value);
  if (out->lagrangian_given) put(out->lagrangian_given->value);
  for (AppliedForce& f : out->forces)
    for (Expr& e : f.components) put(e);
  out->written = nullptr;
  return out;
}

std::string where_text(const ExprVector& switches, const std::vector<bool>& above, const ReadingOrder& order) {
  std::string out;
  for (std::size_t k = 0; k < switches.size(); ++k)
    if (const std::string text = side_text(switches[k], above[k], order); !text.empty())
      out += (out.empty() ? "" : ", ") + text;
  return out;
}

bool equal(const RealMatrix& a, const RealMatrix& b) {
  if (a.rows != b.rows || a.columns != b.columns) return false;
  double size = 0, off = 0;
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    size = std::max({size, std::abs(a.entries[i]), std::abs(b.entries[i])});
    off = std::max(off, std::abs(a.entries[i] - b.entries[i]));
  }
  return off <= agreement * size;
}

/// Whether the stiffness on the way from the point goes on changing, as much or more from each decade to the next.
bool grows_along(PointEquations::Impl& e, const OperatingPoint& point, const std::vector<double>& way) {
  constexpr double no_less = 0.7, much = 1e-6;
  constexpr std::array<double, 4> distances{1e-4, 1e-6, 1e-8, 1e-10};  // of typical sizes
  Matrix before;
  double change = 0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    OperatingPoint aside = point;
    for (std::size_t i = 0; i < way.size(); ++i) aside.q[i] += distances[k] * way[i];
    const Matrix here = e.at(e.balance, aside).by_q;
    if (!here.allFinite()) return false;
    const double now = k > 0 ? (here - before).norm() : 0;
    if (k > 1 && !(now > no_less * change)) return false;
    if (k > 0 && !(now > much * here.norm())) return false;
    change = now, before = here;
  }
  return true;
}

}  // namespace

bool is_stiffness_unbounded(const PointEquations& equations, const OperatingPoint& point) {
  PointEquations::Impl& e = equations.impl();
  const std::vector<double> sizes = typical_sizes(*e.system, {});
  std::mt19937_64 random(1788);
  for (int k = 0; k < 4; ++k) {
    std::vector<double> way(sizes.size());
    for (std::size_t i = 0; i < way.size(); ++i)
      way[i] = sizes[i] * (2 * std::generate_canonical<double, 53>(random) - 1);
    if (grows_along(e, point, way)) return true;
    for (double& x : way) x = -x;
    if (grows_along(e, point, way)) return true;
  }
  return false;
}

std::size_t switches_at(const PointEquations& equations, const Equilibrium& x) {
  const PointEquations::Impl& e = equations.impl();
  return switches_through(e.balance_rows, place_of(e, x.point, typical_sizes(*e.system, {}))).size();
}

std::vector<OneSide> sides_at(const PointEquations& equations, const Equilibrium& x,
                              const std::vector<Translation>& translations) {
  const PointEquations::Impl& e = equations.impl();
  const std::vector<double> sizes = typical_sizes(*e.system, {});
  const Place place = place_of(e, x.point, sizes);
  const ExprVector switches = switches_through(e.balance_rows, place);
  std::vector<OneSide> out;
  if (switches.empty()) return out;
  bool differ = false;
  std::optional<Linearization> first;
  for (const std::vector<bool>& above : sides_that_meet(switches, place)) {
    Diagnostics unheard;
    auto derived = euler_lagrange(system_on(*e.system, switches, above), unheard);
    if (!derived) continue;
    OneSide side{where_text(switches, above, derived->order), PointEquations(*derived, e.measured), 0};
    for (std::size_t i = 0; i < e.parameters.size(); ++i) side.equations.set_parameter(i, e.parameters[i]);
    SteadyState::Held held{std::vector<bool>(e.n, false), std::vector<bool>(translations.size(), false)};
    const std::vector<double> none(translations.size(), std::numeric_limits<double>::quiet_NaN());
    OperatingPoint point = x.point;
    side.residual = SteadyState(side.equations.impl(), translations, held, none, sizes).residual_at(point);
    const Linearization l = linearize(side.equations, x.point).linearization;
    differ |= !(side.residual <= agreement) || (first && !(equal(first->a, l.a) && equal(first->b, l.b)));
    if (!first) first = l;
    out.push_back(std::move(side));
  }
  if (differ || out.empty()) return out;
  // All sides agree. On the switches themselves a formula may still say another thing, as sign(x)² x' at x = 0 does:
  // then the equations are those of the sides.
  const Linearization there = linearize(equations, x.point).linearization;
  const bool as_beside = equal(there.a, first->a) && equal(there.b, first->b);
  while (out.size() > (as_beside ? 0 : 1)) out.pop_back();
  for (OneSide& side : out) side.where.clear();
  return out;
}

}  // namespace maupertuis
