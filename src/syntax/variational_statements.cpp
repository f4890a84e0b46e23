#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// constraint, and what a variational problem is made of: independent, path, and what is expected of its paths.
namespace maupertuis::syntax {

// constraint EXPR = EXPR name rod,   constraint integral EXPR = VALUE name length
StatementBody StatementParser::constraint_statement() {
  next();
  ConstraintStatement constraint;
  constraint.integral =
      peek().is("integral") && !peek(1).is("=") && !context_.declarations.contains("integral") && accept("integral");
  if (peek().is(":")) fail_expected("an equation", "No colon stands here: write constraint x^2 + y^2 = l^2.");
  constraint.left = formula();
  if (at_end())
    fail_expected("`=` after the left side of the constraint",
                  fmt::format("Write constraint {} = 0.", text_of(*constraint.left)));
  if (peek().is(":"))
    fail_expected("`=` after the left side of the constraint",
                  fmt::format("Its name stands at the end: write constraint {} name {}.", item_text(1),
                              text_of(*constraint.left)));
  if (peek().is("<=") || peek().is(">=") || peek().is("<") || peek().is(">"))
    fail_expected("`=` after the left side of the constraint",
                  fmt::format("An inequality is a contact: contact {} {} ….", text_of(*constraint.left),
                              peek().is("<=") || peek().is("<") ? "<=" : ">="));
  expect("=", "the left side of the constraint");
  constraint.right = quantity();
  if (accept("name")) constraint.name = new_name("the name of the constraint");
  return constraint;
}

// gauge e = 1
StatementBody StatementParser::gauge_statement() {
  next();
  GaugeStatement gauge;
  gauge.left = formula();
  expect("=", "the left side of the gauge");
  gauge.right = quantity();
  return gauge;
}

// independent x,   independent x : length
StatementBody StatementParser::independent_statement() {
  next();
  IndependentStatement independent;
  if (peek().is("t") && peek().kind == Token::Kind::Name) {
    independent.name = {"t", next().span};
  } else {
    independent.name = new_name("the name of the independent variable");
  }
  if (!accept(":")) return independent;
  try {
    kind_of(independent.name, "independent variable", independent.kind, independent.unit);
  } catch (const Abandoned&) {
    index_ = end_;  // told; without the statement every derivative of the model would be one by the time
  }
  return independent;
}

namespace {

constexpr std::string_view kPathExample = "path from (0, 1) at 0 to (2, free) at 1";

}  // namespace

// path from (0, 1) at 0 to (2, free) at 1
StatementBody StatementParser::path_statement() {
  next();
  if (!accept("from")) missing_clause("from", "path", kPathExample);
  return path_ends();
}

// (0, 1) at 0 to (2, free) at 1
PathStatement StatementParser::path_ends() {
  PathStatement path;
  path.from = path_end();
  if (!accept("to")) missing_clause("to", "path", kPathExample);
  path.to = path_end();
  return path;
}

// (0, free) at 1 s,   0 at 1 s,   (x = 0, x' = 1) at 1 s
PathStatement::End StatementParser::path_end() {
  PathStatement::End end;
  const Span first = peek().span;
  if (opens_named_components())
    named_components(end);
  else
    end.configuration = components();
  end.span = cover(first, previous().span);
  if (!accept("at")) missing_clause("at", "path", kPathExample);
  end.at = quantity();
  return end;
}

// Whether the bracket that opens here holds a list, and does not merely begin a formula such as (a + b)/2.
bool StatementParser::opens_components() const {
  if (!peek().is("(")) return false;
  int depth = 0;
  for (std::size_t i = 0; index_ + i < end_; ++i) {
    depth += peek(i).is("(") ? 1 : peek(i).is(")") ? -1 : 0;
    if (depth == 1 && peek(i).is(",")) return true;
    if (depth == 0) return peek(i + 1).is("at") || peek(i + 1).is("from") || peek(i + 1).is("=");
  }
  return false;
}

// Whether the bracket that opens here holds `x = …`.
bool StatementParser::opens_named_components() const {
  std::size_t i = 1;
  while (index_ + i < end_ && (peek(i).kind == Token::Kind::Name || peek(i).is("'") || peek(i).is("."))) ++i;
  return peek().is("(") && i > 1 && peek(i).is("=");
}

// (x = 0, x' = free)
void StatementParser::named_components(PathStatement::End& end) {
  next();
  do {
    end.names.push_back(variable());
    expect("=", fmt::format("`{}`", text_of(*end.names.back())));
    end.configuration.push_back(component());
  } while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)`");
  next();
}

// A value, or nothing where `free` stands.
ExpressionPtr StatementParser::component() {
  const bool free = peek().is("free") && !context_.declarations.contains("free") && accept("free");
  return free ? nullptr : quantity();
}

// One value a coordinate, `free` where none is asked for; a unit after the bracket is that of all: (1, 2) m.
std::vector<ExpressionPtr> StatementParser::components() {
  std::vector<ExpressionPtr> out;
  if (!opens_components()) return {component()};
  next();
  do out.push_back(component());
  while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)`");
  next();
  return with_unit_after(std::move(out));
}

