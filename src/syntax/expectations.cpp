#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// expect and claim: the model's own tests.
namespace maupertuis::syntax {

StatementBody StatementParser::expect_statement() {
  next();
  ExpectStatement statement{false, expected(false)};
  if (accept("with")) {
    const std::size_t first = index_;
    do assignment();
    while (accept(","));
    statement.with = cover(context_.list.tokens[first].span, previous().span);
  }
  return statement;
}

StatementBody StatementParser::claim_statement() {
  next();
  return ExpectStatement{true, expected(true)};
}

namespace {

/// What a model expects of its phase space is an equation whose left side is one of these words.
bool opens_phase_space(const Token& word, const Token& after) {
  return (word.is("hamiltonian") && after.is("=")) || (word.is("routhian") && after.is("of")) ||
         (word.is("bracket") && after.is("(")) || (word.is("dirac") && after.is("bracket"));
}

/// Words of variational problems are ordinary names where the model declares them.
bool opens_action(const Token& word, const Token& after) {
  return word.is("action") && (after.is("=") || after.is("of"));
}
bool opens_index(const Token& word, const Token& after) {
  return word.is("index") && (after.is("=") || after.is("of"));
}

/// `path x at …`, `path 2 x at …`; but `path = 3`, `path' at …` and `path at …` are about a quantity of that name.
bool opens_path(const Token& word, const Token& after) {
  return word.is("path") && ((after.kind == Token::Kind::Name && !is_clause_word(after.text)) || after.is("(") ||
                             after.kind == Token::Kind::Number);
}

}  // namespace

// 2 sin(3) [m] ± 1e-9
void StatementParser::refuse_unit_behind_formula() {
  std::size_t last = 0;
  while (index_ + last < end_ && !peek(last).is("]")) ++last;
  const Span unit = cover(peek().span, index_ + last < end_ ? peek(last).span : peek().span);
  fail("E0111", unit, "a unit in square brackets stands directly after a number",
       "Behind a formula it would not say how far back it reaches.",
       fmt::format("Multiply by it: … * 1 {}.", text_of(unit)));
}

// 0.5 rad +- 1e-9, which is a sum for the grammar, and +/-.
void StatementParser::refuse_spelled_tolerance() {
  const std::vector<Token>& tokens = context_.list.tokens;
  for (std::size_t i = end_ - 1; i > 0 && !tokens[i].is("expect"); --i) {
    const Token &plus = tokens[i - 1], &minus = tokens[i];
    if (!plus.is("+") || !minus.is("-") || !minus.attached) continue;
    fail("E0127", cover(plus.span, minus.span), "`+-` is not read as ±", "It is a sum with a negative number.",
         "Write ± (U+00B1), or rel and a part: ± 1e-9, rel 1e-6.");
  }
}

Tolerance StatementParser::tolerance(bool required) {
  if (accept("±")) return {quantity(), false};
  if (accept("rel")) return {quantity(), true};
  if (required && peek().is("[")) refuse_unit_behind_formula();
  if (required && at_end()) refuse_spelled_tolerance();
  if (required && at_end())
    fail("E0127", statement_span(), "this expectation does not say how near the value has to be",
         "A computed value agrees with a number only up to an error.",
         "Add ± and the largest error, or rel and a part: ± 1e-9, rel 1e-6.");
  if (required) missing_clause("± or rel", "expectation", "expect θ at 10 s = 0.5 rad ± 1e-9");
  return {};
}

// 0.5 rad ± 1e-9
expectation::Number StatementParser::expected_number() {
  expectation::Number number;
  number.value = quantity();
  number.tolerance = tolerance(true);
  return number;
}

/// Nothing where the next word is no number, or one that is not whole, which is read all the same.
std::optional<int> StatementParser::whole_number() {
  if (peek().kind != Token::Kind::Number) return std::nullopt;
  const std::string_view text = next().text;
  const bool whole = text.size() <= 9 && text.find_first_not_of("0123456789") == std::string_view::npos;
  return whole ? std::optional(std::stoi(std::string(text))) : std::nullopt;
}

expectation::Kind StatementParser::expected(bool claim) {
  const bool declared = context_.declarations.contains(peek().text);
  if (peek().is("energy") && peek(1).is("conserved")) {
    next(), next();
    return expectation::EnergyConserved{tolerance(false)};
  }
  if (accept("conserved")) return expect_conserved();
  if (accept("equation")) return expect_equation();
  if (opens_phase_space(peek(), peek(1))) return expect_phase_space();
  if (peek().is("freedoms") && peek(1).is("=")) {
    next(), next();
    return expectation::Freedoms{quantity()};
  }
  if (!declared && opens_action(peek(), peek(1))) return expect_action();
  if (!declared && opens_index(peek(), peek(1))) return expect_index();
  if (!declared && opens_path(peek(), peek(1))) return expect_path();
  if (!declared && opens_degenerate()) return expect_degenerate();
  if (opens_field_expectation()) return expect_of_field();
  if (accept("constraint")) return expect_class();
  if (accept("integral")) return expectation::Integral{formula()};
  if (accept("frequencies")) return expect_frequencies();
  const bool names_follow = !declared && peek(1).kind == Token::Kind::Name;
  if (peek().is("equilibrium") && (peek(1).is("at") || names_follow)) return expect_equilibrium();
  if (accept("event")) return expect_event();
  if (accept("until")) return expect_until();
  if (opens_matrix()) return expect_matrix();
  if (!declared && peek().is("eigenvalues") && (peek(1).is("at") || peek(1).is(":"))) return expect_eigenvalues();
  if (!declared && opens_return_map()) return expect_return_map();
  if (!declared && (peek().is("stable") || peek().is("unstable")) && peek(1).is("for")) return expect_stable();
  if (accept("error")) return expectation::Error{used_name("the code of an error, such as E0412")};
  return expect_value(claim);
}

expectation::Kind StatementParser::expect_equation() {
  Equation equation;
  equation.left = formula();
  expect("=", "the left side of the equation");
  equation.right = formula();
  return equation;
}

// roll is nonholonomic
expectation::Kind StatementParser::expect_class() {
  expectation::ConstraintClass out;
  out.constraint = used_name("the name of a constraint");
  expect("is", "the name of the constraint");
  out.word = used_name("its class, holonomic or nonholonomic");
  return out;
}

// at 1.2 s ± 1e-9
expectation::Kind StatementParser::expect_until() {
  expect("at", "`until`");
  return expectation::UntilAt{expected_number()};
}

/// θ(3) = 0.1: a value at a time, as books write it.
void StatementParser::refuse_time_in_brackets() {
  const Token& name = peek();
  const Declarations::Kind kind = context_.declarations.kind(name.text);
  if (kind != Declarations::Kind::Coordinate && kind != Declarations::Kind::Angle) return;
  std::size_t i = 1;
  while (peek(i).is("'")) ++i;
  const std::size_t open = i;
  if (!peek(open).is("(") || !peek(open).attached || peek(open + 1).kind != Token::Kind::Number) return;
  while (peek(i).kind != Token::Kind::End && !peek(i).is(")")) ++i;
  if (!peek(i).is(")") || !peek(i + 1).is("=")) return;
  const std::string subject = text_of(cover(name.span, peek(open - 1).span));
  fail("E0121", cover(name.span, peek(i).span),
       fmt::format("`{}` would be a product", text_of(cover(name.span, peek(i).span))),
       fmt::format("{} depends on time by itself; a value at a time is asked for with `at`.", subject),
       fmt::format("Write {} at 3 s = ….", subject));
}

/// What is expected without its `=`.
void StatementParser::refuse_half(bool claim, const std::string& subject) {
  fail_expected("`=` after what is expected",
                subject == "energy" ? "Write expect energy conserved."
                : claim             ? fmt::format("Write both sides of the equation, such as claim {} = 0.", subject)
                : peek().is("is")
                    ? fmt::format("Write expect conserved {0}, or expect {0} at 3 s = ….", subject)
                    : fmt::format("Write for example expect {0} at 3 s = …, or expect conserved {0}.", subject));
}

// θ at 10 s = 0.5 rad ± 1e-9,   x^2 + y^2 not conserved,   T = 3 J ± 1e-9,   claim θ'' = -g/l sin θ
expectation::Kind StatementParser::expect_value(bool claim) {
  refuse_time_in_brackets();
  const ExpressionPtr subject = formula();
  if (accept("not")) {
    if (!peek().is("conserved")) fail_expected("`conserved` after `not`");
    next();
    return expectation::NotConserved{subject};
  }
  const bool timed = accept("at");
  const bool until = timed && accept("until");
  const ExpressionPtr time = timed && !until ? quantity() : nullptr;
  if (!timed && !peek().is("=")) refuse_half(claim, text_of(*subject));
  expect("=", timed ? "the time" : "what is expected");
  if (claim && !timed) return Equation{subject, formula()};
  expectation::Number number;
  number.value = quantity();
  number.tolerance = tolerance(timed);
  if (until) return expectation::ValueAtUntil{subject, number};
  return expectation::ValueAt{subject, time, number};
}

// m r^2 φ',   F where p_φ = 0,   m r^2 φ' rel 1e-12
expectation::Kind StatementParser::expect_conserved() {
  expectation::Conserved conserved;
  conserved.subject = formula();
  if (!accept("where")) {
    const Tolerance drift = tolerance(false);
    return drift.size ? expectation::Kind(expectation::ConservedAlongRun{conserved.subject, drift})
                      : expectation::Kind(conserved);
  }
  do {
    Equation level;
    level.left = formula();
    expect("=", "the left side of the level");
    level.right = quantity();
    conserved.where.push_back(std::move(level));
  } while (accept(","));
  if (peek().is("±") || peek().is("rel"))
    fail("E0111", peek().span, "a drift is measured along the model's own run, and no level is asked for there",
         "On a level conservation is proved, or at least tested at many states.",
         "Leave out the tolerance, or the level.");
  return conserved;
}

// equilibrium at θ = 0 is stable,   equilibrium at x = 0.8369151 ± 1e-7, y = 0,   equilibrium at u(l/2) = 1 m ± 1e-9
expectation::Kind StatementParser::expect_equilibrium() {
  next();
  expect("at", "`equilibrium`");
  expectation::Equilibrium equilibrium;
  do {
    expectation::Place place;
    place.value = assignment(true);
    place.tolerance = tolerance(false);
    equilibrium.at.push_back(std::move(place));
  } while (accept(","));
  if (accept("is")) equilibrium.word = used_name("stable, unstable or undecided");
  return equilibrium;
}

// at θ = 0 : 0.5 Hz, 1.2 Hz rel 1e-9
expectation::Kind StatementParser::expect_frequencies() {
  expectation::Frequencies frequencies;
  frequencies.squared = accept("squared");
  frequencies.at = expected_point();
  expect(":", "the configuration");
  do frequencies.values.push_back(quantity());
  while (accept(","));
  frequencies.tolerance = tolerance(true);
  return frequencies;
}

// hamiltonian = H,   routhian of φ, ψ = R,   bracket (A, B) = C
expectation::Kind StatementParser::expect_phase_space() {
  const auto right_side = [&] {
    expect("=", "what stands on the left");
    return formula();
  };
  if (accept("hamiltonian")) return expectation::Hamiltonian{right_side()};
  if (accept("routhian")) {
    expectation::Routhian routhian;
    expect("of", "`routhian`");
    do routhian.coordinates.push_back(formula());
    while (accept(","));
    routhian.value = right_side();
    return routhian;
  }
  expectation::Bracket bracket;
  bracket.dirac = accept("dirac");
  next(), next();
  bracket.a = formula();
  expect(",", "the first function of the bracket");
  bracket.b = formula();
  expect(")", "the second function of the bracket");
  bracket.value = right_side();
  return bracket;
}

bool StatementParser::opens_degenerate() const {
  const Token &word = peek(), &after = peek(1);
  return (word.is("constraints") && after.is(":")) || (word.is("motions") && after.is("=")) ||
         (word.is("physical") && after.is("freedoms")) || (word.is("free") && after.is("functions")) ||
         ((word.is("first") || word.is("second")) && after.is("class")) || word.is("contradiction");
}

// constraints : p_y ; z ; p_x,   first class = 3,   motions = 2,   contradiction
expectation::Kind StatementParser::expect_degenerate() {
  const Token& word = next();
  if (word.is("contradiction")) return expectation::Error{{"contradiction", word.span}};
  if (word.is("constraints")) {
    next();
    expectation::PhaseConstraints out;
    do {
      out.generations.emplace_back();
      do out.generations.back().push_back(formula());
      while (accept(","));
    } while (accept(";"));
    return out;
  }
  std::string what(word.text);
  if (!word.is("motions")) what += " " + std::string(next().text);
  expect("=", what);
  return expectation::ClassCount{what, quantity()};
}

// hit 3 at 0.45 s ± 1e-11
expectation::Kind StatementParser::expect_event() {
  const Name name = used_name("the name of an event or a contact");
  Name change;
  for (const char* word : {"impact", "made", "lost", "stick", "slip"})
    if (peek().is(word)) change = {std::string(peek().text), peek().span};
  if (!change.text.empty()) next();
  if (accept("=")) return expectation::EventCount{name, change, quantity()};
  expectation::Event event{name, change, 1, {}};
  if (peek().kind == Token::Kind::Number) {
    const Token& count = peek();
    event.occurrence = whole_number().value_or(0);
    if (event.occurrence < 1) fail("E0111", count.span, "expected which occurrence of the event is meant: 1, 2, …");
  }
  expect("at", "the event");
  event.time = expected_number();
  return event;
}

}  // namespace maupertuis::syntax
