#include "fields/resting_fields.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>

#include "fields/field_rest.hpp"
#include "fields/resolution.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/static_density.hpp"
#include "fields/static_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

/// Equilibria on more and more functions, until they agree.
namespace maupertuis {
namespace {

double value_in_numbers(const FieldEquations& equations, Expr e) {
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  return evaluate(equations.system().expanded(e), values);
}

/// Elements end where a coefficient jumps or has a kink across the whole of a line, if there are few of these.
std::vector<double> borders_in_plane(const FieldEquations& equations, std::size_t direction) {
  constexpr std::size_t most = 3;
  const SpaceVariable& x = equations.system().space[direction];
  const double from = value_in_numbers(equations, x.from), to = value_in_numbers(equations, x.to),
               near = 1e-9 * (to - from);
  std::vector<double> out{from};
  for (const DensityBorder& b : density_borders_along(equations, direction))
    if (b.at > out.back() + near && b.at < to - near) out.push_back(b.at);
  if (out.size() - 1 > most) out.resize(1);
  out.push_back(to);
  return out;
}

/// Of each size; empty: no more.
std::vector<StaticSpace::Along> layout(const FieldEquations& equations, std::size_t size) {
  struct Size {
    int cells, degree;
  };
  constexpr Size lines[] = {{1, 20}, {1, 36}, {4, 20}, {8, 20}, {12, 24}, {20, 24}};
  constexpr int planes[] = {8, 12, 17, 23, 29};
  const std::size_t fields = equations.varied.size();
  if (equations.system().space.size() == 1) {
    if (size >= std::size(lines)) return {};
    return {{element_borders(equations, lines[size].cells), lines[size].degree}};
  }
  if (size >= std::size(planes)) return {};
  std::vector<StaticSpace::Along> out;
  std::size_t unknowns = fields;
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> borders = borders_in_plane(equations, i);
    constexpr int least = 5;
    const int elements = static_cast<int>(borders.size()) - 1, degree = std::max(planes[size] / elements, least);
    unknowns *= static_cast<std::size_t>(degree * elements);
    out.push_back({std::move(borders), degree + static_cast<int>(size)});
  }
  constexpr std::size_t most = 1200;
  return size > 1 && unknowns > most ? std::vector<StaticSpace::Along>{} : out;
}

std::vector<double> shown_places(const FieldEquations& equations, std::size_t direction) {
  constexpr int shown = 40;
  const SpaceVariable& x = equations.system().space[direction];
  const double from = value_in_numbers(equations, x.from), to = value_in_numbers(equations, x.to);
  std::vector<double> out;
  for (int k = 0; k <= shown; ++k) out.push_back(k == shown ? to : from + (to - from) * k / shown);
  return out;
}

void read_values(const FieldEquations& equations, const RestingFields& rest, FieldEquilibrium& out) {
  const std::size_t dimensions = equations.system().space.size();
  out.places = shown_places(equations, 0);
  if (dimensions > 1) out.upwards = shown_places(equations, 1);
  out.fields.clear();
  for (const std::size_t field : equations.varied) {
    FieldJet jet;
    jet.field = field, jet.space.assign(dimensions, 0);
    out.fields.emplace_back();
    for (const double y : dimensions > 1 ? out.upwards : std::vector<double>{0})
      for (const double x : out.places) out.fields.back().push_back(rest.value(jet, x, y));
  }
  out.coordinates.clear();
  if (!equations.bodies) return;
  const std::size_t n = equations.bodies->system->coordinates.size();
  for (std::size_t i = 0; i < n; ++i) out.coordinates.push_back(rest.bodies()(static_cast<Eigen::Index>(i)));
}

/// The largest change beside the largest value; errors by it and by `rounding`, a part of that value.
double change(const FieldEquilibrium& before, FieldEquilibrium& now, double rounding, const StaticBodies& bodies) {
  double out = 0;
  now.errors.clear(), now.coordinate_errors.clear();
  for (std::size_t a = 0; a < now.fields.size(); ++a) {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < now.fields[a].size(); ++i) {
      off = std::max(off, std::abs(now.fields[a][i] - before.fields[a][i]));
      size = std::max(size, std::abs(now.fields[a][i]));
    }
    constexpr double least = 4e-15;
    now.errors.push_back(off + std::max(rounding, least) * size);
    if (size > 0) out = std::max(out, off / size);
  }
  for (std::size_t i = 0; i < now.coordinates.size(); ++i) {
    constexpr double least = 4e-15;
    const double off = std::abs(now.coordinates[i] - before.coordinates[i]),
                 size = bodies.scale(static_cast<Eigen::Index>(i), now.coordinates[i]);
    now.coordinate_errors.push_back(off + least * size);
    if (size > 0) out = std::max(out, off / size);
  }
  now.energy_error = std::abs(now.energy - before.energy) + 4e-15 * std::abs(now.energy);
  return out;
}

