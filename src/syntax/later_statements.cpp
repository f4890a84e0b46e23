#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// Statements that a later version carries out: their grammar is checked whole.
namespace maupertuis::syntax {
namespace {

LaterStatement later(const Token& word) {
  LaterStatement statement;
  statement.what = word.text;
  return statement;
}

}  // namespace

// contact EXPR >= EXPR restitution e friction μ static μs slip EXPR name floor
StatementBody StatementParser::contact_statement() {
  LaterStatement statement = later(next());
  statement.expressions.push_back(formula());
  if (!accept(">=") && !accept("<=")) fail_expected("`>=` or `<=` after the left side of the contact");
  statement.expressions.push_back(quantity());
  while (!at_end()) {
    if (accept("name")) {
      statement.names.push_back(new_name("the name of the contact"));
    } else if (accept("restitution") || accept("friction") || accept("static") || accept("slip")) {
      statement.expressions.push_back(quantity());
    } else {
      missing_clause("restitution, friction, static, slip or name", "contact",
                     "contact y >= 0 restitution e friction μ slip x' name floor");
    }
  }
  return statement;
}

// friction q coefficient μ static μs normal EXPR,   friction q limit EXPR
StatementBody StatementParser::friction_statement() {
  LaterStatement statement = later(next());
  statement.expressions.push_back(variable());
  while (!at_end()) {
    if (accept("coefficient") || accept("static") || accept("normal") || accept("limit")) {
      statement.expressions.push_back(quantity());
    } else {
      missing_clause("coefficient, static, normal or limit", "friction", "friction x coefficient μ normal m g");
    }
  }
  if (statement.expressions.size() < 2)
    missing_clause("coefficient", "friction", "friction x coefficient μ normal m g");
  return statement;
}

// event hit when EXPR = EXPR rising : record / stop / set x' = -x', y' = y'
StatementBody StatementParser::event_statement() {
  LaterStatement statement = later(next());
  statement.names.push_back(new_name("the name of the event"));
  expect("when", "the name of the event");
  statement.expressions.push_back(formula());
  expect("=", "the left side of the event");
  statement.expressions.push_back(quantity());
  if (!accept("rising")) accept("falling");
  expect(":", "the condition of the event");
  if (peek().is("record") || peek().is("stop")) {
    next();
    return statement;
  }
  if (!peek().is("set")) fail_expected("`record`, `stop` or `set`");
  next();
  list([&] {
    statement.expressions.push_back(variable());
    expect("=", "what is set");
    statement.expressions.push_back(quantity());
  });
  return statement;
}

StatementBody StatementParser::impact_statement() {
  LaterStatement statement = later(next());
  if (!peek().is("sequential") && !peek().is("simultaneous")) fail_expected("`sequential` or `simultaneous`");
  next();
  return statement;
}

// field u(x) : angle on x = -20 m .. 20 m cells 800 boundary u_x = 0
StatementBody StatementParser::field_statement() {
  LaterStatement statement = later(next());
  statement.names.push_back(new_name("the name of a field"));
  expect("(", "the name of the field");
  do statement.names.push_back(new_name("an independent variable"));
  while (accept(","));
  expect(")", "the independent variables");
  expect(":", "the field");
  if (peek().is("["))
    bracketed_unit();
  else if (!accept("angle") && !accept("length") && !accept("charge") && !accept("number"))
    fail_expected("angle, length, charge, number or a unit in brackets");
  if (accept("on")) {
    do {
      statement.expressions.push_back(variable());
      expect("=", "the independent variable");
      const ExpressionPtr from = quantity();
      expect("..", "the first end");
      const ExpressionPtr to = quantity();
      statement.expressions.push_back(with_unit_of(from, *to));
      statement.expressions.push_back(to);
    } while (accept(","));
  }
  if (accept("cells")) {
    do statement.expressions.push_back(quantity());
    while (accept(",") || accept("by"));
  }
  if (accept("boundary") && !accept("periodic")) {
    list([&] {
      statement.expressions.push_back(formula());
      expect("=", "the boundary value");
      statement.expressions.push_back(quantity());
    });
  }
  return statement;
}

StatementBody StatementParser::density_statement() {
  LaterStatement statement = later(next());
  expect("=", "`density`");
  statement.expressions.push_back(formula());
  return statement;
}

}  // namespace maupertuis::syntax
