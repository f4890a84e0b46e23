#include "system/field_elaboration.hpp"
#include "system/field_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// What is said of a field at its boundary, and the forces that act there.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::FieldDeclaration;
using Side = BoundaryCondition::Side;

const char* name_of(Side side) {
  constexpr const char* names[] = {"left", "right", "bottom", "top"};
  return names[static_cast<int>(side)];
}

/// A value at the boundary: known at every time, whatever the field does.
Expr boundary_value(Elaboration& e, const Expression& x, const Dimension& dimension, const std::string& what) {
  Place place;
  place.inline_constants = true;
  const Value v = scalar_of(e, x, dimension, what, place);
  if (v.poisoned) return {};
  if (v.order < 0) return drives_as_formulas(e, v.scalar());
  e.diagnostics.error("E0285", x.span, "a value at the boundary that depends on a field",
                      "A condition at the boundary says what the field is there: a formula of t.", "");
  return {};
}

/// A formula of x, as it is on the side across x.
Expr on_side(const FieldSystem& system, Expr value, Side side) {
  const SpaceVariable& x = system.space[side == Side::Left || side == Side::Right ? 0 : 1];
  return substitute(value, {{x.symbol, side == Side::Right || side == Side::Top ? x.to : x.from}});
}

/// u = 0, u_x = 0 at one side
void condition_at(Elaboration& e, Side side, const syntax::Equation& s) {
  FieldSystem& system = system_of(e);
  const auto jet = jet_named(e, *s.left);
  const std::size_t along = side == Side::Left || side == Side::Right ? 0 : 1;
  const bool normal = jet && jet->time == 0 && jet->order() <= 1 && (jet->order() == 0 || jet->space[along] == 1);
  if (!normal || s.left->kind != Expression::Kind::Name) {
    e.diagnostics.error(
        "E0285", s.left->span, "this is no condition at a boundary",
        "A boundary condition gives the field or its slope: u = …, u_x = …. All others are natural: they "
        "follow from the density.",
        "`maup derive` shows the natural conditions.");
    return;
  }
  Expr value = boundary_value(e, *s.right, system.dimension_of(*jet), "a value at the boundary");
  if (!value) return;
  value = on_side(system, value, side);
  for (const BoundaryCondition& other : system.boundary) {
    if (other.side != side || other.jet.field != jet->field || other.jet.order() != jet->order()) continue;
    e.diagnostics.error(
        "E0285", s.left->span, fmt::format("`{}` is given twice at the {} end", system.jet_name(*jet), name_of(side)),
        fmt::format("It is already given in line {}.", e.texts.locate(other.span).line), "Keep one of them.");
    return;
  }
  system.boundary.push_back({side, *jet, value, cover(s.left->span, s.right->span)});
}

std::optional<Side> side_named(Elaboration& e, const syntax::Name& name) {
  const std::size_t sides = std::min<std::size_t>(2 * system_of(e).space.size(), 4);
  for (std::size_t i = 0; i < sides; ++i)
    if (name.text == name_of(static_cast<Side>(i))) return static_cast<Side>(i);
  e.diagnostics.error("E0286", name.span, fmt::format("this model has no boundary `{}`", name.text),
                      sides == 2 ? "A field of one space variable has the ends left and right."
                                 : "A rectangle has the sides left, right, bottom and top.",
                      "");
  return std::nullopt;
}

void refuse_without_domain(Elaboration& e, Span span) {
  e.diagnostics.error("E0286", span, "a boundary without a domain", "Without ends the field fills all space.",
                      "Give the domain of the field: `on x = 0 .. l`.");
}

}  // namespace

void boundaries(Elaboration& e) {
  FieldSystem& system = system_of(e);
  const bool bounded = !system.space.empty() && system.space.front().from;
  each_clause<FieldDeclaration>(e, [&](const FieldDeclaration& s, Span) {
    if (s.boundary.empty() && !s.periodic) return;
    if (!bounded) return refuse_without_domain(e, s.boundary_span);
    for (const syntax::Equation& one : s.boundary)
      for (std::size_t side = 0; side < 2 * std::min<std::size_t>(system.space.size(), 2); ++side)
        condition_at(e, static_cast<Side>(side), one);
  });
  each_clause<syntax::BoundaryText>(e, [&](const syntax::BoundaryText& s, Span span) {
    std::vector<Side> sides;
    if (s.side.text.empty())
      for (std::size_t i = 0; i < 2 * std::min<std::size_t>(system.space.size(), 2); ++i) {
        if (system.periodic() || !system.periodic(i / 2)) sides.push_back(static_cast<Side>(i));
      }
    else if (const auto side = side_named(e, s.side))
      sides.push_back(*side);
    if (sides.empty()) return;
    if (!bounded) return refuse_without_domain(e, span);
    if (system.periodic(static_cast<std::size_t>(sides.front()) / 2)) {
      e.diagnostics.error("E0285", span, "a boundary of a periodic domain",
                          "Its ends are one place: the field goes on from one to the other.",
                          "Leave out `boundary periodic`, or this statement.");
      return;
    }
    for (const syntax::Equation& one : s.conditions)
      for (const Side side : sides) condition_at(e, side, one);
  });
}