/// Two sizes of functions agree as well where both pass a load by that lies between their points.
std::string what_is_passed_by(const FieldEquations& equations, const std::vector<StaticSpace::Along>& along) {
  constexpr int highest = 20;  // of polynomials through the points of an element
  Borders borders;
  int order = highest;
  for (const StaticSpace::Along& one : along) borders.push_back(one.borders), order = std::min(order, one.degree);
  const auto passed = passed_by(equations, borders, order);
  return passed ? fmt::format("The polynomials of the equilibrium pass by what {}: it is too narrow for them.", *passed)
                : "";
}

}  // namespace

double ComputedRest::error(double now, double then) const {
  constexpr double least = 4e-15;
  return missing * std::abs(now - then) + std::max(rounding, least) * std::abs(now);
}

std::optional<ComputedRest> computed_rest(const FieldEquations& equations, const std::vector<Expr>& formulas,
                                          std::string& why) {
  const FieldSystem& s = equations.system();
  if (s.space.size() > 2 || std::any_of(s.space.begin(), s.space.end(), [](const auto& x) { return !x.from; })) {
    why = "Equilibria are those of fields with a domain, of one or two space variables.";
    return std::nullopt;
  }
  StaticDensity density;
  StaticBodies bodies;
  if (why = density.read(equations); !why.empty()) return std::nullopt;
  if (why = bodies.read(equations); !why.empty()) return std::nullopt;
  constexpr double close = 1e-11, much = 0.03;
  ComputedRest out;
  double off = std::numeric_limits<double>::infinity(), off_before = off;
  int failed = 0;
  std::vector<StaticSpace::Along> finest;
  for (std::size_t size = 0; off > std::max(close, 2 * out.rounding); ++size) {
    const std::vector<StaticSpace::Along> along = layout(equations, size);
    if (along.empty()) break;
    const auto space = std::make_shared<const StaticSpace>(equations, along, density.smooth);
    StaticEquilibrium problem(equations, density, bodies, space);
    Eigen::VectorXd c;
    // A coarse one may be another than that next to the start.
    constexpr double trusted = 1e-3;
    why = problem.find(off <= trusted ? out.finest.get() : nullptr, formulas, c);
    if (!why.empty()) {
      if (off <= trusted) break;
      if (++failed == 2) return std::nullopt;
      out = {}, off = off_before = std::numeric_limits<double>::infinity();
      continue;
    }
    finest = along;
    out.before = out.finest;
    out.finest = std::make_shared<const RestingFields>(space, c, problem.of_bodies(c));
    const FieldEquilibrium before = out.values;
    read_values(equations, *out.finest, out.values);
    out.values.energy = problem.energy(c);
    out.rounding = problem.rounding();
    if (out.before) off_before = off, off = change(before, out.values, out.rounding, bodies);
    constexpr Eigen::Index enough = 400;  // for the lowest eigenvalues
    if (c.size() <= enough || size == 0) problem.judge(c, out.values);
  }
  if (!(off <= much)) {
    if (why.empty())
      why = "The equilibria of two sizes of functions are far from each other, so that neither is known.";
    return std::nullopt;
  }
  if (const auto contact = bodies.contact_passed(out.finest->bodies())) {
    why = "Without its contacts a body would rest beyond `" + *contact + "`.";
    return std::nullopt;
  }
  if (why = what_is_passed_by(equations, finest); !why.empty()) return std::nullopt;
  // Where changes fall slowly, the last is less than what is left: that of a geometric series beyond it.
  const double ratio = std::isfinite(off_before) && off_before > 0 ? std::min(0.8, off / off_before) : 0;
  out.missing = std::max(1.0, 2 * ratio / (1 - ratio));
  for (double& e : out.values.errors) e *= out.missing;
  for (double& e : out.values.coordinate_errors) e *= out.missing;
  out.values.energy_error *= out.missing;
  why.clear();
  return out;
}

