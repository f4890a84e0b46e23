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