/// u_x at an end is the force there where the density has no second derivative of u: beside a given u it says nothing.
void refuse_slopes_beside_values(Elaboration& e) {
  const FieldSystem& system = system_of(e);
  for (const BoundaryCondition& slope : system.boundary) {
    if (slope.jet.order() == 0 || !system.density) continue;
    bool bends = false;
    for (const Expr& one : system.jets_in(system.density)) {
      const FieldJet jet = *system.jet_of(one);
      bends = bends || (jet.field == slope.jet.field && jet.order() - jet.time > 1);
    }
    for (const BoundaryCondition& value : system.boundary) {
      if (bends || value.jet.order() != 0 || value.jet.field != slope.jet.field || value.side != slope.side) continue;
      e.diagnostics.error(
          "E0285", slope.span,
          fmt::format("`{}` and `{}` are both given at the {} end", system.jet_name(value.jet),
                      system.jet_name(slope.jet), name_of(slope.side)),
          "The density holds first derivatives alone: an end takes one condition, and the slope there is what "
          "the support makes of it.",
          "Keep one of them.");
      return;
    }
  }
}

// ------------------------------------------------------------------------------------------------------- the forces

namespace {

/// Whether a place is a function of coordinates or t.
bool moves(Elaboration& e, const Expression& place) {
  Place quiet;
  quiet.inline_constants = true;
  const Value read = evaluate_formula(e, place, quiet);
  return !read.poisoned && !read.is_vector && !constant_value(e, read.scalar());
}

/// force u(l) = F at an end of the domain; beside bodies, or inside, a force on a coordinate
void force_at_place(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet, Span span) {
  if (!e.fields->coupled) e.fields->coupled = moves(e, *s.on->arguments.front());
  if (e.fields->coupled) return force_on_place(e, s, jet, span);
  FieldSystem& system = system_of(e);
  const SpaceVariable& x = system.space.front();
  const Value place = constant_of(e, *s.on->arguments.front(), x.dimension, "a place");
  if (place.poisoned) return;
  const double at = constant_value(e, place.scalar()).value_or(0);
  const double a = x.from ? *constant_value(e, x.from) : 0, b = x.from ? *constant_value(e, x.to) : 0;
  const double near = 1e-12 * (b - a);
  const bool at_end = x.from && !system.periodic(0) && (std::abs(at - a) <= near || std::abs(at - b) <= near);
  if (!at_end) {
    e.fields->coupled = true;
    return force_on_place(e, s, jet, span);
  }
  const Dimension dimension = e.dimension(dimensions::energy()) / system.dimension_of(jet);
  const Expr value = boundary_value(e, *s.value, dimension, "a force at an end");
  const Side side = std::abs(at - a) <= near ? Side::Left : Side::Right;
  if (value) system.end_forces.push_back({side, jet, on_side(system, value, side), span});
}

}  // namespace

void forces(Elaboration& e) {
  system_of(e).forces.resize(system_of(e).fields.size());
  each_clause<syntax::FieldForce>(e, [&](const syntax::FieldForce& s, Span span) {
    const auto jet = jet_named(e, *s.on);
    const bool place = s.on->kind == Expression::Kind::Call;
    if (jet && jet->time == 0 && !place && jet->order() == 0) return force_density(e, s, *jet);
    if (jet && jet->time == 0 && place && jet->order() <= 1 && system_of(e).space.size() == 1)
      return force_at_place(e, s, *jet, span);
    e.diagnostics.error("E0288", s.on->span, "a force acts on a field or at its end",
                        "The virtual work of a force density is f δu in each piece of space, of an end force F δu.",
                        "Write `force density u = …` or `force u(l) = …`.");
  });
}

}  // namespace maupertuis::elaboration
