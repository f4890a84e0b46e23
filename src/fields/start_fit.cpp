#include "fields/start_fit.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>

#include "fields/field_sides.hpp"
#include "fields/given_fields.hpp"
#include "fields/on_shell.hpp"
#include "fields/resting_fields.hpp"
#include "fields/switching.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

constexpr int most_times = 3;  // differentiated by t
constexpr double rounding = 1e-12;
constexpr double of_tails = 1e-5;  // what ends far from a pulse may be off by, beside the same inside
constexpr double small = 1e-8;     // of the field: a change from node to node, which such tails may make

/// jets = given at a side, or at a place where bodies are; `order` of the derivative that jumps if it does not hold.
struct Condition {
  std::size_t across = 0;
  double at = 0;  // in widths of the domain
  Expr jets, given;
  int order = 0;
  int by_time = 1;  // derivatives in space that one in time is worth
  bool of_bodies = false;
};

/// Whether curvatures of a field are in the density: its conditions hold forces and moments then.
bool bends(const FieldEquations& equations, std::size_t field) {
  return std::any_of(equations.natural.begin(), equations.natural.end(),
                     [&](const NaturalCondition& n) { return n.moment && n.field == field; });
}

Condition at_side(const FieldEquations& equations, Side side, std::size_t field, Expr jets, Expr given, int order) {
  const std::size_t across = side == Side::Left || side == Side::Right ? 0 : 1;
  return {across, side == Side::Right || side == Side::Top ? 1.0 : 0.0,
          jets,   given,
          order,  bends(equations, field) ? 2 : 1};
}

/// Order of the derivative in space that p or m holds.
int order_of(const FieldEquations& equations, const NaturalCondition& n) {
  return n.moment ? 2 : bends(equations, n.field) ? 3 : 1;
}

void add_sides(const FieldEquations& equations, std::vector<Condition>& out) {
  const FieldSystem& s = equations.system();
  for (const BoundaryCondition& b : s.boundary)
    if (moves(equations, b.jet.field))
      out.push_back(at_side(equations, b.side, b.jet.field, s.jet_symbol(b.jet), s.expanded(b.value), b.jet.order()));
  for (const NaturalCondition& n : equations.natural)
    for (const Side side : sides_across(n.along)) {
      if (!moves(equations, n.field) || s.periodic(n.along) || is_given(s, n, side) ||
          is_held_by_bodies(equations, n, side))
        continue;
      const Expr force = -s.expanded(force_at(s, n, side));
      out.push_back(at_side(equations, side, n.field, n.value, force, order_of(equations, n)));
    }
}

/// Jets in the place of the values, rates and slopes at a place; from both sides, where a start is the same.
ExprMap jets_at(const FieldEquations& equations, Expr place) {
  constexpr int most = 3;
  const FieldSystem& s = equations.system();
  ExprMap out;
  for (const std::size_t field : equations.varied)
    for (int space = 0; space <= most; ++space)
      for (int time = 0; time <= 2; ++time)
        for (const int side : {-1, 0, 1})
          out[jet_at_place(equations, {field, {space}, time}, place, side)] = s.jet_symbol({field, {space}, time});
  return out;
}

/// Where fields and bodies meet, or formulas of the density do.
void add_places(const FieldEquations& equations, const Bindings& values, double from, double width,
                std::vector<Condition>& out) {
  const FieldSystem& s = equations.system();
  for (const InterfaceCondition& i : equations.interfaces) {
    if (!moves(equations, i.field) || s.context->depends_on_time(i.place.id())) continue;
    Condition c;
    c.at = (evaluate(s.expanded(i.place), values) - from) / width;
    c.jets = substitute(s.expanded(expand_time_derivatives(i.value)), jets_at(equations, i.place));
    c.given = s.context->number(0), c.of_bodies = true;
    const FieldJet acceleration{i.field, {i.moment ? 1 : 0}, 2};
    const bool mass = !differentiate(c.jets, s.jet_symbol(acceleration)).is_zero();
    c.by_time = bends(equations, i.field) ? 2 : 1;
    c.order = order_of(equations, {i.field, 0, i.moment, {}});
    if (mass) c.order = std::max(c.order, 2 * c.by_time + acceleration.space[0]);
    out.push_back(std::move(c));
  }
}

constexpr double places_along[] = {0.23, 0.37, 0.71}, places_inside[] = {0.07, 0.19, 0.31, 0.47, 0.63, 0.78, 0.91};

class Start {
 public:
  Start(const FieldEquations& equations, double begin) : equations_(equations), s_(equations.system()) {
    for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
    values_[s_.context->time()] = begin;
    for (const SpaceVariable& x : s_.space) {
      from_.push_back(evaluate(s_.expanded(x.from), values_));
      width_.push_back(evaluate(s_.expanded(x.to), values_) - from_.back());
    }
  }

  Bindings parameters() const {
    Bindings out;
    for (const Parameter& p : equations_.model->parameters) out[p.symbol] = p.si_value;
    return out;
  }

  std::vector<Condition> conditions() const {
    std::vector<Condition> out;
    add_sides(equations_, out);
    add_places(equations_, values_, from_.front(), width_.front(), out);
    return out;
  }

