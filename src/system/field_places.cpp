#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_statements.hpp>
#include <maupertuis/field_system.hpp>

#include "system/elaboration.hpp"
#include "system/field_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Values of fields at places: what couples fields with coordinates and bodies. Such a value that stands in T, V, L, D,
/// a point, a constraint or a force is a coordinate of the mechanical system: its row of Lagrange's equations is what
/// the bodies do at that place, to which the density adds its p or m.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Side = BoundaryCondition::Side;

FieldSystem& fields_of(Elaboration& e) { return e.fields->system; }

bool is_mechanics(const syntax::Statement& s) {
  if (const auto* run = std::get_if<syntax::RunStatement>(&s.body)) return run->until_left != nullptr;
  return std::get_if<syntax::CoordStatement>(&s.body) || std::get_if<syntax::FrameStatement>(&s.body) ||
         std::get_if<syntax::PointStatement>(&s.body) || std::get_if<syntax::BodyStatement>(&s.body) ||
         std::get_if<syntax::GravityStatement>(&s.body) || std::get_if<syntax::SpringStatement>(&s.body) ||
         std::get_if<syntax::TorsionSpringStatement>(&s.body) || std::get_if<syntax::DamperStatement>(&s.body) ||
         std::get_if<syntax::EnergyStatement>(&s.body) || std::get_if<syntax::ForceStatement>(&s.body) ||
         std::get_if<syntax::ConstraintStatement>(&s.body) || std::get_if<syntax::EventStatement>(&s.body) ||
         std::get_if<syntax::ContactStatement>(&s.body) || std::get_if<syntax::FrictionStatement>(&s.body) ||
         std::get_if<syntax::ImpactStatement>(&s.body);
}

bool goes_with_fields(const syntax::Statement& s) {
  const auto* constraint = std::get_if<syntax::ConstraintStatement>(&s.body);
  if (constraint && constraint->integral) return false;
  return is_mechanics(s) || std::get_if<syntax::SystemStatement>(&s.body) ||
         std::get_if<syntax::SourceStatement>(&s.body) || std::get_if<syntax::NoteStatement>(&s.body) ||
         std::get_if<syntax::DimensionlessStatement>(&s.body) || std::get_if<syntax::ParamStatement>(&s.body) ||
         std::get_if<syntax::LetStatement>(&s.body) || std::get_if<syntax::InputStatement>(&s.body) ||
         std::get_if<syntax::StartStatement>(&s.body) || std::get_if<syntax::RunStatement>(&s.body) ||
         std::get_if<syntax::OutputStatement>(&s.body) || std::get_if<syntax::ExpectStatement>(&s.body) ||
         std::get_if<syntax::SweepStatement>(&s.body) || std::get_if<syntax::FieldStatement>(&s.body);
}

/// Where in the domain `at` lies: an end of it, or nothing for the inside.
std::optional<Side> end_at(Elaboration& e, double at) {
  const SpaceVariable& x = fields_of(e).space.front();
  if (!x.from || fields_of(e).periodic(0)) return std::nullopt;
  const double a = *constant_value(e, x.from), b = *constant_value(e, x.to), near = 1e-12 * (b - a);
  if (std::abs(at - a) <= near) return Side::Left;
  if (std::abs(at - b) <= near) return Side::Right;
  return std::nullopt;
}

bool is_same_place(Elaboration& e, Expr a, Expr b) {
  const auto first = constant_value(e, a), second = constant_value(e, b);
  if (!first || !second) return !first && !second && (a == b || zero_test(a - b).verdict == Verdict::Zero);
  const SpaceVariable& x = fields_of(e).space.front();
  const double size = x.from ? *constant_value(e, x.to) - *constant_value(e, x.from) : std::max(std::abs(*second), 1.0);
  return std::abs(*first - *second) <= 1e-12 * size;
}

/// The coordinate that already stands for this value, however its place was written.
const PlaceCoordinate* find_attached(Elaboration& e, const FieldJet& jet, Expr place) {
  for (const PlaceCoordinate& p : e.fields->attached)
    if (p.jet.field == jet.field && p.jet.space == jet.space && is_same_place(e, p.place, place)) return &p;
  return nullptr;
}