// The unit that follows their bracket is that of all: (1, 2) m.
std::vector<ExpressionPtr> StatementParser::with_unit_after(std::vector<ExpressionPtr> out) {
  const bool reciprocal =
      peek().is("/") || (peek().kind == Token::Kind::Number && peek().text == "1" && peek(1).is("/"));
  if (!reciprocal && (peek().kind != Token::Kind::Name || is_clause_word(peek().text))) return out;
  const auto unit = units();
  if (!unit) fail_expected("a unit after the bracket");
  note(*unit);
  for (ExpressionPtr& value : out) {
    if (!value) continue;
    if (!is_constant(*value))
      fail("E0111", value->span,
           fmt::format("expected a number, since a unit follows the bracket, found `{}`", text_of(*value)),
           "A unit after a bracket is that of all its numbers.", "Write the unit, or none, at each of them.");
    auto quantity = std::make_shared<Expression>();
    quantity->kind = Expression::Kind::Quantity;
    quantity->span = value->span;
    quantity->depth = value->depth + 1;
    quantity->unit = unit;
    quantity->arguments = {value};
    value = quantity;
  }
  return out;
}

// action = 3 J s ± 1e-9,   action of path 2 = 3 J s ± 1e-9,   action of (4 t + 7, 3 t) from 0 s to 10 s = 435 J s ±
// 1e-9
expectation::Kind StatementParser::expect_action() {
  next();
  const auto right_side = [&] {
    expect("=", "`action`");
    return expected_number();
  };
  if (peek().is("of") && peek(1).is("path")) {
    next(), next();
    const int number = path_number();
    return expectation::Action{number, right_side()};
  }
  if (!accept("of")) return expectation::Action{0, right_side()};
  expectation::ActionAlong along;
  if (!peek().is("(")) fail_expected("`(` and the path", "Write for example expect action of (4 t, 3 t) = 435 ± 1e-9.");
  next();
  do along.q.push_back(formula());
  while (accept(","));
  if (!peek().is(")")) fail_expected("`,` or `)`");
  next();
  if (accept("from")) {
    along.from = quantity();
    expect("to", "the beginning of the path");
    along.to = quantity();
  }
  along.expected = right_side();
  return along;
}

// index = 1,   index of path 2 = 1
expectation::Kind StatementParser::expect_index() {
  next();
  expectation::MorseIndex out;
  if (accept("of")) {
    expect("path", "`of`");
    out.path = path_number();
  }
  expect("=", "`index`");
  out.index = quantity();
  return out;
}

// Which of the paths, the one with the smallest action first: 1, 2, …
int StatementParser::path_number() {
  const Token& count = peek();
  const auto number = whole_number();
  if (!number || *number < 1)
    fail("E0111", count.span, "expected which of the paths is meant: 1, 2, …",
         "The one with the smallest action is the first.");
  return *number;
}

// path x at 0.5 s = 0.2 m ± 1e-9,   path 2 x at 0.5 s = 0.2 m ± 1e-9
expectation::Kind StatementParser::expect_path() {
  next();
  expectation::PathAt out;
  if (peek().kind == Token::Kind::Number) out.path = path_number();
  out.subject = formula();
  expect("at", "what is expected of the path");
  out.time = quantity();
  expect("=", "the place on the path");
  out.expected = expected_number();
  return out;
}

}  // namespace maupertuis::syntax