namespace {

/// φ = 0 where a start gives none.
std::vector<Expr> start_of(const FieldEquations& equations) {
  std::vector<Expr> out(equations.varied.size(), equations.system().context->number(0));
  for (const FieldStart& start : equations.model->start)
    if (const std::size_t a = equations.varied_index(start.field); start.order == 0 && a < out.size())
      out[a] = equations.system().expanded(start.value);
  return out;
}

/// Whether an expression holds a derivative by the time.
bool holds_motion(const FieldEquations& equations, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(), [&](const Expr& symbol) {
    if (const auto jet = equations.system().jet_of(symbol)) return jet->time > 0;
    return symbol.role() == Role::Coordinate && symbol.order() > 0;
  });
}

}  // namespace

bool moves(const FieldEquations& equations, std::size_t field) {
  const auto at = std::find(equations.varied.begin(), equations.varied.end(), field);
  return at != equations.varied.end() &&
         holds_motion(equations, equations.residuals[static_cast<std::size_t>(at - equations.varied.begin())]);
}

bool nothing_moves(const FieldEquations& equations) {
  const auto any_moves = [&](const ExprVector& list) {
    return std::any_of(list.begin(), list.end(), [&](const Expr& e) { return holds_motion(equations, e); });
  };
  if (any_moves(equations.residuals)) return false;
  if (!equations.bodies) return true;
  const EquationsOfMotion& bodies = *equations.bodies;
  return !any_moves(expand_time_derivatives(bodies.balance())) && !any_moves(bodies.dissipative_terms) &&
         std::none_of(bodies.system->constraints.begin(), bodies.system->constraints.end(),
                      [](const Constraint& c) { return c.level == Constraint::Level::Velocity; });
}

bool vanishes(const FieldEquations& equations, const FieldEquilibrium& rest) {
  constexpr double rounding = 1e-13;
  const FieldSystem& s = equations.system();
  for (std::size_t a = 0; a < rest.fields.size(); ++a) {
    const Dimension dimension = s.fields[equations.varied[a]].dimension;
    const double scale = dimension.same_as(s.space[0].dimension) ? rest.places.back() - rest.places.front()
                         : dimension.same_as(Dimension{})        ? 1
                                                                 : 0;
    for (const double v : rest.fields[a])
      if (std::abs(v) > rounding * scale) return false;
  }
  return true;
}

std::optional<ComputedRest> rest_in_numbers(const FieldEquations& equations, std::string& why) {
  const FieldRest formula = rest_of(equations);
  if (!is_rest(equations, formula)) return computed_rest(equations, start_of(equations), why);
  auto out = computed_rest(equations, formula.fields, why);
  // What bodies do at φ = 0 is in no formula.
  if (!equations.bodies || (out && vanishes(equations, out->values))) return out;
  return computed_rest(equations, start_of(equations), why);
}

}  // namespace maupertuis