bool refuse_as_coordinate(Elaboration& e, const Expression& x, const FieldJet& jet) {
  const FieldSystem& s = fields_of(e);
  if (s.space.size() != 1) {
    e.diagnostics.error(
        "E0505", x.span, "not supported yet: bodies on a field of several space variables",
        "A membrane holds no point: under a force at one it gives way without bound, as ln r. A plate "
        "does, but what couples fields with coordinates are values at places of one space variable.",
        "Spread it over a small piece of the density, m/(4 b^2) in a mass per area, with `piecewise(x < a "
        "- b : 0, x < a + b : 1, else : 0)` times the same of y: modes have elements that end there.");
    return true;
  }
  if (s.fields[jet.field].given) {
    e.diagnostics.error("E0289", x.span, fmt::format("`{}` is given, and no force acts back on it", x.text),
                        "Coordinates and bodies take hold of fields that are varied.",
                        "Write its formula at this place.");
    return true;
  }
  if (jet.space[0] <= 1) return false;
  e.diagnostics.error("E0296", x.span, fmt::format("`{}` at a place takes part in no virtual work", x.text),
                      "At a place a body is held by the value of the field, a force, and by its slope, a moment.",
                      "Write the field or its first derivative there.");
  return true;
}

}  // namespace

std::string name_of_place_value(Elaboration& e, const Expression& x, const FieldJet& jet) {
  std::string place;
  for (const auto& a : x.arguments) place += (place.empty() ? "" : ", ") + std::string(e.texts.slice(a->span));
  return fmt::format("{}({})", fields_of(e).jet_name({jet.field, jet.space, 0}), place);
}

bool couples_mechanics(Elaboration& e) {
  bool any = false;
  for (const syntax::Statement& s : e.tree.statements) any = any || is_mechanics(s);
  return any;
}

void refuse_beside_fields(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    if (goes_with_fields(s)) continue;
    e.diagnostics.error("E0505", s.span, "not supported yet: this statement in a model with fields",
                        "Beside fields stand coordinates, points and bodies, energies, constraints, forces, contacts, "
                        "friction and events; rates, gauges, paths, drawings and methods belong to models of "
                        "coordinates alone.",
                        "Leave this statement out.");
    return;
  }
}

Value coordinate_at_place(Elaboration& e, const Expression& x, const FieldJet& jet, Expr place) {
  if (refuse_as_coordinate(e, x, jet)) return Value::poison();
  FieldSystem& s = fields_of(e);
  const FieldJet still{jet.field, jet.space, 0};
  const std::optional<double> at = constant_value(e, place);
  const PlaceCoordinate* known = find_attached(e, still, place);
  if (!known) {
    Coordinate c;
    c.name = name_of_place_value(e, x, still);
    c.q = e.context.symbol(c.name, Role::Coordinate, 0);
    c.velocity = e.context.symbol(c.name, Role::Coordinate, 1);
    c.acceleration = e.context.symbol(c.name, Role::Coordinate, 2);
    c.dimension = s.dimension_of(still);
    c.kind = still.order() == 0 ? s.fields[jet.field].kind : "";
    c.span = x.span;
    e.fields->attached.push_back(
        {e.system().coordinates.size(), still, place, at ? end_at(e, *at) : std::nullopt, !at, x.span});
    e.system().coordinates.push_back(std::move(c));
    known = &e.fields->attached.back();
  }
  const Coordinate& c = e.system().coordinates[known->coordinate];
  return Value::of(e.context.symbol(c.name, Role::Coordinate, jet.time), s.dimension_of(jet), jet.time);
}

std::optional<Expr> attached_symbol(Elaboration& e, const FieldJet& jet, Expr place) {
  if (fields_of(e).space.size() != 1) return std::nullopt;
  const PlaceCoordinate* known = find_attached(e, {jet.field, jet.space, 0}, place);
  if (!known) return std::nullopt;
  return e.context.symbol(e.system().coordinates[known->coordinate].name, Role::Coordinate, jet.time);
}

