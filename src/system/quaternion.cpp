#include "system/elaboration.hpp"

/// `rotation quaternion`: the four components are coordinates of their own, called sat.qw, sat.qx, sat.qy, sat.qz, and
/// their norm is a constraint.
namespace maupertuis::elaboration {
namespace {

constexpr const char* kComponents[] = {"qw", "qx", "qy", "qz"};

const std::optional<syntax::Rotation>* rotation_of(const Declaration& d) {
  if (d.kind == Declaration::Kind::Body) return &std::get<syntax::BodyStatement>(d.statement->body).rotation;
  if (d.kind == Declaration::Kind::Frame) return &std::get<syntax::FrameStatement>(d.statement->body).rotation;
  return nullptr;
}

Expr norm_condition(const MechanicalSystem& s, const Declaration& d) {
  ExprVector terms = {s.context->number(-1)};
  for (std::size_t i = 0; i < 4; ++i) terms.push_back(pow(s.coordinates[d.index + i].q, Rational(2)));
  return sum_of(terms, *s.context);
}

}  // namespace

bool has_own_quaternion(const Declaration& d) {
  const auto* rotation = rotation_of(d);
  return rotation && *rotation && (*rotation)->kind == syntax::Rotation::Kind::QuaternionCoordinates;
}

void add_quaternion_coordinates(Elaboration& e, Declaration& d) {
  d.index = e.system().coordinates.size();
  for (const char* component : kComponents) {
    Coordinate c;
    c.name = d.name + "." + component;
    c.kind = "number";
    c.q = e.context.symbol(c.name, Role::Coordinate, 0);
    c.velocity = e.context.symbol(c.name, Role::Coordinate, 1);
    c.acceleration = e.context.symbol(c.name, Role::Coordinate, 2);
    c.span = d.span;
    e.system().coordinates.push_back(std::move(c));
  }
}

std::optional<std::size_t> quaternion_component(Elaboration& e, const syntax::Expression& x) {
  if (x.kind != syntax::Expression::Kind::Member || x.arguments[0]->kind != syntax::Expression::Kind::Name)
    return std::nullopt;
  const Declaration* d = e.table.find(x.arguments[0]->text);
  if (!d || !has_own_quaternion(*d)) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)
    if (x.text == kComponents[i]) return d->index + i;
  return std::nullopt;
}

ExprVector quaternion_coordinates(Elaboration& e, const Declaration& d) {
  ExprVector q;
  for (std::size_t i = 0; i < 4; ++i) q.push_back(e.system().coordinates[d.index + i].q);
  return q;
}

void constrain_quaternions(Elaboration& e) {
  for (const Declaration& d : e.table.declarations()) {
    if (!has_own_quaternion(d)) continue;
    Constraint c;
    c.value = norm_condition(e.system(), d);
    c.body = d.name;
    c.span = d.span;
    e.system().constraints.push_back(std::move(c));
  }
}

/// The body stands as its axes are drawn, unless the model says otherwise. Where it gives some of x, y, z, the w that
/// belongs to them is the start: at w = 0 the norm would not tell how to change it.
void start_quaternions(Elaboration& e) {
  for (const Declaration& d : e.table.declarations()) {
    if (!has_own_quaternion(d)) continue;
    Expr rest = e.number(1);
    bool w_is_given = false;
    for (const StartValue& s : e.experiment().start) {
      if (s.order != 0 || s.coordinate < d.index || s.coordinate >= d.index + 4) continue;
      w_is_given = w_is_given || s.coordinate == d.index;
      rest = rest - pow(s.value, Rational(2));
    }
    const std::optional<double> size = constant_value(e, rest);
    if (!w_is_given && size && *size > 0) e.experiment().start.push_back({d.index, 0, sqrt(rest), d.span, {}, 1});
  }
}

}  // namespace maupertuis::elaboration
