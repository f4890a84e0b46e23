#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <cmath>

/// Points and rigid bodies: where they are and how heavy.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Inertia = syntax::BodyStatement::Inertia;

/// What flows into or out of a body carries momentum, which Lagrange's equations of a mass m(q) leave out (Pesce 2003,
/// J. Appl. Mech. 70, 751): they are not Newton's.
bool refuse_coordinate(Elaboration& e, const Expression& x, const std::string& what, int order) {
  if (order < 0) return false;
  e.diagnostics.error(
      "E0433", x.span, fmt::format("{} depends on a coordinate", what),
      "What a body gains or loses as it moves brings momentum of its own, which Lagrange's equations of "
      "such a mass leave out.",
      "Describe the bodies that exchange it, or write T and V of the whole system.");
  return true;
}

/// Lagrange's equations of a mass m(t) are those of d/dt (m v) = F: what comes or goes has no velocity of its own. That
/// of a rocket's exhaust is its own affair, and forgotten as a rule.
void tell_of_time(Elaboration& e, const Expression& x, const std::string& what, const Expr& mass) {
  if (!e.context.depends_on_time(mass.id())) return;
  e.diagnostics.warning(
      "W0440", x.span, fmt::format("{} changes with time", what),
      "The equation of motion is d/dt (m v) = F then: what joins or leaves has no velocity, seen from "
      "the frame at rest, and takes or brings no momentum.",
      "Where it has the velocity u relative to the body, add its momentum: force on P = m' (P' + u), "
      "m' the rate of the mass, P' and u in components.");
}

/// A mass in kg; poisoned with a message if its value cannot be one.
Value mass_of(Elaboration& e, const Expression& x, const std::string& name) {
  const std::string what = fmt::format("the mass of {}", name);
  Value m = scalar_of(e, x, dimensions::mass(), what);
  if (m.poisoned || m.scalar().is_zero()) return m;  // `mass 0` says that it has none
  if (refuse_coordinate(e, x, what, m.order)) return Value::poison();
  tell_of_time(e, x, what, m.scalar());
  const std::optional<double> size = constant_value(e, m.scalar());
  if (!size || *size > 0) return m;
  const bool zero = *size == 0;
  e.diagnostics.error("E0403", x.span, fmt::format("the mass of {} is {}", name, zero ? "zero" : "negative"),
                      zero
                          ? "Without mass there is no inertia: no force would have a finite acceleration as its answer."
                          : "Masses are positive: a negative one would gain speed against every force.",
                      zero ? "Leave `mass` out where the point only marks a place." : "Give it a positive value.");
  return Value::poison();
}

Value place_value(Elaboration& e, const ExprVector& position, int order) {
  Value v;
  v.parts = position;
  v.is_vector = v.anchored = true;
  v.dimension = e.dimension(dimensions::length());
  v.weight = e.number(1);
  v.order = order;
  return v;
}

ExprMatrix inertia_matrix(Elaboration& e, const std::vector<Expr>& v, Inertia kind) {
  if (e.system().space_dimension == 2) return {1, 1, {v[0]}};
  const Expr zero = e.number(0);
  if (kind == Inertia::Scalar) return {3, 3, {v[0], zero, zero, zero, v[0], zero, zero, zero, v[0]}};
  if (kind == Inertia::Diagonal) return {3, 3, {v[0], zero, zero, zero, v[1], zero, zero, zero, v[2]}};
  return {3, 3, {v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2]}};
}

/// No distribution of mass has this inertia unless ½ tr(I) 1 − I, its second moments, is positive semidefinite: that is
/// the triangle inequality of the principal moments.
bool second_moments_possible(const double i[3][3]) {
  const double half = 0.5 * (i[0][0] + i[1][1] + i[2][2]);
  double s[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) s[r][c] = (r == c ? half : 0) - i[r][c];
  const double slack = 1e-9 * std::abs(half);
  for (int r = 0; r < 3; ++r) {
    if (s[r][r] < -slack) return false;
    const int c = (r + 1) % 3;
    if (s[r][r] * s[c][c] - s[r][c] * s[r][c] < -slack * std::abs(half)) return false;
  }
  const double determinant = s[0][0] * (s[1][1] * s[2][2] - s[1][2] * s[2][1]) -
                             s[0][1] * (s[1][0] * s[2][2] - s[1][2] * s[2][0]) +
                             s[0][2] * (s[1][0] * s[2][1] - s[1][1] * s[2][0]);
  return determinant >= -slack * half * half;
}

