#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

/// expect and claim: what is checked here is that both sides can be equal at all.
namespace maupertuis::elaboration {

using syntax::ExpectStatement;
using syntax::Expression;
using Kind = ExpectStatement::Kind;

// ---------------------------------------------------------------------------------------------------------- the parts

const Expression& unsigned_quantity(const Expression& x) {
  return x.kind == Expression::Kind::Unary ? unsigned_quantity(*x.arguments[0]) : x;
}

std::optional<expectation::DisplayUnit> display_unit(Elaboration& e, const Expression& value, const Dimension& dimension) {
  const Expression& q = unsigned_quantity(value);
  if (q.kind != Expression::Kind::Quantity || !q.unit || !all_units(*q.unit)) return std::nullopt;
  const std::optional<Unit> unit = unit_of(e, *q.unit);
  if (!unit || !unit->dimension.same_as(dimension)) return std::nullopt;
  return expectation::DisplayUnit{written_unit(e.texts, *q.unit), maupertuis::evaluate(factor_of(e.context, *unit), Bindings{})};
}

std::optional<expectation::Tolerance> tolerance_of(Elaboration& e, const syntax::ExpressionPtr& size, bool relative, const Dimension& dimension,
                                                   const expectation::DisplayUnit& unit, bool* hertz) {
  if (!size) return expectation::Tolerance{};
  const bool own_unit = unsigned_quantity(*size).kind == Expression::Kind::Quantity;
  const Value v = constant_of(e, *size, relative || !own_unit ? Dimension{} : dimension, relative ? "a relative tolerance" : "a tolerance");
  if (v.poisoned) return std::nullopt;
  const std::optional<double> number = constant_value(e, v.scalar());
  if (number && !(*number >= 0)) {
    e.diagnostics.error("E0222", size->span, "a tolerance is not negative", "It is the largest difference that passes.", "");
    return std::nullopt;
  }
  if (hertz) *hertz = v.hertz;
  const bool in_display_unit = !relative && !own_unit && !unit.name.empty();
  return expectation::Tolerance{in_display_unit ? v.scalar() * Rational::from_double(unit.factor) : v.scalar(), relative};
}

std::optional<expectation::Number> expected_number(Elaboration& e, const ExpectStatement& s, const Dimension& dimension, const std::string& what) {
  const Value value = constant_of(e, *s.value, dimension, what);
  if (value.poisoned) return std::nullopt;
  const expectation::DisplayUnit unit = display_unit(e, *s.value, dimension).value_or(expectation::DisplayUnit{});
  const auto tolerance = tolerance_of(e, s.tolerance, s.relative, dimension, unit);
  if (!tolerance) return std::nullopt;
  return expectation::Number{value.scalar(), *tolerance, unit};
}

std::optional<Value> number_of(Elaboration& e, const Expression& x, const Place& place, const char* what) {
  const Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return std::nullopt;
  if (!v.is_vector) return v;
  e.diagnostics.error("E0210", x.span, fmt::format("{} is about a number, not a vector", what), "",
                      "Take a component with .x or .y, or its length with norm(…).");
  return std::nullopt;
}

std::optional<std::vector<StartValue>> point_of_expectation(Elaboration& e, const ExpectStatement& s) {
  std::vector<StartValue> out;
  for (const auto& item : s.at)
    if (auto value = start_value(e, item)) out.push_back(std::move(*value));
  return out.size() == s.at.size() ? std::optional(std::move(out)) : std::nullopt;
}

namespace {

std::optional<Value> number(Elaboration& e, const Expression& x, const Place& place = {}) { return number_of(e, x, place, "an expectation"); }

/// Momenta, multipliers and reactions may stand there.
Place along_motion() {
  Place place;
  place.reactions = true;
  return place;
}

bool runs_until(const Elaboration& e) {
  if (e.overrides.run) return e.overrides.run->until_left != nullptr;
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* run = std::get_if<syntax::RunStatement>(&s.body); run && run->until_left) return true;
  return false;
}

}  // namespace

bool refuse_without_until(Elaboration& e, Span span) {
  if (runs_until(e)) return false;
  e.diagnostics.error("E0246", span, "the run of this model does not end at a condition",
                      "`until` is the moment at which the condition of `run until` is met.",
                      "Add it, for example `run until P.y = 0 within 60 s`, or expect the value at a time.");
  return true;
}

// ------------------------------------------------------------------------------------------------------- along the run

