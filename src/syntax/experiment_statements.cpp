#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// start, run, output, method, precision, sweep, draw.
namespace maupertuis::syntax {

StartStatement::Item StatementParser::assignment() {
  StartStatement::Item item;
  item.variable = variable();
  if (item.variable->kind != Expression::Kind::Name && item.variable->kind != Expression::Kind::Member) {
    fail("E0111", item.variable->span, "expected a coordinate or its velocity before `=`");
  }
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

StatementBody StatementParser::run_statement() {
  next();
  RunStatement run;
  if (!accept("until")) {
    run.duration = quantity();
    return run;
  }
  run.until_left = formula();
  expect("=", "the left side of `until`");
  run.until_right = quantity();
  if (!accept("within")) missing_clause("within", "run", "run until P.y = 0 within 60 s");
  run.within = quantity();
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
    if (!order || *order < 1) fail_expected("the order of the steps, a whole number", "Write for example method variational order 4 step 10 ms.");
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

// sweep Ω = 0 .. 12 rad/s steps 121
StatementBody StatementParser::sweep_statement() {
  next();
  SweepStatement sweep;
  sweep.variable = variable();
  expect("=", "what is swept");
  sweep.from = quantity();
  expect("..", "the first value");
  sweep.to = quantity();
  if (!accept("steps")) missing_clause("steps", "sweep", "sweep Ω = 0 .. 12 rad/s steps 121");
  sweep.steps = quantity();
  return sweep;
}

DrawItem StatementParser::draw_item() {
  DrawItem item;
  const Span first = peek().span;
  const bool shape = peek(1).kind == Token::Kind::Name || peek(1).is("(");
  const auto keyword = [&](std::string_view word) { return shape && accept(word); };
  if (keyword("reaction")) {
    item.kind = DrawItem::Kind::Reaction;
    item.path = {bare_reaction(previous())};
  } else if (keyword("trail")) {
    item.kind = DrawItem::Kind::Trail;
    item.path = {operand("a point after `trail`")};
  } else if (keyword("box")) {
    item.kind = DrawItem::Kind::Box;
    item.path = {operand("a point after `box`")};
    item.sizes = {quantity()};
    if (!accept("by")) fail_expected("`by` and the height of the box", "Write for example box cart 0.4 m by 0.2 m.");
    item.sizes.push_back(quantity());
  } else if (keyword("circle")) {
    item.kind = DrawItem::Kind::Circle;
    item.path = {operand("a point after `circle`")};
    item.sizes = {quantity()};
  } else {
    if (keyword("spring")) item.kind = DrawItem::Kind::Spring;
    item.path = {operand("a point")};
    while (accept("-")) item.path.push_back(operand("a point after `-`"));
    if (item.path.size() < 2) fail_expected("`-` and another point", "Draw a line A - B, trail A, box A 1 m by 1 m, circle A 1 m or spring A - B.");
    if (item.kind == DrawItem::Kind::Spring && item.path.size() > 2) fail("E0111", item.path[2]->span, "a spring has two ends");
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