bool check_inertia(Elaboration& e, const ExprMatrix& m, Span span, const std::string& name) {
  double value[3][3] = {};
  for (std::size_t i = 0; i < m.rows; ++i)
    for (std::size_t j = 0; j < m.columns; ++j) {
      const std::optional<double> v = constant_value(e, m.at(i, j));
      if (!v) return true;
      value[i][j] = *v;
    }
  for (std::size_t i = 0; i < m.rows; ++i) {
    if (value[i][i] >= 0) continue;
    e.diagnostics.error("E0404", span, fmt::format("a moment of inertia of {} is negative", name),
                        "A moment of inertia is a sum of masses times squared distances.", "");
    return false;
  }
  if (m.rows == 1 || second_moments_possible(value)) return true;
  e.diagnostics.error("E0404", span, fmt::format("no body has the moments of inertia of {}", name),
                      "Principal moments satisfy the triangle inequality: each is at most the sum of the other two.",
                      "Check the values; they are about the centre of mass, along the axes of the body.");
  return false;
}

/// The inertia of a body, an empty matrix without one; nothing after a mistake.
std::optional<ExprMatrix> inertia_of(Elaboration& e, const syntax::BodyStatement& s, const std::string& name) {
  if (s.inertia_kind == Inertia::None) return ExprMatrix{};
  std::vector<Expr> values;
  bool poisoned = false;
  for (const syntax::ExpressionPtr& x : s.inertia) {
    const Value v = scalar_of(e, *x, dimensions::moment_of_inertia(), "a moment of inertia");
    poisoned = poisoned || v.poisoned || refuse_coordinate(e, *x, fmt::format("the inertia of {}", name), v.order);
    if (!v.poisoned) values.push_back(v.scalar());
  }
  if (poisoned) return std::nullopt;
  const std::size_t needed = s.inertia_kind == Inertia::Scalar ? 1 : s.inertia_kind == Inertia::Diagonal ? 3 : 6;
  if (values.size() != needed || (e.system().space_dimension == 2 && needed != 1)) {
    e.diagnostics.error("E0404", s.inertia_span, fmt::format("the inertia of {} has {} numbers", name, values.size()),
                        e.system().space_dimension == 2 ? "In the plane a body has one moment of inertia."
                                                        : "In space: diag(xx, yy, zz) or full(xx, yy, zz, xy, xz, yz).",
                        "");
    return std::nullopt;
  }
  const ExprMatrix m = inertia_matrix(e, values, s.inertia_kind);
  return check_inertia(e, m, s.inertia_span, name) ? std::optional(m) : std::nullopt;
}

}  // namespace

Expr translational_energy(Expr mass, const ExprVector& position) {
  Context& context = mass.context();
  ExprVector squares;
  for (const Expr& x : position) squares.push_back(pow(context.time_derivative(x), Rational(2)));
  return Rational(1, 2) * (mass * context.sum(squares));
}

void elaborate_point(Elaboration& e, Declaration& d) {
  const auto& s = std::get<syntax::PointStatement>(d.statement->body);
  d.done = true;
  d.value = Value::poison();
  Point p;
  p.name = d.name;
  p.span = d.span;
  bool poisoned = false;
  if (s.mass) {
    const Value m = mass_of(e, *s.mass, d.name);
    poisoned = m.poisoned;
    if (!m.poisoned && !m.scalar().is_zero()) p.mass = m.scalar();
  }
  const Pose* frame = find_pose(e, s.in);
  if (!frame) return;
  const Value place = position_of(e, *s.at, s.in ? frame : nullptr);
  if (place.poisoned || poisoned) return;
  p.position = place.parts;
  d.value = place_value(e, p.position, place.order);
  e.system().points.push_back(std::move(p));
}

void elaborate_body(Elaboration& e, Declaration& d) {
  const auto& s = std::get<syntax::BodyStatement>(d.statement->body);
  d.done = true;
  d.value = Value::poison();
  Body b;
  b.name = d.name;
  b.span = d.span;
  bool poisoned = false;
  if (s.mass) {
    const Value m = mass_of(e, *s.mass, d.name);
    poisoned = m.poisoned;
    if (!m.poisoned && !m.scalar().is_zero()) b.mass = m.scalar();
  }
  const std::optional<ExprMatrix> inertia = inertia_of(e, s, d.name);
  const std::optional<Pose> pose = pose_of(e, d, s.at, s.rotation, s.in);
  if (poisoned || !inertia || !pose) return;
  b.inertia = *inertia;
  b.position = pose->origin;
  b.rotation = pose->rotation;
  b.angular_velocity = pose->omega;
  b.angular_velocity_world = pose->omega_world;
  e.poses.emplace(e.table.id(d), *pose);
  d.value = place_value(e, b.position, pose->order);
  e.system().bodies.push_back(std::move(b));
}

}  // namespace maupertuis::elaboration