namespace {

/// until at 1.2 s ± 1e-9
Expected until_at(Elaboration& e, const ExpectStatement& s, Span span) {
  const auto time = expected_number(e, s, e.time(), in_words(e, "the time of an expectation"));
  if (!time || refuse_without_until(e, span)) return std::nullopt;
  return expectation::UntilAt{*time};
}

/// θ at 10 s = 0.5 rad ± 1e-9,   θ at until = …,   T = 3 J ± 1e-9
Expected value_at(Elaboration& e, const ExpectStatement& s, Span span) {
  const std::optional<Value> subject = number(e, *s.subject, along_motion());
  if (s.at_until && refuse_without_until(e, span)) return std::nullopt;
  Expr at;
  if (s.time) {
    const Value time = constant_of(e, *s.time, e.time(), in_words(e, "the time of an expectation"));
    if (time.poisoned) return std::nullopt;
    at = time.scalar();
  }
  if (!subject) return std::nullopt;
  const Dimension dimension = subject->fits_any ? Dimension{} : subject->dimension;
  const auto expected = expected_number(e, s, dimension, fmt::format("`{}`", e.texts.slice(s.subject->span)));
  if (!expected) return std::nullopt;
  if (s.at_until) return expectation::ValueAtUntil{subject->scalar(), *expected};
  return expectation::ValueAt{subject->scalar(), at, *expected};
}

Expected energy_conserved(Elaboration& e, const ExpectStatement& s) {
  const auto tolerance = tolerance_of(e, s.tolerance, s.relative, e.system().lagrangian_dimension, {});
  return tolerance ? Expected(expectation::EnergyConserved{*tolerance}) : std::nullopt;
}

// ---------------------------------------------------------------------------------------------------------- identities

void warn_identity(Elaboration& e, Span span) {
  e.diagnostics.warning("W0420", span, "this expectation says nothing",
                        "Its two sides are the same formula: it holds for every motion of every system.",
                        "Expect something that the equations of motion decide.");
}

Expected equation(Elaboration& e, const ExpectStatement& s, Span span) {
  Place place = along_motion();
  const Value left = evaluate_formula(e, *s.subject, place);
  if (!left.poisoned) place.expected = left.dimension;
  const Value right = evaluate_formula(e, *s.value, place);
  if (left.poisoned || right.poisoned) return std::nullopt;
  for (const Value* v : {&left, &right}) {
    if (!v->is_vector) continue;
    e.diagnostics.error("E0210", (v == &left ? s.subject : s.value)->span, "an equation is about numbers, not vectors",
                        "", "Write one for each component.");
    return std::nullopt;
  }
  if (!left.fits_any && !right.fits_any && !left.dimension.same_as(right.dimension) && !e.dimensionless) {
    e.diagnostics.error(
        "E0304", s.value->span,
        fmt::format("the left side is {}, this is {}", describe(left.dimension), describe(right.dimension)),
        "Both sides of an equation have one dimension.", "");
    return std::nullopt;
  }
  const Expr difference = left.scalar() - right.scalar();
  if (difference.is_zero() || zero_test(expand_time_derivatives(difference)).verdict == Verdict::Zero) warn_identity(e, span);
  return expectation::Equation{left.scalar(), right.scalar()};
}

/// The index of a coordinate as a name alone.
std::optional<std::size_t> coordinate_named(Elaboration& e, const Expression& x) {
  const Coordinate* c = x.kind == Expression::Kind::Name && x.primes == 0 ? e.system().find_coordinate(x.text) : nullptr;
  if (c) return static_cast<std::size_t>(c - e.system().coordinates.data());
  e.diagnostics.error("E0228", x.span, fmt::format("`{}` is no coordinate", e.texts.slice(x.span)),
                      "A Routhian replaces velocities of coordinates by their momenta.",
                      "Name them, separated by commas: expect routhian of φ, ψ = …");
  return std::nullopt;
}

/// hamiltonian = H, routhian of φ = R: energies in q, p and, for the latter, the other velocities.
Expected energy_of_phase_space(Elaboration& e, const ExpectStatement& s) {
  std::vector<std::size_t> replaced;
  for (const syntax::ExpressionPtr& x : s.values) {
    const auto coordinate = coordinate_named(e, *x);
    if (!coordinate) return std::nullopt;
    replaced.push_back(*coordinate);
  }
  const bool is_routhian = !s.values.empty();
  const Value v = scalar_of(e, *s.value, e.system().lagrangian_dimension, is_routhian ? "the Routhian" : "the Hamiltonian", along_motion());
  if (v.poisoned) return std::nullopt;
  if (is_routhian) return expectation::Routhian{std::move(replaced), v.scalar()};
  return expectation::Hamiltonian{v.scalar()};
}

/// {A, B} = C has the dimension of A B divided by that of q p, an action.
Expected bracket(Elaboration& e, const ExpectStatement& s) {
  const Place place = along_motion();
  const std::optional<Value> a = number(e, *s.subject, place), b = number(e, *s.values[0], place), c = number(e, *s.value, place);
  if (!a || !b || !c) return std::nullopt;
  const Dimension dimension = a->dimension * b->dimension / (e.system().lagrangian_dimension * e.time());
  if (e.dimensionless || a->fits_any || b->fits_any || c->fits_any || c->dimension.same_as(dimension))
    return expectation::Bracket{a->scalar(), b->scalar(), c->scalar()};
  e.diagnostics.error("E0304", s.value->span,
                      fmt::format("the bracket is {}, this is {}", describe(dimension), describe(c->dimension)),
                      "{A, B} has the dimension of A B divided by that of q p, an action.", "");
  return std::nullopt;
}

/// where p_φ = 0: left − right, which vanishes on the level.
std::optional<std::vector<Expr>> levels(Elaboration& e, const ExpectStatement& s) {
  const Place place = along_motion();
  std::vector<Expr> out;
  for (const ExpectStatement::Level& level : s.where) {
    const std::optional<Value> left = number(e, *level.left, place);
    if (!left) return std::nullopt;
    const Value right = scalar_of(e, *level.right, left->dimension, fmt::format("`{}`", e.texts.slice(level.left->span)), place);
    if (right.poisoned || refuse_acceleration(e, *left, *level.left, "a level") || refuse_acceleration(e, right, *level.right, "a level"))
      return std::nullopt;
    out.push_back(left->scalar() - right.scalar());
  }
  return out;
}

/// conserved F, F not conserved, integral F
Expected about_subject(Elaboration& e, const ExpectStatement& s, Span span) {
  Place place;
  place.reactions = s.kind != Kind::Integral;  // momenta
  const std::optional<Value> subject = number(e, *s.subject, place);
  if (!subject) return std::nullopt;
  auto where = levels(e, s);
  if (!where) return std::nullopt;
  // Forces of constraints cannot be differentiated: without them the same has to have a meaning.
  if (subject->order >= 2 && !number(e, *s.subject)) return std::nullopt;
  if (s.kind != Kind::NotConserved && !e.context.depends_on_time(subject->scalar().id())) warn_identity(e, span);
  if (s.kind == Kind::NotConserved) return expectation::NotConserved{subject->scalar()};
  if (s.kind == Kind::Integral) return expectation::Integral{subject->scalar()};
  if (!s.tolerance) return expectation::Conserved{subject->scalar(), std::move(*where)};
  const auto tolerance = tolerance_of(e, s.tolerance, s.relative, subject->dimension, {});
  return tolerance ? Expected(expectation::ConservedAlongRun{subject->scalar(), *tolerance}) : std::nullopt;
}

Expected freedoms(Elaboration& e, const ExpectStatement& s) {
  const Value v = constant_of(e, *s.value, Dimension{}, "a number of freedoms");
  return v.poisoned ? std::nullopt : Expected(expectation::Freedoms{v.scalar()});
}

// -------------------------------------------------------------------------------------------------------- about a point

Expected frequencies(Elaboration& e, const ExpectStatement& s) {
  expectation::Frequencies out;
  auto point = point_of_expectation(e, s);
  const Dimension rate = Dimension{} / e.time();
  const Dimension dimension = e.dimension(s.squared ? rate * rate : rate);
  const Expr full_turn = e.number(2) * e.context.pi();   // values are kept in rad/s
  out.squared = s.squared;
  bool good = point.has_value();
  for (const auto& x : s.values) {
    const Value v = constant_of(e, *x, dimension, s.squared ? "the square of a frequency" : "a frequency");
    good = good && !v.poisoned;
    if (const auto unit = display_unit(e, *x, dimension)) out.unit = *unit;
    if (v.poisoned) continue;
    const bool turns = v.hertz && !s.squared;
    out.values.push_back(turns ? v.scalar() * full_turn : v.scalar());
    if (turns) out.unit.factor *= maupertuis::evaluate(full_turn, Bindings{});
  }
  bool turns = false;
  const auto tolerance = tolerance_of(e, s.tolerance, s.relative, dimension, out.unit, &turns);
  if (!tolerance || !good) return std::nullopt;
  out.at = std::move(*point);
  out.tolerance = *tolerance;
  if (turns && !s.squared) out.tolerance.size = tolerance->size * full_turn;
  return out;
}

/// One value of the point, perhaps ± 1e-7.
std::optional<expectation::Place> place_of_equilibrium(Elaboration& e, const ExpectStatement& s, std::size_t i, StartValue value) {
  const ExpectStatement::Tolerance& written = s.at_tolerances[i];
  if (!written.size) return expectation::Place{std::move(value), std::nullopt, {}};
  if (value.order > 0) {
    e.diagnostics.error("E0250", written.size->span, "a rate is given, not found",
                        "A steady motion belongs to its rates: the coordinates are solved for, beginning at their values.",
                        "Give the tolerance beside a coordinate, and the rate without one.");
    return std::nullopt;
  }
  const Dimension dimension = e.system().coordinates[value.coordinate].dimension;
  const expectation::DisplayUnit unit = display_unit(e, *s.at[i].value, dimension).value_or(expectation::DisplayUnit{});
  const auto tolerance = tolerance_of(e, written.size, written.relative, dimension, unit);
  if (!tolerance) return std::nullopt;
  return expectation::Place{std::move(value), *tolerance, unit};
}

Expected equilibrium(Elaboration& e, const ExpectStatement& s) {
  const bool known = s.word.text.empty() || s.word.text == "stable" || s.word.text == "unstable" || s.word.text == "undecided";
  if (!known)
    e.diagnostics.error("E0238", s.word.span, fmt::format("`{}` is no word for the stability of an equilibrium", s.word.text),
                        "The energy or the eigenvalues prove it stable or unstable, or the linearization does not decide.",
                        "Write stable, unstable or undecided.");
  const auto point = point_of_expectation(e, s);
  if (!point || !known) return std::nullopt;
  expectation::Equilibrium out;
  out.word = s.word.text;
  for (std::size_t i = 0; i < point->size(); ++i)
    if (auto place = place_of_equilibrium(e, s, i, (*point)[i])) out.at.push_back(std::move(*place));
  return out.at.size() == point->size() ? Expected(std::move(out)) : std::nullopt;
}

Expected later(Elaboration& e, Span span) {
  e.diagnostics.error("E0503", span, "not supported yet: an expected event",
                      "Contacts and events are carried out by a later version.", "Leave this line out for now.");
  return std::nullopt;
}

Expected meaning_of(Elaboration& e, const ExpectStatement& s, Span span) {
  switch (s.kind) {
    case Kind::ValueAt:
    case Kind::Value: return value_at(e, s, span);
    case Kind::UntilAt: return until_at(e, s, span);
    case Kind::EnergyConserved: return energy_conserved(e, s);
    case Kind::Conserved:
    case Kind::NotConserved:
    case Kind::Integral: return about_subject(e, s, span);
    case Kind::Equation: return s.word.text.empty() ? equation(e, s, span) : s.subject ? bracket(e, s) : energy_of_phase_space(e, s);
    case Kind::Freedoms: return freedoms(e, s);
    case Kind::ConstraintClass:
      return check_class_of_constraint(e, s) ? Expected(expectation::ConstraintClass{s.name.text, s.word.text}) : std::nullopt;
    case Kind::Frequencies: return frequencies(e, s);
    case Kind::Equilibrium: return equilibrium(e, s);
    case Kind::Eigenvalues: return expect_eigenvalues(e, s);
    case Kind::Matrix: return expect_matrix(e, s);
    case Kind::Stable: return expect_stable(e, s);
    case Kind::Multipliers:
    case Kind::Trace:
    case Kind::Period: return expect_return_map(e, s);
    case Kind::Action: return expect_action(e, s, span);
    case Kind::MorseIndex: return expect_index(e, s, span);
    case Kind::PathAt: return expect_on_path(e, s, span);
    case Kind::EventAt: return later(e, span);
    case Kind::Error: return expectation::Error{s.name.text};
  }
  return std::nullopt;
}

}  // namespace

void elaborate_expectation(Elaboration& e, const ExpectStatement& s, Span span) {
  if (refuse_motion_of_path(e, s, span)) return;
  if (auto kind = meaning_of(e, s, span))
    e.experiment().expectations.push_back({std::string(e.texts.slice(span)), s.claim, span, std::move(*kind)});
}

}  // namespace maupertuis::elaboration
