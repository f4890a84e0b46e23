#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

/// expect and claim: what is checked here is that both sides can be equal at all.
namespace maupertuis::elaboration {
namespace {

using syntax::ExpectStatement;
using syntax::Expression;
using Kind = ExpectStatement::Kind;

/// The quantity below signs, whose unit the value is shown in.
const Expression& unsigned_quantity(const Expression& x) {
  return x.kind == Expression::Kind::Unary ? unsigned_quantity(*x.arguments[0]) : x;
}

}  // namespace

void set_display_unit(Elaboration& e, Expectation& out, const Expression& value) {
  const Expression& q = unsigned_quantity(value);
  if (q.kind != Expression::Kind::Quantity || !q.unit || !all_units(*q.unit)) return;
  const std::optional<Unit> unit = unit_of(e, *q.unit);
  if (!unit || !unit->dimension.same_as(out.dimension)) return;
  out.display_unit = written_unit(e.source, *q.unit);
  out.display_factor = maupertuis::evaluate(factor_of(e.context, *unit), Bindings{});
}

bool tolerance_of(Elaboration& e, Expectation& out, const ExpectStatement& s, const Dimension& dimension) {
  if (!s.tolerance) return true;
  out.relative = s.relative;
  const bool own_unit = unsigned_quantity(*s.tolerance).kind == Expression::Kind::Quantity;
  const Value v = constant_of(e, *s.tolerance, s.relative || !own_unit ? Dimension{} : dimension,
                              s.relative ? "a relative tolerance" : "a tolerance");
  if (v.poisoned) return false;
  const bool in_display_unit = !s.relative && !own_unit && !out.display_unit.empty();
  const std::optional<double> size = constant_value(e, v.scalar());
  if (size && !(*size >= 0)) {
    e.diagnostics.error("E0222", s.tolerance->span, "a tolerance is not negative",
                        "It is the largest difference that passes.", "");
    return false;
  }
  out.tolerance = v.scalar();
  const bool turns = out.kind == Kind::Frequencies && !out.squared && v.hertz;  // values are kept in rad/s
  if (turns) out.tolerance = v.scalar() * e.number(2) * e.context.pi();
  if (in_display_unit) out.tolerance = v.scalar() * Rational::from_double(out.display_factor);
  return true;
}

namespace {

bool unit_and_tolerance(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  set_display_unit(e, out, *s.value);
  return tolerance_of(e, out, s, out.dimension);
}

std::optional<Value> number(Elaboration& e, const Expression& x, const Place& place = {}) {
  const Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return std::nullopt;
  if (!v.is_vector) return v;
  e.diagnostics.error("E0210", x.span, "an expectation is about a number, not a vector", "",
                      "Take a component with .x or .y, or its length with norm(…).");
  return std::nullopt;
}

/// E0246 where the run of the model does not end at a condition.
bool refuse_without_until(Elaboration& e, Span span) {
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* run = std::get_if<syntax::RunStatement>(&s.body); run && run->until_left) return false;
  e.diagnostics.error("E0246", span, "the run of this model does not end at a condition",
                      "`until` is the moment at which the condition of `run until` is met.",
                      "Add it, for example `run until P.y = 0 within 60 s`, or expect the value at a time.");
  return true;
}

/// until at 1.2 s ± 1e-9
bool until_at(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const Value value = constant_of(e, *s.value, e.time(), in_words(e, "the time of an expectation"));
  if (value.poisoned || refuse_without_until(e, out.span)) return false;
  out.value = value.scalar();
  out.dimension = e.time();
  return unit_and_tolerance(e, out, s);
}

bool value_at(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = true;
  const std::optional<Value> subject = number(e, *s.subject, place);
  out.at_until = s.at_until;
  if (s.at_until && refuse_without_until(e, out.span)) return false;
  if (s.time) {
    const Value time = constant_of(e, *s.time, e.time(), in_words(e, "the time of an expectation"));
    if (time.poisoned) return false;
    out.time = time.scalar();
  }
  if (!subject) return false;
  out.subject = subject->scalar();
  out.dimension = subject->dimension;
  const Dimension expected = subject->fits_any ? Dimension{} : subject->dimension;
  const Value value = constant_of(e, *s.value, expected, fmt::format("`{}`", e.source.slice(s.subject->span)));
  if (value.poisoned) return false;
  out.value = value.scalar();
  return unit_and_tolerance(e, out, s);
}

void warn_identity(Elaboration& e, const Expectation& out) {
  e.diagnostics.warning("W0420", out.span, "this expectation says nothing",
                        "Its two sides are the same formula: it holds for every motion of every system.",
                        "Expect something that the equations of motion decide.");
}

bool equation(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = true;
  const Value left = evaluate_formula(e, *s.subject, place);
  if (!left.poisoned) place.expected = left.dimension;
  const Value right = evaluate_formula(e, *s.value, place);
  if (left.poisoned || right.poisoned) return false;
  for (const Value* v : {&left, &right}) {
    if (!v->is_vector) continue;
    e.diagnostics.error("E0210", (v == &left ? s.subject : s.value)->span, "an equation is about numbers, not vectors",
                        "", "Write one for each component.");
    return false;
  }
  if (!left.fits_any && !right.fits_any && !left.dimension.same_as(right.dimension) && !e.dimensionless) {
    e.diagnostics.error(
        "E0304", s.value->span,
        fmt::format("the left side is {}, this is {}", describe(left.dimension), describe(right.dimension)),
        "Both sides of an equation have one dimension.", "");
    return false;
  }
  out.subject = left.scalar();
  out.subject_right = right.scalar();
  out.dimension = left.fits_any ? right.dimension : left.dimension;
  const Expr difference[] = {out.subject - out.subject_right};
  if (difference[0].is_zero() || zero_test(expand_time_derivatives(difference[0])).verdict == Verdict::Zero)
    warn_identity(e, out);
  return true;
}

/// A coordinate as a name alone.
Expr coordinate_named(Elaboration& e, const Expression& x) {
  const Coordinate* c = x.kind == Expression::Kind::Name && x.primes == 0 ? e.system().find_coordinate(x.text) : nullptr;
  if (c) return c->q;
  e.diagnostics.error("E0228", x.span, fmt::format("`{}` is no coordinate", e.source.slice(x.span)),
                      "A Routhian replaces velocities of coordinates by their momenta.",
                      "Name them, separated by commas: expect routhian of φ, ψ = …");
  return {};
}

/// hamiltonian = H, routhian of φ = R: energies in q, p and, for the latter, the other velocities.
bool energy_of_phase_space(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = true;
  for (const syntax::ExpressionPtr& x : s.values) {
    out.values.push_back(coordinate_named(e, *x));
    if (!out.values.back()) return false;
  }
  const std::string what = out.values.empty() ? "the Hamiltonian" : "the Routhian";
  const Value v = scalar_of(e, *s.value, e.system().lagrangian_dimension, what, place);
  if (v.poisoned) return false;
  out.subject_right = v.scalar();
  out.dimension = v.dimension;
  return true;
}

/// {A, B} = C has the dimension of A B divided by that of q p, an action.
bool bracket(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = true;
  const std::optional<Value> a = number(e, *s.subject, place), b = number(e, *s.values[0], place), c = number(e, *s.value, place);
  if (!a || !b || !c) return false;
  out.subject = a->scalar();
  out.values = {b->scalar()};
  out.subject_right = c->scalar();
  out.dimension = a->dimension * b->dimension / (e.system().lagrangian_dimension * e.time());
  if (e.dimensionless || a->fits_any || b->fits_any || c->fits_any || c->dimension.same_as(out.dimension)) return true;
  e.diagnostics.error("E0304", s.value->span,
                      fmt::format("the bracket is {}, this is {}", describe(out.dimension), describe(c->dimension)),
                      "{A, B} has the dimension of A B divided by that of q p, an action.", "");
  return false;
}

/// where p_φ = 0: left − right, which vanishes on the level.
bool levels(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = true;
  for (const ExpectStatement::Level& level : s.where) {
    const std::optional<Value> left = number(e, *level.left, place);
    if (!left) return false;
    const Value right = scalar_of(e, *level.right, left->dimension, fmt::format("`{}`", e.source.slice(level.left->span)), place);
    if (right.poisoned || refuse_acceleration(e, *left, *level.left, "a level") || refuse_acceleration(e, right, *level.right, "a level"))
      return false;
    out.where.push_back(left->scalar() - right.scalar());
  }
  return true;
}

bool about_subject(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  Place place;
  place.reactions = s.kind != Kind::Integral;  // momenta
  const std::optional<Value> subject = number(e, *s.subject, place);
  if (!subject || !levels(e, out, s)) return false;
  // Forces of constraints cannot be differentiated: without them the same has to have a meaning.
  if (subject->order >= 2 && !number(e, *s.subject)) return false;
  out.subject = subject->scalar();
  out.dimension = subject->dimension;
  if (out.kind != Kind::NotConserved && !e.context.depends_on_time(out.subject.id())) warn_identity(e, out);
  return tolerance_of(e, out, s, out.dimension);
}

bool freedoms(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const Value v = constant_of(e, *s.value, Dimension{}, "a number of freedoms");
  if (v.poisoned) return false;
  out.value = v.scalar();
  return true;
}

bool frequencies(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  bool good = point_of_expectation(e, out, s);
  const Dimension rate = Dimension{} / e.time();
  out.squared = s.squared;
  out.dimension = e.dimension(s.squared ? rate * rate : rate);
  for (const auto& x : s.values) {
    const Expression& q = unsigned_quantity(*x);
    const Value v = constant_of(e, *x, out.dimension, s.squared ? "the square of a frequency" : "a frequency");
    good = good && !v.poisoned;
    if (q.kind == Expression::Kind::Quantity) set_display_unit(e, out, *x);
    if (v.poisoned) continue;
    const Expr turn = v.hertz && !s.squared ? e.number(2) * e.context.pi() : e.number(1);  // kept in rad/s
    out.values.push_back(v.scalar() * turn);
    out.display_factor *= maupertuis::evaluate(turn, Bindings{});
  }
  return tolerance_of(e, out, s, out.dimension) && good;
}

/// ± 1e-7 beside one value of the point.
bool point_tolerance(Elaboration& e, Expectation& out, const ExpectStatement& s, std::size_t i) {
  Expectation one;
  ExpectStatement written;
  const StartValue& place = out.at[i];
  const Dimension& q = e.system().coordinates[place.coordinate].dimension;
  if (place.order > 0 && s.at_tolerances[i].size) {
    e.diagnostics.error("E0250", s.at_tolerances[i].size->span, "a rate is given, not found",
                        "A steady motion belongs to its rates: the coordinates are solved for, beginning at their values.",
                        "Give the tolerance beside a coordinate, and the rate without one.");
    return false;
  }
  one.dimension = place.order == 0 ? q : q / e.time();
  written.tolerance = s.at_tolerances[i].size;
  written.relative = s.at_tolerances[i].relative;
  set_display_unit(e, one, *s.at[i].value);
  const bool good = tolerance_of(e, one, written, one.dimension);
  out.at_tolerances.push_back({one.tolerance, one.relative, one.display_unit, one.display_factor});
  return good;
}

bool equilibrium(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const bool known = s.word.text.empty() || s.word.text == "stable" || s.word.text == "unstable" || s.word.text == "undecided";
  if (!known)
    e.diagnostics.error("E0238", s.word.span, fmt::format("`{}` is no word for the stability of an equilibrium", s.word.text),
                        "The energy or the eigenvalues prove it stable or unstable, or the linearization does not decide.",
                        "Write stable, unstable or undecided.");
  if (!point_of_expectation(e, out, s) || !known) return false;
  bool good = true;
  for (std::size_t i = 0; i < s.at.size(); ++i) good = point_tolerance(e, out, s, i) && good;
  return good;
}

bool later(Elaboration& e, Span span) {
  e.diagnostics.error("E0503", span, "not supported yet: an expected event",
                      "Contacts and events are carried out by a later version.", "Leave this line out for now.");
  return false;
}

bool fill(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  switch (s.kind) {
    case Kind::ValueAt:
    case Kind::Value:
      return value_at(e, out, s);
    case Kind::EnergyConserved:
      return tolerance_of(e, out, s, e.system().lagrangian_dimension);
    case Kind::Conserved:
    case Kind::NotConserved:
    case Kind::Integral:
      return about_subject(e, out, s);
    case Kind::Equation:
      return s.word.text.empty() ? equation(e, out, s)
             : s.subject           ? bracket(e, out, s)
                                   : energy_of_phase_space(e, out, s);
    case Kind::Freedoms:
      return freedoms(e, out, s);
    case Kind::Frequencies:
      return frequencies(e, out, s);
    case Kind::Equilibrium:
      return equilibrium(e, out, s);
    case Kind::ConstraintClass:
      return check_class_of_constraint(e, s);
    case Kind::EventAt:
      return later(e, out.span);
    case Kind::Action:
      return expect_action(e, out, s) && unit_and_tolerance(e, out, s);
    case Kind::MorseIndex:
      return expect_index(e, out, s);
    case Kind::PathAt:
      return expect_on_path(e, out, s) && unit_and_tolerance(e, out, s);
    case Kind::Eigenvalues:
    case Kind::Matrix:
    case Kind::Stable:
    case Kind::Multipliers:
    case Kind::Trace:
    case Kind::Period:
      return expect_of_neighbours(e, out, s);
    case Kind::UntilAt:
      return until_at(e, out, s);
    case Kind::Error:
      return true;
  }
  return false;
}

}  // namespace

bool point_of_expectation(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  bool good = true;
  for (const auto& item : s.at) {
    const std::optional<StartValue> value = start_value(e, item);
    good = good && value;
    if (value) out.at.push_back(*value);
  }
  return good;
}

void elaborate_expectation(Elaboration& e, const ExpectStatement& s, Span span) {
  Expectation out;
  out.kind = s.kind;
  out.claim = s.claim;
  out.text = std::string(e.source.slice(span));
  out.name = s.name.text;
  out.word = s.word.text;
  out.occurrence = s.occurrence;
  out.span = span;
  if (refuse_motion_of_path(e, s, span)) return;
  if (fill(e, out, s)) e.experiment().expectations.push_back(std::move(out));
}

}  // namespace maupertuis::elaboration
