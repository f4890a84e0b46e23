#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// Statements about places, masses and forces.
namespace maupertuis::syntax {

void StatementParser::missing_clause(std::string_view clause, std::string_view statement, std::string_view example) {
  if (!at_end()) fail_expected(fmt::format("`{}`", clause), fmt::format("Write for example {}.", example));
  fail("E0127", statement_span(), fmt::format("this {} has no `{}`", statement, clause), "",
       fmt::format("Write for example {}.", example));
}

// The quantity after a clause word that has been read; each clause stands once.
ExpressionPtr StatementParser::clause_quantity(std::string_view clause, const ExpressionPtr& already) {
  if (already)
    fail("E0127", previous().span, fmt::format("`{}` is given twice", clause), "Each part of a statement stands once.",
         "Remove one of them.");
  return quantity();
}

std::vector<ExpressionPtr> StatementParser::bracketed_values(std::size_t count, std::string_view form) {
  const Span open = peek().span;
  if (!peek().is("(")) fail_expected(fmt::format("`(` as in {}", form));
  next();
  std::vector<ExpressionPtr> values;
  do values.push_back(quantity());
  while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)`");
  const Span span = cover(open, next().span);
  if (values.size() != count) {
    fail("E0116", span, fmt::format("{} values belong here, not {}", count, values.size()), "",
         fmt::format("Write {}.", form));
  }
  return with_unit_after(std::move(values));
}

// After the word `rotation`.
Rotation StatementParser::rotation() {
  Rotation rotation;
  const Token& form = next();
  if (form.is("angle")) {
    rotation.values = {quantity()};
  } else if (form.is("axis")) {
    rotation.kind = Rotation::Kind::AxisAngle;
    rotation.axis = operand("the axis, a vector in brackets");
    if (!accept("angle")) fail_expected("`angle` after the axis", "Write for example rotation axis (0, 0, 1) angle φ.");
    rotation.values = {quantity()};
  } else if (form.is("euler")) {
    rotation.kind = Rotation::Kind::Euler;
    const Token& sequence = peek();
    const bool axes = sequence.kind == Token::Kind::Name && sequence.text.size() == 3 &&
                      sequence.text.find_first_not_of("xyz") == std::string_view::npos &&
                      sequence.text[0] != sequence.text[1] && sequence.text[1] != sequence.text[2];
    if (!axes) fail_expected("the axes of three rotations, such as zxz", "No axis follows itself: zxz, zyx, zyz, …");
    rotation.sequence = sequence.text;
    rotation.sequence_span = next().span;
    rotation.values = bracketed_values(3, "rotation euler zxz (φ, θ, ψ)");
  } else if (form.is("rpy")) {
    rotation.kind = Rotation::Kind::RollPitchYaw;
    rotation.values = bracketed_values(3, "rotation rpy (roll, pitch, yaw)");
  } else if (form.is("quaternion")) {
    rotation.kind = peek().is("(") ? Rotation::Kind::Quaternion : Rotation::Kind::QuaternionCoordinates;
    if (peek().is("(")) rotation.values = bracketed_values(4, "rotation quaternion (w, x, y, z)");
  } else {
    fail("E0111", form.span, fmt::format("expected the form of a rotation, found {}", describe(form)), "",
         "Write angle θ, axis (0, 0, 1) angle θ, euler zxz (φ, θ, ψ), rpy (a, b, c) or quaternion.");
  }
  rotation.span = cover(form.span, previous().span);
  return rotation;
}

// After the word `inertia`.
void StatementParser::inertia(BodyStatement& body) {
  if (body.inertia_kind != BodyStatement::Inertia::None)
    fail("E0127", previous().span, "`inertia` is given twice", "Each part of a statement stands once.",
         "Remove one of them.");
  const Span first = peek().span;
  if (peek().is("diag") && peek(1).is("(")) {
    next();
    body.inertia_kind = BodyStatement::Inertia::Diagonal;
    body.inertia = bracketed_values(3, "inertia diag(xx, yy, zz)");
  } else if (peek().is("full") && peek(1).is("(")) {
    next();
    body.inertia_kind = BodyStatement::Inertia::Full;
    body.inertia = bracketed_values(6, "inertia full(xx, yy, zz, xy, xz, yz)");
  } else {
    body.inertia_kind = BodyStatement::Inertia::Scalar;
    body.inertia = {quantity()};
  }
  body.inertia_span = cover(first, previous().span);
}

StatementBody StatementParser::frame_statement() {
  next();
  FrameStatement frame;
  frame.name = new_name("the name of a frame");
  while (!at_end()) {
    if (accept("at"))
      frame.at = clause_quantity("at", frame.at);
    else if (accept("rotation"))
      frame.rotation = rotation();
    else if (accept("in"))
      frame.in = used_name("the name of a frame");
    else
      missing_clause("at, rotation or in", "frame", "frame F at (x, y) rotation angle θ");
  }
  if (!frame.at && !frame.rotation) missing_clause("at", "frame", "frame F at (x, y) rotation angle θ");
  return frame;
}

StatementBody StatementParser::point_statement() {
  next();
  PointStatement point;
  point.name = new_name("the name of a point");
  while (!at_end()) {
    if (accept("mass"))
      point.mass = clause_quantity("mass", point.mass);
    else if (accept("at"))
      point.at = clause_quantity("at", point.at);
    else if (accept("in"))
      point.in = used_name("the name of a frame");
    else
      missing_clause(
          "mass, at or in", "point",
          peek().is("=") ? fmt::format("point {} at {}", point.name.text, item_text(1)) : "point P mass m at (x, y)");
  }
  if (!point.at) missing_clause("at", "point", "point P mass m at (x, y)");
  return point;
}

StatementBody StatementParser::body_statement() {
  next();
  BodyStatement body;
  body.name = new_name("the name of a body");
  while (!at_end()) {
    if (accept("mass"))
      body.mass = clause_quantity("mass", body.mass);
    else if (accept("inertia"))
      inertia(body);
    else if (accept("at"))
      body.at = clause_quantity("at", body.at);
    else if (accept("rotation"))
      body.rotation = rotation();
    else if (accept("in"))
      body.in = used_name("the name of a frame");
    else
      missing_clause("mass, inertia, at, rotation or in", "body", "body B mass m inertia I at (x, y) rotation angle θ");
  }
  return body;
}

StatementBody StatementParser::gravity_statement() {
  next();
  if (peek().is("="))
    fail("E0111", peek().span, "`gravity` stands without `=`", "It is the acceleration of free fall, a vector.",
         "Write `gravity (0, -g)`, in space `gravity (0, 0, -g)`.");
  return GravityStatement{quantity()};
}

/// E0111 for `spring on x …` and `damper x coefficient …`: what acts on a coordinate is a part of an energy.
void StatementParser::refuse_coordinate(const char* what, const char* part_of, const char* instead) {
  const Token& named = peek().is("on") ? peek(1) : peek();
  const std::string q = named.kind == Token::Kind::Name ? std::string(named.text) : "x";
  const bool clause = peek(1).is("stiffness") || peek(1).is("length") || peek(1).is("coefficient");
  if (!peek().is("on") && !(peek().kind == Token::Kind::Name && clause)) return;
  fail("E0111", peek().span, fmt::format("a {} acts between two points", what),
       fmt::format("What acts on a coordinate is a part of {}.", part_of),
       fmt::format("Write for example {}; or name the points at both ends, {} A - B.",
                   fmt::format(fmt::runtime(instead), q), what));
}

StatementBody StatementParser::spring_statement() {
  next();
  SpringStatement spring;
  refuse_coordinate("spring", "the potential energy", "V += 1/2 k {0}^2, of an angle torsion spring {0} stiffness k");
  spring.from = operand("a point");
  if (!peek().is("-")) fail_expected("`-` after the first end of the spring", "Write spring A - B stiffness k.");
  next();
  spring.to = operand("a point");
  while (!at_end()) {
    if (accept("stiffness"))
      spring.stiffness = clause_quantity("stiffness", spring.stiffness);
    else if (accept("length"))
      spring.length = clause_quantity("length", spring.length);
    else
      missing_clause("stiffness or length", "spring", "spring A - B stiffness k length l0");
  }
  if (!spring.stiffness) missing_clause("stiffness", "spring", "spring A - B stiffness k length l0");
  return spring;
}

StatementBody StatementParser::damper_statement() {
  next();
  DamperStatement damper;
  refuse_coordinate("damper", "the dissipation function", "D += 1/2 c {0}'^2");
  damper.from = operand("a point");
  if (!peek().is("-")) fail_expected("`-` after the first end of the damper", "Write damper A - B coefficient c.");
  next();
  damper.to = operand("a point");
  if (!accept("coefficient")) missing_clause("coefficient", "damper", "damper A - B coefficient c");
  damper.coefficient = quantity();
  return damper;
}

// torsion spring θ stiffness k rest θ0
StatementBody StatementParser::torsion_statement() {
  next();
  if (!accept("spring")) fail_expected("`spring` after `torsion`", "Write for example torsion spring θ stiffness k.");
  accept("on");
  TorsionSpringStatement spring;
  spring.coordinate = used_name("the name of a coordinate");
  while (!at_end()) {
    if (accept("stiffness"))
      spring.stiffness = clause_quantity("stiffness", spring.stiffness);
    else if (accept("rest"))
      spring.rest = clause_quantity("rest", spring.rest);
    else
      missing_clause("stiffness or rest", "torsion spring", "torsion spring θ stiffness k rest θ0");
  }
  if (!spring.stiffness) missing_clause("stiffness", "torsion spring", "torsion spring θ stiffness k rest θ0");
  return spring;
}

StatementBody StatementParser::force_statement() {
  const bool at_place = peek(1).kind == Token::Kind::Name && peek(2).is("(") && !peek(1).is("on");
  if (at_place || (peek(1).is("density") && peek(2).kind == Token::Kind::Name)) return field_force_statement();
  next();
  ForceStatement force;
  if (accept("on")) {
    force.target = ForceStatement::Target::Point;
    force.on = used_name("the name of a point or body");
  } else {
    force.on = used_name("`on` and a point, or the name of a coordinate",
                         "Write force q = … along a coordinate q, or force on P = (…) at a point.");
  }
  if (accept("in")) force.in = used_name("the name of a frame");
  expect("=", fmt::format("`{}`", force.on.text));
  force.value = quantity();
  if (!force.in && accept("in")) force.in = used_name("the name of a frame");
  return force;
}

StatementBody StatementParser::torque_statement() {
  const Token& word = next();
  ForceStatement torque;
  torque.target = ForceStatement::Target::TorqueOnBody;
  if (!accept("on")) {
    fail("E0111", cover(word.span, peek().span),
         fmt::format("expected `on` and a body after `torque`, found {}", describe(peek())),
         "A generalized force along a coordinate is written with `force`, also for an angle.",
         "Write torque on B = …, or force θ = ….");
  }
  torque.on = used_name("the name of a body");
  if (accept("from")) torque.from = used_name("the name of a body");
  if (accept("in")) torque.in = used_name("the name of a frame");
  expect("=", fmt::format("`{}`", torque.from ? torque.from->text : torque.on.text));
  torque.value = quantity();
  if (!torque.in && accept("in")) torque.in = used_name("the name of a frame");
  return torque;
}

StatementBody StatementParser::reaction_statement() {
  next();
  ReactionStatement reaction;
  reaction.name = new_name("the name of the reaction");
  expect("=", "the name of the reaction");
  if (!peek().is("release")) fail_expected("`release`", "Write for example reaction rod = release l1.");
  next();
  reaction.released = used_name("the parameter that is released");
  return reaction;
}

}  // namespace maupertuis::syntax
