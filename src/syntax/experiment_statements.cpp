#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// start, run, output, method, precision, sweep, draw.
namespace maupertuis::syntax {

StartStatement::Item StatementParser::assignment(bool at_places) {
  StartStatement::Item item;
  item.variable = variable();
  const Expression::Kind kind = item.variable->kind;
  if (kind != Expression::Kind::Name && kind != Expression::Kind::Member &&
      !(at_places && kind == Expression::Kind::Call)) {
    fail("E0111", item.variable->span, "expected a coordinate or its velocity before `=`");
  }
  if (peek().is(":"))
    fail_expected(fmt::format("`=` after `{}`", text_of(*item.variable)),
                  fmt::format("A start value has the sign `=`: write {} = ….", text_of(*item.variable)));
  if (peek().is("("))
    fail_expected(fmt::format("`=` after `{}`", text_of(*item.variable)),
                  fmt::format("The start is the beginning of the run: write {} = ….", text_of(*item.variable)));
  expect("=", fmt::format("`{}`", text_of(*item.variable)));
  item.value = quantity();
  return item;
}

StatementBody StatementParser::start_statement() {
  next();
  StartStatement start;
  start.exactly = accept("exactly");
  if (accept("at")) {
    start.at = quantity();
    if (at_end()) return start;
    accept(",");
  }
  list([&] { start.items.push_back(assignment()); });
  return start;
}

// 10 s,   until P.y = 0 within 60 s; the limit is left out at most
RunStatement StatementParser::run_length() {
  RunStatement run;
  if (peek().is("from"))
    fail_expected("how long the run is",
                  "A run begins at the start of the model: write run 3 s; `start at 1 s` begins at another time.");
  if (!accept("until")) {
    run.duration = quantity();
    return run;
  }
  run.until_left = formula();
  expect("=", "the left side of `until`");
  run.until_right = quantity();
  if (accept("within")) run.within = quantity();
  return run;
}

StatementBody StatementParser::run_statement() {
  next();
  RunStatement run = run_length();
  if (run.until_left && !run.within) missing_clause("within", "run", "run until P.y = 0 within 60 s");
  return run;
}

StatementBody StatementParser::output_statement() {
  next();
  if (!accept("every")) fail_expected("`every` after `output`", "Write for example output every 10 ms.");
  return OutputStatement{quantity()};
}

// method stiff,   method variational order 4 step 10 ms
StatementBody StatementParser::method_statement() {
  next();
  MethodStatement method;
  method.word = used_name("auto, taylor, variational or stiff");
  if (accept("order")) {
    const auto order = whole_number();
    if (!order || *order < 1)
      fail_expected("the order of the steps, a whole number",
                    "Write for example method variational order 4 step 10 ms.");
    method.order = *order;
  }
  if (accept("step")) method.step = quantity();
  return method;
}

// precision quad,   precision 100
StatementBody StatementParser::precision_statement() {
  next();
  const Token& word = peek();
  if (word.kind != Token::Kind::Number) return PrecisionStatement{used_name("double, quad or 100")};
  return PrecisionStatement{{std::string(next().text), word.span}};
}

// A bare number before `..` has the unit of the other end: 20 .. 200 rad/s.
ExpressionPtr StatementParser::with_unit_of(ExpressionPtr from, const Expression& to) {
  const Expression& other = to.kind == Expression::Kind::Unary ? *to.arguments[0] : to;
  if (other.kind != Expression::Kind::Quantity || !is_constant(*from)) return from;
  auto quantity = std::make_shared<Expression>(other);
  quantity->span = from->span;
  quantity->depth = from->depth + 1;
  quantity->arguments = {std::move(from)};
  return quantity;
}

// Ω = 0 .. 12 rad/s, perhaps with the number of values
SweepStatement StatementParser::sweep_values() {
  SweepStatement sweep;
  sweep.variable = variable();
  expect("=", "what is swept");
  sweep.from = quantity();
  expect("..", "the first value");
  sweep.to = quantity();
  sweep.from = with_unit_of(sweep.from, *sweep.to);
  if (accept("steps")) sweep.steps = quantity();
  return sweep;
}

// sweep Ω = 0 .. 12 rad/s steps 121
StatementBody StatementParser::sweep_statement() {
  next();
  SweepStatement sweep = sweep_values();
  if (!sweep.steps) missing_clause("steps", "sweep", "sweep Ω = 0 .. 12 rad/s steps 121");
  return sweep;
}

namespace {

using Shape = DrawItem::Kind;
constexpr std::pair<std::string_view, Shape> shapes[] = {
    {"reaction", Shape::Reaction},   {"trail", Shape::Trail},   {"box", Shape::Box},
    {"circle", Shape::Circle},       {"disc", Shape::Disc},     {"hoop", Shape::Hoop},
    {"ellipsoid", Shape::Ellipsoid}, {"spring", Shape::Spring}, {"damper", Shape::Damper},
    {"pivot", Shape::Pivot},         {"ground", Shape::Ground}, {"wall", Shape::Wall},
    {"label", Shape::Label},         {"follow", Shape::Follow}};

}  // namespace

// O - A - B,   spring A - B
void StatementParser::draw_line(DrawItem& item) {
  item.path = {operand("a point")};
  while (accept("-")) item.path.push_back(operand("a point after `-`"));
  if (item.path.size() < 2)
    fail_expected("`-` and another point",
                  "Draw a line A - B, trail A, box A 1 m by 1 m, circle A 1 m or spring A - B.");
  if (item.kind != Shape::Line && item.path.size() > 2)
    fail("E0111", item.path[2]->span, item.kind == Shape::Spring ? "a spring has two ends" : "a damper has two ends");
}

// box cart 0.4 m by 0.2 m,   disc wheel 20 cm axis (0, 1, 0),   ellipsoid stone 20 cm by 5 cm by 3 cm
void StatementParser::draw_solid(DrawItem& item) {
  const bool has_sides = item.kind == Shape::Box || item.kind == Shape::Ellipsoid;
  item.path = {operand("a point, a body or a frame")};
  item.sizes = {quantity()};
  if (has_sides && !accept("by"))
    fail_expected("`by` and the height of it", "Write for example box cart 0.4 m by 0.2 m.");
  if (has_sides) item.sizes.push_back(quantity());
  if (has_sides && accept("by")) item.sizes.push_back(quantity());
  if ((item.kind == Shape::Disc || item.kind == Shape::Hoop) && accept("axis"))
    item.direction = operand("the axis, a vector");
}

DrawItem StatementParser::draw_item() {
  DrawItem item;
  const Span first = peek().span;
  if (peek(1).kind == Token::Kind::Name || peek(1).is("("))  // otherwise a point of that name: wall - A
    for (const auto& [word, kind] : shapes)
      if (accept(word)) {
        item.kind = kind;
        break;
      }
  switch (item.kind) {
    case Shape::Reaction:
      item.path = {bare_reaction(previous())};
      break;
    case Shape::Line:
    case Shape::Spring:
    case Shape::Damper:
      draw_line(item);
      break;
    case Shape::Box:
    case Shape::Circle:
    case Shape::Disc:
    case Shape::Hoop:
    case Shape::Ellipsoid:
      draw_solid(item);
      break;
    case Shape::Ground:
    case Shape::Wall:
      if (!accept("at"))
        fail_expected("`at` and a place on it", "Write for example ground at (0, -R) or wall at (0, 0) normal (1, 0).");
      item.path = {quantity()};  // a place
      if (accept("normal")) item.direction = operand("the normal, a vector");
      break;
    case Shape::Label:
      item.path = {operand("a point after `label`")};
      if (peek().kind == Token::Kind::String) item.text = next().text;
      break;
    case Shape::Trail:
    case Shape::Pivot:
    case Shape::Follow:
      item.path = {operand("a point")};
      break;
  }
  item.span = cover(first, previous().span);
  return item;
}

StatementBody StatementParser::draw_statement() {
  next();
  DrawStatement draw;
  list([&] { draw.items.push_back(draw_item()); });
  return draw;
}

}  // namespace maupertuis::syntax