std::optional<std::size_t> coordinate_of_place(Elaboration& e, const syntax::Expression& x) {
  const Value q = value_at_place(e, x);
  if (q.poisoned) return std::nullopt;
  for (std::size_t i = 0; i < e.system().coordinates.size(); ++i)
    if (e.system().coordinates[i].q == q.scalar()) return i;
  e.diagnostics.error("E0288", x.span, fmt::format("`{}` is no coordinate", e.texts.slice(x.span)),
                      "Friction and forces act along the value of a field at a place, or its slope.",
                      "Leave the primes out.");
  return std::nullopt;
}

void force_on_place(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet, Span span) {
  const auto on = coordinate_of_place(e, *s.on);
  if (!on) return;
  const std::string what = fmt::format("the force on {}", e.texts.slice(s.on->span));
  const Value v = scalar_of(e, *s.value, e.dimension(dimensions::energy()) / fields_of(e).dimension_of(jet), what);
  if (v.poisoned || refuse_acceleration(e, v, *s.value, what)) return;
  AppliedForce f;
  f.kind = AppliedForce::Kind::Generalized;
  f.target = std::string(e.texts.slice(s.on->span));
  f.components = {v.scalar()};
  f.coordinate = *on;
  f.span = span;
  e.system().forces.push_back(std::move(f));
}

// ------------------------------------------------------------------------------------------------------- what clashes

namespace {

/// E0297: two statements about one end.
void refuse_held_place(Elaboration& e, Side side, const FieldJet& jet, Span span, bool is_force) {
  const FieldSystem& s = fields_of(e);
  for (const BoundaryCondition& b : s.boundary) {
    if (b.side != side || b.jet.field != jet.field) continue;
    const char* end = side == Side::Left ? "left" : "right";
    const std::size_t line = e.texts.locate(b.span).line;
    if (b.jet.space == jet.space) {
      e.diagnostics.error(
          "E0297", span,
          fmt::format("{} is given at the {} end, and {} there", s.jet_name(jet), end,
                      is_force ? "a force acts on it" : "bodies take hold of it"),
          fmt::format("Line {} says what it is at every time: whatever acts on it there is borne by the support.",
                      line),
          is_force ? "Leave the force or the boundary condition out."
                   : "Write the given value in its place, or leave the boundary condition out.");
      return;
    }
    // u_x given where the density has no u_xx is a force on u
    bool bends = false;
    for (const Expr& one : s.jets_in(s.density)) bends = bends || s.jet_of(one)->space[0] > 1;
    if (bends || jet.order() != 0 || b.jet.order() != 1) continue;
    e.diagnostics.error(
        "E0297", span,
        fmt::format("{} is given at the {} end, and {} there", s.jet_name(b.jet), end,
                    is_force ? "a force acts" : "bodies act"),
        fmt::format("What acts on {0} there is balanced by ∂ℒ/∂{1}, so that it says what {1} is; line {2} says it too.",
                    s.jet_name(jet), s.jet_name(b.jet), line),
        "Keep the boundary condition, or what acts there.");
    return;
  }
}

/// E0298: a slope at a place needs curvatures in the density.
void refuse_loose_slope(Elaboration& e, const PlaceCoordinate& p) {
  const FieldSystem& s = fields_of(e);
  if (p.jet.order() == 0) return;
  for (const Expr& one : s.jets_in(s.density)) {
    const FieldJet jet = *s.jet_of(one);
    if (jet.field == p.jet.field && jet.space[0] == 2) return;
  }
  const std::string u = s.fields[p.jet.field].name;
  e.diagnostics.error(
      "E0298", p.span, fmt::format("a body takes hold of the slope of {}, which may jump", u),
      fmt::format("The density holds no {}_{}{}: no moment turns such a field, and its slope has a kink wherever a "
                  "force acts.",
                  u, s.space.front().name, s.space.front().name),
      fmt::format("Take hold of {} itself, or give the density its bending energy.", u));
}

/// E0299: u or x without a place in the mechanics of points.
void refuse_loose_fields(Elaboration& e, Expr value, Span span, const std::string& where) {
  if (!value) return;
  const FieldSystem& s = fields_of(e);
  const Expr roots[] = {value};
  for (const Expr& symbol : symbols_of(roots)) {
    const bool space = std::any_of(s.space.begin(), s.space.end(), [&](const auto& x) { return x.symbol == symbol; });
    const auto jet = s.jet_of(symbol);
    if (!space && !jet) continue;
    const std::string name = jet ? s.jet_name(*jet) : symbol.name();
    e.diagnostics.error("E0299", span, fmt::format("`{}` stands in {} without a place", name, where),
                        "The density alone is integrated over the field; bodies, springs and forces act at places.",
                        jet ? fmt::format("Write the value at a place, such as `{}(0 m)`, or put it into the density.",
                                          s.fields[jet->field].name)
                            : "Write a place of the field.");
    return;
  }
}

/// E0299 where coordinates stand in a density.
void refuse_coordinates_in(Elaboration& e, Expr value, Span span) {
  if (!value) return;
  const Expr roots[] = {value};
  for (const Expr& symbol : symbols_of(roots)) {
    if (symbol.role() != Role::Coordinate || fields_of(e).jet_of(symbol)) continue;
    e.diagnostics.error(
        "E0299", span, fmt::format("not supported yet: the coordinate `{}` in a density", symbol.name()),
        "It would act on every piece of the field at once.", "Couple it with values of the field at places: u(l).");
    return;
  }
}

void check_terms(Elaboration& e, const std::vector<EnergyTerm>& terms, const char* where) {
  for (const EnergyTerm& t : terms) refuse_loose_fields(e, t.value, t.span, where);
}

}  // namespace

