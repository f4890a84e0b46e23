#include "fields/start_fit.hpp"

#include <maupertuis/evaluate.hpp>

#include "fields/field_sides.hpp"
#include "fields/given_fields.hpp"
#include "fields/on_shell.hpp"
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

/// jets = given at a side; `order` of the derivative that jumps if it does not hold.
struct SideCondition {
  Side side;
  Expr jets, given;
  int order;
};

std::vector<SideCondition> conditions_of(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  std::vector<SideCondition> out;
  for (const BoundaryCondition& b : s.boundary)
    out.push_back({b.side, s.jet_symbol(b.jet), s.expanded(b.value), b.jet.order()});
  for (const NaturalCondition& n : equations.natural)
    for (const Side side : sides_across(n.along)) {
      if (n.moment || s.periodic(n.along) || is_given(s, n, side)) continue;
      Expr force = s.context->number(0);  // p + F = 0 on the right, −p + F = 0 on the left
      for (const EndForce& f : s.end_forces)
        if (f.side == side && f.jet.field == n.field && f.jet.order() == 0)
          force = side == Side::Left ? force + s.expanded(f.value) : force - s.expanded(f.value);
      out.push_back({side, n.value, force, 1});
    }
  return out;
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

  /// Jets of at most one derivative in time as functions of space; nothing where others stand in e.
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
    return s_.expanded(substitute(e, map));
  }

  /// Of what a condition asks for at a side, beside what the same expression has there and inside: at most 1.
  double misfit(const SideCondition& c, Expr jets) const {
    const std::size_t across = c.side == Side::Left || c.side == Side::Right ? 0 : 1;
    const double at = c.side == Side::Right || c.side == Side::Top ? 1 : 0;
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
  for (SideCondition c : conditions_of(equations)) {
    c.given = branches_between(c.given, s, start.parameters(), begin, until);
    for (int k = 0; k <= most_times && (!out.jump || c.order < *out.jump); ++k, ++c.order) {
      const auto reduced = shell.reduced(c.jets);
      const auto jets = reduced ? start.inserted(*reduced) : std::nullopt;
      if (!jets) break;
      const double misfit = start.misfit(c, *jets);
      const double seen = misfit * std::pow(from_node_to_node, c.order);
      if (misfit > of_tails || seen > small) {
        out.jump = c.order;
        break;
      }
      out.tail = std::max(out.tail, seen);
      c.jets = s.total_derivative(*reduced, s.space.size());
      c.given = total_time_derivative(c.given);
    }
  }
  return out;
}

}  // namespace maupertuis
