#include <maupertuis/field_statements.hpp>

#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// field, density, boundary, forces on fields, and what is expected of fields.
namespace maupertuis::syntax {
namespace {

FieldStatement field_clause(std::string what, FieldClause clause) {
  return {std::move(what), std::make_shared<const FieldClause>(std::move(clause))};
}

expectation::Kind of_field(FieldExpectation said) {
  return expectation::OfField{std::make_shared<const FieldExpectation>(std::move(said))};
}

}  // namespace

// u(x) : angle, and those before the colon that share its kind
void StatementParser::field_items(FieldDeclaration& field) {
  do {
    FieldDeclaration::Item item;
    item.name = new_name("the name of a field");
    expect("(", "the name of the field");
    do item.variables.push_back(new_name("a space variable"));
    while (accept(","));
    expect(")", "the space variables");
    field.items.push_back(std::move(item));
  } while (accept(","));
  expect(":", "the field");
  FieldDeclaration::Item& last = field.items.back();
  if (peek().is("complex")) {
    last.kind = {std::string(next().text), previous().span};
    if (peek().is("[")) last.unit = bracketed_unit();  // of both parts
  } else {
    kind_of(last.name, "field", last.kind, last.unit);
  }
  for (FieldDeclaration::Item& item : field.items) {
    item.kind = last.kind;
    item.unit = last.unit;
  }
}

// field u(x) : angle on x = -20 m .. 20 m cells 800 order 4 boundary u_x = 0
StatementBody StatementParser::field_statement() {
  next();
  FieldDeclaration field;
  field_items(field);
  const std::string variable = field.items.front().variables.front().text;
  if (accept("on")) {
    do {
      FieldDeclaration::Range range;
      range.variable = used_name("a space variable", fmt::format("Write on {} = {}.", variable, item_text()));
      expect("=", "the space variable");
      const ExpressionPtr from = quantity();
      expect("..", "the first end");
      range.to = quantity();
      range.from = with_unit_of(from, *range.to);
      field.ranges.push_back(std::move(range));
    } while (accept(","));
  }
  if (accept("cells")) {
    do field.cells.push_back(before("order", [&] { return quantity(); }));
    while (accept(",") || accept("by"));
  }
  if (accept("order")) field.order = quantity();
  if (!accept("boundary")) return field_clause("field", {std::move(field)});
  for (const std::string_view side : {"left", "right", "bottom", "top"})
    if (peek().is(side) && !peek(1).is("="))
      fail_expected(
          "a condition that holds on all sides, such as `u = 0`",
          fmt::format("Write the conditions of one side on a line of their own, `boundary {} : u = 0`.", side));
  const std::size_t first = index_ - 1;
  field.periodic = accept("periodic");
  if (!field.periodic)
    list([&] { field.boundary.push_back(boundary_condition()); });
  else if (!at_end())
    list([&] { field.around.push_back(used_name("a space variable, as in `boundary periodic x`")); });
  field.boundary_span = cover(context_.list.tokens[first].span, previous().span);
  return field_clause("field", {std::move(field)});
}

Equation StatementParser::boundary_condition() {
  Equation out;
  out.left = formula();
  expect("=", "the boundary value");
  out.right = quantity();
  return out;
}

StatementBody StatementParser::density_statement() {
  DensityText density;
  density.dissipation = accept("dissipation");
  density.name_span = next().span;
  density.adds = accept("+=");
  if (!density.adds && !accept("=")) {
    const bool named = peek(1).is("=");  // density L = …
    fail_expected("`=` after `density`", fmt::format("Write density = {}.", item_text(named ? 2 : 0)));
  }
  density.value = formula();
  return field_clause(density.dissipation ? "dissipation density" : "density", {std::move(density)});
}

// boundary left : u = 0, u_x = 0;  boundary u = 0, on all sides
StatementBody StatementParser::boundary_statement() {
  next();
  BoundaryText boundary;
  if (peek().is("periodic"))
    fail_expected("a condition", "Write `boundary periodic` at the end of the field's line, behind its domain.");
  const bool all_sides = peek().kind == Token::Kind::Name && peek(1).is("=");
  if (!all_sides) {
    boundary.side = used_name("left, right, bottom or top",
                              "Name the side of the domain: `boundary left : w = 0, w_x = 0`; without one, all sides.");
    expect(":", "the side of the boundary");
  }
  list([&] { boundary.conditions.push_back(boundary_condition()); });
  return field_clause("boundary", {std::move(boundary)});
}

// force density u = f;  force u(l) = F
StatementBody StatementParser::field_force_statement() {
  next();
  const bool density = peek().is("density") && peek(1).kind == Token::Kind::Name;
  if (density) next();
  FieldForce force;
  force.on = variable();
  expect("=", fmt::format("`{}`", text_of(*force.on)));
  force.value = quantity();
  return field_clause(density ? "force density" : "force", {std::move(force)});
}

// ------------------------------------------------------------------------------------------------------ expectations

/// What is read of the statement up to `word` outside brackets, which is no reserved word: flux, order.
ExpressionPtr StatementParser::before(std::string_view word, const std::function<ExpressionPtr()>& read) {
  const std::size_t end = end_;
  int depth = 0;
  for (std::size_t i = index_; i < end; ++i) {
    const Token& token = context_.list.tokens[i];
    depth += token.is("(") || token.is("[") ? 1 : token.is(")") || token.is("]") ? -1 : 0;
    if (depth > 0 || !token.is(word)) continue;
    end_ = i;
    break;
  }
  ExpressionPtr out = read();
  end_ = end;
  return out;
}

/// Words of fields are ordinary names where the model declares them.
bool StatementParser::opens_field_expectation() const {
  const Token& word = peek();
  if (word.is("frequencies")) return peek(1).is("of");
  if (context_.declarations.contains(word.text)) return false;
  const Token& after = peek(1);
  const bool operand =
      after.kind == Token::Kind::Name || after.kind == Token::Kind::Number || after.is("(") || after.is("-");
  return operand &&
         (word.is("natural") || word.is("solution") || word.is("total") || word.is("current") || word.is("dispersion"));
}

std::vector<Equation> StatementParser::equations_of_list() {
  std::vector<Equation> out;
  do {
    Equation one;
    one.left = formula();
    expect("=", "the left side");
    one.right = formula();
    out.push_back(std::move(one));
  } while (accept(","));
  return out;
}

expectation::Kind StatementParser::expect_of_field() {
  if (accept("natural")) return of_field({FieldExpectation::Natural{equations_of_list()}});
  if (accept("solution")) return of_field({FieldExpectation::Solution{equations_of_list()}});
  if (accept("dispersion")) {
    const std::vector<Equation> one = equations_of_list();
    return of_field({FieldExpectation::Dispersion{one.front().left, one.front().right}});
  }
  if (accept("total")) {
    FieldExpectation::Total total;
    total.density = formula();
    if (accept("at")) {
      total.at_equilibrium = !context_.declarations.contains("equilibrium") && accept("equilibrium");
      if (!total.at_equilibrium) total.time = quantity();
    }
    expect("=", "the density");
    total.expected = expected_number();
    return of_field({std::move(total)});
  }
  if (accept("current")) {
    FieldExpectation::Current current;
    current.density = before("flux", [&] { return formula(); });
    expect("flux", "the density of the current");
    do current.fluxes.push_back(formula());
    while (accept(","));
    return of_field({std::move(current)});
  }
  next();
  next();  // frequencies of
  FieldExpectation::Frequencies frequencies;
  frequencies.field = used_name("the name of a field");
  expect(":", "the name of the field");
  do frequencies.values.push_back(quantity());
  while (accept(","));
  frequencies.tolerance = tolerance(true);
  return of_field({std::move(frequencies)});
}

}  // namespace maupertuis::syntax
