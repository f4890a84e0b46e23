#include "syntax/statement_parser.hpp"

/// Inequalities and what happens at an instant: contact, friction, event, impact.
namespace maupertuis::syntax {

// contact EXPR >= EXPR restitution e friction μ static μs slip EXPR name floor
StatementBody StatementParser::contact_statement() {
  next();
  ContactStatement statement;
  statement.left = formula();
  statement.at_most = peek().is("<=");
  if (!accept(">=") && !accept("<="))
    fail_expected("`>=` or `<=` after the left side of the contact",
                  peek().is("=")                     ? "What always touches is a constraint: constraint a = b."
                  : peek().is(">") || peek().is("<") ? fmt::format("A contact may close: write {}=.", peek().text)
                                                     : fmt::format("Write contact {} >= 0.", text_of(*statement.left)));
  statement.right = quantity();
  while (!at_end()) {
    if (accept("name"))
      statement.name = new_name("the name of the contact");
    else if (accept("restitution"))
      statement.restitution = clause_quantity("restitution", statement.restitution);
    else if (accept("friction"))
      statement.friction = clause_quantity("friction", statement.friction);
    else if (accept("static"))
      statement.static_friction = clause_quantity("static", statement.static_friction);
    else if (accept("slip"))
      statement.slip = clause_quantity("slip", statement.slip);
    else if (accept("sticking"))
      statement.sticking = true;
    else
      missing_clause("restitution, friction, static, slip, sticking or name", "contact",
                     "contact y >= 0 restitution e friction μ slip x' name floor");
  }
  return statement;
}

// friction q coefficient μ static μs normal EXPR,   friction q limit EXPR static EXPR
StatementBody StatementParser::friction_statement() {
  next();
  FrictionStatement statement;
  statement.coordinate = variable();
  while (!at_end()) {
    if (accept("coefficient"))
      statement.coefficient = clause_quantity("coefficient", statement.coefficient);
    else if (accept("static"))
      statement.static_friction = clause_quantity("static", statement.static_friction);
    else if (accept("normal"))
      statement.normal = clause_quantity("normal", statement.normal);
    else if (accept("limit"))
      statement.limit = clause_quantity("limit", statement.limit);
    else
      missing_clause("coefficient, static, normal or limit", "friction", "friction x coefficient μ normal m g");
  }
  if (!statement.limit && !statement.coefficient)
    missing_clause("coefficient", "friction", "friction x coefficient μ normal m g");
  if (!statement.limit && !statement.normal)
    missing_clause("normal", "friction", "friction x coefficient μ normal m g");
  return statement;
}

// event hit when EXPR = EXPR rising : record / stop / set x' = -x', y' = y'
StatementBody StatementParser::event_statement() {
  next();
  EventStatement statement;
  statement.name = new_name("the name of the event");
  expect("when", "the name of the event");
  statement.left = formula();
  expect("=", "the left side of the event");
  statement.right = quantity();
  if (accept("rising"))
    statement.direction = 1;
  else if (accept("falling"))
    statement.direction = -1;
  expect(":", "the condition of the event");
  if (accept("record")) return statement;
  if (accept("stop")) {
    statement.action = EventStatement::Action::Stop;
    return statement;
  }
  if (!accept("set")) fail_expected("`record`, `stop` or `set`");
  statement.action = EventStatement::Action::Set;
  list([&] { statement.sets.push_back(assignment()); });
  return statement;
}

StatementBody StatementParser::impact_statement() {
  next();
  ImpactStatement statement;
  statement.simultaneous = peek().is("simultaneous");
  if (!accept("sequential") && !accept("simultaneous")) fail_expected("`sequential` or `simultaneous`");
  return statement;
}

}  // namespace maupertuis::syntax