void check_places(Elaboration& e) {
  FieldModel& model = *e.fields;
  FieldSystem& s = model.system;
  for (const EndForce& f : s.end_forces) refuse_held_place(e, f.side, f.jet, f.span, true);
  if (!model.coupled || !s.density) return;
  const MechanicalSystem& system = e.system();
  for (const PlaceCoordinate& p : model.attached) {
    refuse_loose_slope(e, p);
    if (!p.end) continue;
    bool is_force = false;
    for (const AppliedForce& f : system.forces)
      is_force = is_force || (f.kind == AppliedForce::Kind::Generalized && f.coordinate == p.coordinate &&
                              f.span.begin <= p.span.begin && p.span.end <= f.span.end);
    refuse_held_place(e, *p.end, p.jet, p.span, is_force);
  }
  for (const Point& p : system.points)
    for (const Expr& c : p.position) refuse_loose_fields(e, c, p.span, "the place of a point");
  for (const Body& b : system.bodies) {
    for (const Expr& c : b.position) refuse_loose_fields(e, c, b.span, "the place of a body");
    Expr all = e.number(0);  // its entries share their symbols: one message
    for (const Expr& c : b.rotation.entries)
      if (c) all = all + c;
    refuse_loose_fields(e, all, b.span, "the rotation of a body");
  }
  if (e.diagnostics.has_errors()) return;  // T and V hold what stands in places
  check_terms(e, system.kinetic, "T"), check_terms(e, system.potential, "V");
  check_terms(e, system.generalized_potential, "U"), check_terms(e, system.dissipation, "D");
  check_terms(e, system.lagrangian_extra, "L");
  if (system.lagrangian_given)
    refuse_loose_fields(e, system.lagrangian_given->value, system.lagrangian_given->span, "L");
  for (const AppliedForce& f : system.forces)
    for (const Expr& c : f.components) refuse_loose_fields(e, c, f.span, "a force");
  for (const Constraint& c : system.constraints) refuse_loose_fields(e, c.value, c.span, "a constraint");
  for (const Contact& c : system.contacts) {
    refuse_loose_fields(e, c.gap, c.span, "a contact");
    for (const Expr& slip : c.friction.slip) refuse_loose_fields(e, slip, c.friction.span, "a slip velocity");
  }
  for (const Friction& f : system.frictions)
    for (const Expr& part : {f.kinetic, f.static_, f.normal}) refuse_loose_fields(e, part, f.span, "a friction");
  refuse_coordinates_in(e, s.density, s.density_span), refuse_coordinates_in(e, s.dissipation, s.density_span);
  for (const Expr& f : s.forces) refuse_coordinates_in(e, f, s.density_span);
}

}  // namespace maupertuis::elaboration
