#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// expect and claim: the model's own tests.
namespace maupertuis::syntax {

using Kind = ExpectStatement::Kind;

StatementBody StatementParser::expect_statement() { return expectation(false); }
StatementBody StatementParser::claim_statement() { return expectation(true); }

namespace {

/// What a model expects of its phase space is an equation whose left side is one of these words.
bool opens_phase_space(const Token& word, const Token& after) {
  return (word.is("hamiltonian") && after.is("=")) || (word.is("routhian") && after.is("of")) || (word.is("bracket") && after.is("("));
}

/// Words of variational problems are ordinary names where the model declares them.
bool opens_action(const Token& word, const Token& after) { return word.is("action") && (after.is("=") || after.is("of")); }
bool opens_index(const Token& word, const Token& after) { return word.is("index") && (after.is("=") || after.is("of")); }

/// `path x at …`, `path 2 x at …`; but `path = 3`, `path' at …` and `path at …` are about a quantity of that name.
bool opens_path(const Token& word, const Token& after) {
  return word.is("path") && ((after.kind == Token::Kind::Name && !is_clause_word(after.text)) || after.is("(") || after.kind == Token::Kind::Number);
}

}  // namespace

void StatementParser::tolerance(ExpectStatement& expect, bool required) {
  if (accept("±")) {
    expect.tolerance = quantity();
  } else if (accept("rel")) {
    expect.relative = true;
    expect.tolerance = quantity();
  } else if (required) {
    missing_clause("± or rel", "expectation", "expect θ at 10 s = 0.5 rad ± 1e-9");
  }
}

/// Nothing where the next word is no number, or one that is not whole, which is read all the same.
std::optional<int> StatementParser::whole_number() {
  if (peek().kind != Token::Kind::Number) return std::nullopt;
  const std::string_view text = next().text;
  const bool whole = text.size() <= 9 && text.find_first_not_of("0123456789") == std::string_view::npos;
  return whole ? std::optional(std::stoi(std::string(text))) : std::nullopt;
}

ExpectStatement StatementParser::expectation(bool claim) {
  next();
  ExpectStatement expect;
  expect.claim = claim;
  const bool declared = context_.declarations.contains(peek().text);
  if (peek().is("energy") && peek(1).is("conserved")) {
    next(), next();
    expect.kind = Kind::EnergyConserved;
    tolerance(expect, false);
  } else if (accept("conserved")) {
    expect_conserved(expect);
  } else if (accept("equation")) {
    expect.kind = Kind::Equation;
    expect.subject = formula();
    this->expect("=", "the left side of the equation");
    expect.value = formula();
  } else if (opens_phase_space(peek(), peek(1))) {
    expect_phase_space(expect);
  } else if (peek().is("freedoms") && peek(1).is("=")) {
    next(), next();
    expect.kind = Kind::Freedoms;
    expect.value = quantity();
  } else if (!declared && opens_action(peek(), peek(1))) {
    expect_action(expect);
  } else if (!declared && opens_index(peek(), peek(1))) {
    expect_index(expect);
  } else if (!declared && opens_path(peek(), peek(1))) {
    expect_path(expect);
  } else if (accept("constraint")) {
    expect.kind = Kind::ConstraintClass;
    expect.name = used_name("the name of a constraint");
    this->expect("is", "the name of the constraint");
    expect.word = used_name("its class, holonomic or nonholonomic");
  } else if (accept("integral")) {
    expect.kind = Kind::Integral;
    expect.subject = formula();
  } else if (accept("frequencies")) {
    expect_frequencies(expect);
  } else if (peek().is("equilibrium") && peek(1).is("at")) {
    next();
    expect_equilibrium(expect);
  } else if (accept("event")) {
    expect_event(expect);
  } else if (accept("until")) {
    expect.kind = Kind::UntilAt;
    this->expect("at", "`until`");
    expect.value = quantity();
    tolerance(expect, true);
  } else if (opens_matrix()) {
    expect_matrix(expect);
  } else if (!declared && peek().is("eigenvalues") && (peek(1).is("at") || peek(1).is(":"))) {
    expect_eigenvalues(expect);
  } else if (!declared && opens_return_map()) {
    expect_return_map(expect);
  } else if (!declared && (peek().is("stable") || peek().is("unstable")) && peek(1).is("for")) {
    expect_stable(expect);
  } else if (accept("error")) {
    expect.kind = Kind::Error;
    expect.name = used_name("the code of an error, such as E0412");
  } else {
    expect_value(expect);
  }
  return expect;
}

// θ at 10 s = 0.5 rad ± 1e-9,   x^2 + y^2 not conserved,   T = 3 J ± 1e-9,   claim θ'' = -g/l sin θ
void StatementParser::expect_value(ExpectStatement& expect) {
  expect.subject = formula();
  if (accept("not")) {
    if (!peek().is("conserved")) fail_expected("`conserved` after `not`");
    next();
    expect.kind = Kind::NotConserved;
    return;
  }
  const bool timed = accept("at");
  expect.at_until = timed && accept("until");
  if (timed && !expect.at_until) expect.time = quantity();
  this->expect("=", timed ? "the time" : "what is expected");
  if (expect.claim && !timed) {
    expect.kind = Kind::Equation;
    expect.value = formula();
    return;
  }
  expect.kind = timed ? Kind::ValueAt : Kind::Value;
  expect.value = quantity();
  tolerance(expect, timed);
}

// m r^2 φ',   F where p_φ = 0,   m r^2 φ' rel 1e-12
void StatementParser::expect_conserved(ExpectStatement& expect) {
  expect.kind = Kind::Conserved;
  expect.subject = formula();
  if (!accept("where")) return tolerance(expect, false);
  do {
    ExpectStatement::Level level;
    level.left = formula();
    this->expect("=", "the left side of the level");
    level.right = quantity();
    expect.where.push_back(std::move(level));
  } while (accept(","));
  if (peek().is("±") || peek().is("rel"))
    fail("E0111", peek().span, "a drift is measured along the model's own run, and no level is asked for there",
         "On a level conservation is proved, or at least tested at many states.", "Leave out the tolerance, or the level.");
}

// at θ = 0 is stable,   at x = 0.8369151 ± 1e-7, y = 0
void StatementParser::expect_equilibrium(ExpectStatement& expect) {
  expect.kind = Kind::Equilibrium;
  this->expect("at", "`equilibrium`");
  do {
    expect.at.push_back(assignment());
    ExpectStatement one;
    tolerance(one, false);
    expect.at_tolerances.push_back({one.tolerance, one.relative});
  } while (accept(","));
  if (accept("is")) expect.word = used_name("stable, unstable or undecided");
}

// at θ = 0 : 0.5 Hz, 1.2 Hz rel 1e-9
void StatementParser::expect_frequencies(ExpectStatement& expect) {
  expect.kind = Kind::Frequencies;
  expect.squared = accept("squared");
  expect_point(expect);
  this->expect(":", "the configuration");
  do expect.values.push_back(quantity());
  while (accept(","));
  tolerance(expect, true);
}

// hamiltonian = H,   routhian of φ, ψ = R,   bracket (A, B) = C
void StatementParser::expect_phase_space(ExpectStatement& expect) {
  expect.kind = Kind::Equation;
  expect.word = used_name("hamiltonian, routhian or bracket");
  if (accept("of")) {
    do expect.values.push_back(formula());
    while (accept(","));
  } else if (accept("(")) {
    expect.subject = formula();
    this->expect(",", "the first function of the bracket");
    expect.values.push_back(formula());
    this->expect(")", "the second function of the bracket");
  }
  this->expect("=", "what stands on the left");
  expect.value = formula();
}

// hit 3 at 0.45 s ± 1e-11
void StatementParser::expect_event(ExpectStatement& expect) {
  expect.kind = Kind::EventAt;
  expect.name = used_name("the name of an event");
  expect.occurrence = 1;
  if (peek().kind == Token::Kind::Number) {
    const Token& count = peek();
    expect.occurrence = whole_number().value_or(0);
    if (expect.occurrence < 1) fail("E0111", count.span, "expected which occurrence of the event is meant: 1, 2, …");
  }
  this->expect("at", "the event");
  expect.time = quantity();
  tolerance(expect, true);
}

}  // namespace maupertuis::syntax