  /// What a condition holds of coordinates that are no values of fields.
  bool holds_coordinates(Expr e) const {
    const std::vector<Expr> symbols = symbols_of({&e, 1});
    return std::any_of(symbols.begin(), symbols.end(), [&](Expr one) { return is_foreign(one); });
  }

  /// Jets of at most one derivative in time as functions of space, coordinates as they start; nothing where others
  /// stand in e.
  std::optional<Expr> inserted(Expr e) const {
    e = with_given_fields(s_, e);
    ExprMap map;
    for (const Expr& symbol : s_.jets_in(e)) {
      const FieldJet jet = *s_.jet_of(symbol);
      if (jet.time > 1) return std::nullopt;
      Expr value = s_.context->number(0);
      for (const FieldStart& one : equations_.model->start)
        if (one.field == jet.field && one.order == jet.time) value = s_.expanded(one.value);
      for (std::size_t x = 0; x < s_.space.size(); ++x)
        for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s_.space[x].symbol);
      map[symbol] = value;
    }
    const Expr out = s_.expanded(substitute(s_.expanded(substitute(e, map)), starts_of_coordinates()));
    return holds_coordinates(out) ? std::nullopt : std::optional(out);
  }

  /// Of what a condition asks for at a side, beside what the same expression has there and inside: at most 1.
  double misfit(const Condition& c, Expr jets) const {
    const std::size_t across = c.across;
    const double at = c.at;
    double off = 0, size = 0;
    for (const double along : places_along) {
      const double given = value(c.given, across, at, along), found = value(jets, across, at, along);
      off = std::max(off, std::abs(found - given));
      size = std::max({size, std::abs(given), std::abs(found)});
      for (const double inside : places_inside) size = std::max(size, std::abs(value(jets, across, inside, along)));
    }
    return off > rounding * size ? off / size : 0;
  }

  /// How fast the fields change in space: |∂φ/∂x|/|φ|, and 1 over the width at least.
  double wave_number() const {
    double out = 0;
    for (std::size_t x = 0; x < s_.space.size(); ++x) {
      out = std::max(out, 1 / width_[x]);
      for (const FieldStart& one : equations_.model->start) {
        const Expr field = s_.expanded(one.value), slope = differentiate(field, s_.space[x].symbol);
        double size = 0, change = 0;
        for (const double along : places_along)
          for (const double inside : places_inside) {
            size = std::max(size, std::abs(value(field, x, inside, along)));
            change = std::max(change, std::abs(value(slope, x, inside, along)));
          }
        if (size > 0) out = std::max(out, change / size);
      }
    }
    return out;
  }

 private:
  bool is_foreign(Expr symbol) const {
    const auto& space = s_.space;
    return !s_.jet_of(symbol) && !values_.count(symbol) &&
           std::none_of(space.begin(), space.end(), [&](const SpaceVariable& x) { return x.symbol == symbol; });
  }
  ExprMap starts_of_coordinates() const {
    ExprMap out;
    if (!equations_.bodies) return out;
    const std::vector<Coordinate>& coordinates = equations_.bodies->system->coordinates;
    for (const Coordinate& c : coordinates) out[c.q] = out[c.velocity] = s_.context->number(0);
    for (const StartValue& v : equations_.body_start)
      out[v.order == 0 ? coordinates[v.coordinate].q : coordinates[v.coordinate].velocity] = s_.expanded(v.value);
    return out;
  }

  /// At shares of the domain across the side and along it.
  double value(Expr e, std::size_t across, double at, double along) const {
    Bindings values = values_;
    for (std::size_t x = 0; x < s_.space.size(); ++x)
      values[s_.space[x].symbol] = from_[x] + width_[x] * (x == across ? at : along);
    return evaluate(e, values);
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  Bindings values_;
  std::vector<double> from_, width_;
};

}  // namespace

SideFit fit_of_sides(const FieldEquations& equations, double begin, double until, double spacing) {
  const FieldSystem& s = equations.system();
  if (s.periodic() || !s.space.front().from) return {};
  const Start start(equations, begin);
  const OnShell shell(equations);
  const double from_node_to_node = std::min(1.0, spacing * start.wave_number());
  SideFit out;
  for (Condition c : start.conditions()) {
    c.given = branches_between(c.given, s, start.parameters(), begin, until);
    for (int k = 0; k <= most_times && (!out.jump || c.order < *out.jump); ++k, c.order += c.by_time) {
      const auto reduced = shell.reduced(c.jets);
      const auto jets = reduced ? start.inserted(*reduced) : std::nullopt;
      if (!jets && !c.of_bodies) break;
      const double misfit = jets ? start.misfit(c, *jets) : 1;  // what cannot be told does not fit
      const double seen = misfit * std::pow(from_node_to_node, c.order);
      if (misfit > of_tails || seen > small) {
        out.jump = c.order;
        break;
      }
      out.tail = std::max(out.tail, seen);
      if (c.of_bodies && start.holds_coordinates(*reduced)) {  // their accelerations are not at hand
        out.jump = c.order + c.by_time;
        break;
      }
      c.jets = s.total_derivative(*reduced, s.space.size());
      c.given = total_time_derivative(c.given);
    }
  }
  return out;
}

}  // namespace maupertuis
