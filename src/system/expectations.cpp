#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

/// expect and claim: what is checked here is that both sides can be equal at all.
namespace maupertuis::elaboration {

using syntax::Expression;

// ---------------------------------------------------------------------------------------------------------- the parts

const Expression& unsigned_quantity(const Expression& x) {
  return x.kind == Expression::Kind::Unary ? unsigned_quantity(*x.arguments[0]) : x;
}

std::optional<expectation::DisplayUnit> display_unit(Elaboration& e, const Expression& value,
                                                     const Dimension& dimension) {
  const Expression& q = unsigned_quantity(value);
  if (q.kind != Expression::Kind::Quantity || !q.unit || !all_units(*q.unit)) return std::nullopt;
  if (has_words_of_no_unit(e, q)) return std::nullopt;
  const std::optional<Unit> unit = unit_of(e, *q.unit);
  if (!unit || !unit->dimension.same_as(dimension)) return std::nullopt;
  return expectation::DisplayUnit{written_unit(e.texts, *q.unit),
                                  maupertuis::evaluate(factor_of(e.context, *unit), Bindings{})};
}

std::optional<expectation::Tolerance> tolerance_of(Elaboration& e, const syntax::Tolerance& tolerance,
                                                   const Dimension& dimension, const expectation::DisplayUnit& unit,
                                                   bool* hertz) {
  const auto& [size, relative] = tolerance;
  if (!size) return expectation::Tolerance{};
  const bool own_unit = unsigned_quantity(*size).kind == Expression::Kind::Quantity;
  const Value v = constant_of(e, *size, relative || !own_unit ? Dimension{} : dimension,
                              relative ? "a relative tolerance" : "a tolerance");
  if (v.poisoned) return std::nullopt;
  const std::optional<double> number = constant_value(e, v.scalar());
  if (number && !(*number >= 0)) {
    e.diagnostics.error("E0222", size->span, "a tolerance is not negative", "It is the largest difference that passes.",
                        "");
    return std::nullopt;
  }
  if (hertz) *hertz = v.hertz;
  const bool in_display_unit = !relative && !own_unit && !unit.name.empty();
  return expectation::Tolerance{in_display_unit ? v.scalar() * Rational::from_double(unit.factor) : v.scalar(),
                                relative};
}

std::optional<expectation::Number> expected_number(Elaboration& e, const written::Number& number,
                                                   const Dimension& dimension, const std::string& what) {
  const Value value = constant_of(e, *number.value, dimension, what);
  if (value.poisoned) return std::nullopt;
  warn_of_degrees(e, value, dimension, *number.value);
  const expectation::DisplayUnit unit = display_unit(e, *number.value, dimension).value_or(expectation::DisplayUnit{});
  const auto tolerance = tolerance_of(e, number.tolerance, dimension, unit);
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

std::optional<std::vector<StartValue>> point_of_expectation(Elaboration& e, const written::Point& point) {
  std::vector<StartValue> out;
  std::vector<StartCondition> rates;
  bool good = true;
  for (const auto& item : point) {
    if (is_rate(e, *item.variable)) {
      const std::vector<StartCondition> given = start_conditions(e, item);
      good = good && !given.empty();
      rates.insert(rates.end(), given.begin(), given.end());
    } else if (auto value = start_value(e, item)) {
      out.push_back(std::move(*value));
    } else {
      good = false;
    }
  }
  return good && add_velocities_of_rates(e, rates, out) ? std::optional(std::move(out)) : std::nullopt;
}

namespace {

std::optional<Value> number(Elaboration& e, const Expression& x, const Place& place = {}) {
  return number_of(e, x, place, "an expectation");
}

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
Expected meaning_of(Elaboration& e, const written::UntilAt& x, Span line) {
  const auto time = expected_number(e, x.expected, e.time(), in_words(e, "the time of an expectation"));
  if (!time || refuse_without_until(e, line)) return std::nullopt;
  return expectation::UntilAt{*time};
}

/// The value that is expected of a quantity.
std::optional<expectation::Number> number_beside(Elaboration& e, const Value& subject, const Expression& formula,
                                                 const written::Number& number) {
  return expected_number(e, number, subject.fits_any ? Dimension{} : subject.dimension,
                         fmt::format("`{}`", e.texts.slice(formula.span)));
}

/// θ at 10 s = 0.5 rad ± 1e-9,   T = 3 J ± 1e-9
Expected meaning_of(Elaboration& e, const written::ValueAt& x, Span) {
  const std::optional<Value> subject = number(e, *x.subject, along_motion());
  Expr at;
  if (x.time) {
    const Value time = constant_of(e, *x.time, e.time(), in_words(e, "the time of an expectation"));
    if (time.poisoned) return std::nullopt;
    at = time.scalar();
  }
  if (!subject || refuse_along_motion(e, *subject, *x.subject)) return std::nullopt;
  const auto expected = number_beside(e, *subject, *x.subject, x.expected);
  return expected ? Expected(expectation::ValueAt{subject->scalar(), at, *expected}) : std::nullopt;
}

/// θ at until = 0.5 rad ± 1e-9
Expected meaning_of(Elaboration& e, const written::ValueAtUntil& x, Span line) {
  const std::optional<Value> subject = number(e, *x.subject, along_motion());
  if (refuse_without_until(e, line) || !subject || refuse_along_motion(e, *subject, *x.subject)) return std::nullopt;
  const auto expected = number_beside(e, *subject, *x.subject, x.expected);
  return expected ? Expected(expectation::ValueAtUntil{subject->scalar(), *expected}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::EnergyConserved& x, Span) {
  const auto tolerance = tolerance_of(e, x.tolerance, e.system().lagrangian_dimension, {});
  return tolerance ? Expected(expectation::EnergyConserved{*tolerance}) : std::nullopt;
}

// ---------------------------------------------------------------------------------------------------------- identities

void warn_identity(Elaboration& e, Span span) {
  e.diagnostics.warning("W0420", span, "this expectation says nothing",
                        "Its two sides are the same formula: it holds for every motion of every system.",
                        "Expect something that the equations of motion decide.");
}

/// An angle more or less is no mistake of its own: g/l is an angular acceleration.
std::string advice_on_sides(const Dimension& found, const Dimension& expected) {
  const std::string advice = dimension_advice(found, expected);
  return advice.empty() ? dimension_advice(found * dimensions::angle(), expected) : advice;
}

Expected meaning_of(Elaboration& e, const written::Equation& x, Span line) {
  Place place = along_motion();
  const Value left = evaluate_formula(e, *x.left, place);
  if (!left.poisoned) place.expected = left.dimension;
  const Value right = evaluate_formula(e, *x.right, place);
  if (left.poisoned || right.poisoned) return std::nullopt;
  for (const Value* v : {&left, &right}) {
    if (!v->is_vector) continue;
    e.diagnostics.error("E0210", (v == &left ? x.left : x.right)->span, "an equation is about numbers, not vectors", "",
                        "Write one for each component.");
    return std::nullopt;
  }
  if (!left.fits_any && !right.fits_any && !left.dimension.same_as(right.dimension) && !e.dimensionless) {
    e.diagnostics.error(
        "E0304", x.right->span,
        fmt::format("the left side is {}, this is {}", describe(left.dimension), describe(right.dimension)),
        "Both sides of an equation have one dimension.", advice_on_sides(right.dimension, left.dimension));
    return std::nullopt;
  }
  const Expr difference = left.scalar() - right.scalar();
  if (difference.is_zero() || zero_test(expand_time_derivatives(difference)).verdict == Verdict::Zero)
    warn_identity(e, line);
  return expectation::Equation{left.scalar(), right.scalar()};
}

/// The index of a coordinate as a name alone.
std::optional<std::size_t> coordinate_named(Elaboration& e, const Expression& x) {
  const Coordinate* c =
      x.kind == Expression::Kind::Name && x.primes == 0 ? e.system().find_coordinate(x.text) : nullptr;
  if (c) return static_cast<std::size_t>(c - e.system().coordinates.data());
  e.diagnostics.error("E0228", x.span, fmt::format("`{}` is no coordinate", e.texts.slice(x.span)),
                      "A Routhian replaces velocities of coordinates by their momenta.",
                      "Name them, separated by commas: expect routhian of φ, ψ = …");
  return std::nullopt;
}

/// An energy in q, p and perhaps velocities; an empty handle after a mistake.
Expr energy_of_phase_space(Elaboration& e, const Expression& x, const char* what) {
  const Value v = scalar_of(e, x, e.system().lagrangian_dimension, what, along_motion());
  return v.poisoned ? Expr() : v.scalar();
}

Expected meaning_of(Elaboration& e, const written::Hamiltonian& x, Span) {
  const Expr value = energy_of_phase_space(e, *x.value, "the Hamiltonian");
  return value ? Expected(expectation::Hamiltonian{value}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::Routhian& x, Span) {
  expectation::Routhian out;
  for (const syntax::ExpressionPtr& name : x.coordinates) {
    const auto coordinate = coordinate_named(e, *name);
    if (!coordinate) return std::nullopt;
    out.coordinates.push_back(*coordinate);
  }
  out.value = energy_of_phase_space(e, *x.value, "the Routhian");
  return out.value ? Expected(std::move(out)) : std::nullopt;
}

/// {A, B} = C has the dimension of A B divided by that of q p, an action.
Expected meaning_of(Elaboration& e, const written::Bracket& x, Span) {
  const Place place = along_motion();
  const std::optional<Value> a = number(e, *x.a, place), b = number(e, *x.b, place), c = number(e, *x.value, place);
  if (!a || !b || !c) return std::nullopt;
  const Dimension dimension = a->dimension * b->dimension / (e.system().lagrangian_dimension * e.time());
  if (e.dimensionless || a->fits_any || b->fits_any || c->fits_any || c->dimension.same_as(dimension))
    return expectation::Bracket{a->scalar(), b->scalar(), c->scalar(), x.dirac};
  e.diagnostics.error("E0304", x.value->span,
                      fmt::format("the bracket is {}, this is {}", describe(dimension), describe(c->dimension)),
                      "{A, B} has the dimension of A B divided by that of q p, an action.", "");
  return std::nullopt;
}

/// where p_φ = 0: left − right, which vanishes on the level.
std::optional<std::vector<Expr>> levels(Elaboration& e, const std::vector<syntax::Equation>& where) {
  const Place place = along_motion();
  std::vector<Expr> out;
  for (const syntax::Equation& level : where) {
    const std::optional<Value> left = number(e, *level.left, place);
    if (!left) return std::nullopt;
    const Value right =
        scalar_of(e, *level.right, left->dimension, fmt::format("`{}`", e.texts.slice(level.left->span)), place);
    if (right.poisoned || refuse_acceleration(e, *left, *level.left, "a level") ||
        refuse_acceleration(e, right, *level.right, "a level"))
      return std::nullopt;
    out.push_back(left->scalar() - right.scalar());
  }
  return out;
}

/// A quantity whose derivative along the motion is asked for. Forces of constraints cannot be differentiated: where an
/// acceleration stands in it, it has to have a meaning without them.
std::optional<Value> differentiable(Elaboration& e, const Expression& x, const Place& place = along_motion()) {
  const std::optional<Value> subject = number(e, x, place);
  if (subject && subject->order >= 2 && !number(e, x)) return std::nullopt;
  if (subject && refuse_along_motion(e, *subject, x)) return std::nullopt;
  return subject;
}

/// A constant of every motion of every system.
void warn_of_constant(Elaboration& e, const Value& subject, Span line) {
  if (!e.context.depends_on_time(subject.scalar().id())) warn_identity(e, line);
}

Expected meaning_of(Elaboration& e, const written::Conserved& x, Span line) {
  const auto subject = differentiable(e, *x.subject);
  if (!subject) return std::nullopt;
  auto where = levels(e, x.where);
  if (!where) return std::nullopt;
  warn_of_constant(e, *subject, line);
  return expectation::Conserved{subject->scalar(), std::move(*where)};
}

Expected meaning_of(Elaboration& e, const written::ConservedAlongRun& x, Span line) {
  const auto subject = differentiable(e, *x.subject);
  if (!subject) return std::nullopt;
  warn_of_constant(e, *subject, line);
  const auto tolerance = tolerance_of(e, x.tolerance, subject->dimension, {});
  return tolerance ? Expected(expectation::ConservedAlongRun{subject->scalar(), *tolerance}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::NotConserved& x, Span) {
  const auto subject = differentiable(e, *x.subject);
  return subject ? Expected(expectation::NotConserved{subject->scalar()}) : std::nullopt;
}

/// Without momenta.
Expected meaning_of(Elaboration& e, const written::Integral& x, Span line) {
  const auto subject = differentiable(e, *x.subject, Place{});
  if (!subject) return std::nullopt;
  warn_of_constant(e, *subject, line);
  return expectation::Integral{subject->scalar()};
}

Expected meaning_of(Elaboration& e, const written::Freedoms& x, Span) {
  const Value v = constant_of(e, *x.number, Dimension{}, "a number of freedoms");
  return v.poisoned ? std::nullopt : Expected(expectation::Freedoms{v.scalar()});
}

Expected meaning_of(Elaboration& e, const written::PhaseConstraints& x, Span) {
  expectation::PhaseConstraints out;
  for (const auto& generation : x.generations) {
    out.generations.emplace_back();
    for (const syntax::ExpressionPtr& function : generation) {
      const std::optional<Value> v = number(e, *function, along_motion());
      if (!v || refuse_acceleration(e, *v, *function, "a constraint of phase space")) return std::nullopt;
      out.generations.back().push_back(v->scalar());
    }
  }
  return out;
}

Expected meaning_of(Elaboration& e, const written::ClassCount& x, Span) {
  using What = expectation::ClassCount::What;
  const Value v = constant_of(e, *x.number, Dimension{}, "a number of constraints or freedoms");
  if (v.poisoned) return std::nullopt;
  const What what = x.what == "first class"         ? What::FirstClass
                    : x.what == "second class"      ? What::SecondClass
                    : x.what == "physical freedoms" ? What::PhysicalFreedoms
                    : x.what == "motions"           ? What::Motions
                                                    : What::FreeFunctions;
  return expectation::ClassCount{what, v.scalar()};
}

Expected meaning_of(Elaboration& e, const written::ConstraintClass& x, Span) {
  if (!check_class_of_constraint(e, x)) return std::nullopt;
  return expectation::ConstraintClass{x.constraint.text, x.word.text};
}

// -------------------------------------------------------------------------------------------------------- about a
// point

Expected meaning_of(Elaboration& e, const written::Frequencies& x, Span) {
  expectation::Frequencies out;
  auto point = point_of_expectation(e, x.at);
  const Dimension rate = Dimension{} / e.time();
  const Dimension dimension = e.dimension(x.squared ? rate * rate : rate);
  const Expr full_turn = e.number(2) * e.context.pi();  // values are kept in rad/s
  out.squared = x.squared;
  bool good = point.has_value();
  for (const auto& value : x.values) {
    const Value v = expected_constant_of(e, *value, dimension, x.squared ? "the square of a frequency" : "a frequency");
    good = good && !v.poisoned;
    if (const auto unit = display_unit(e, *value, dimension)) out.unit = *unit;
    if (v.poisoned) continue;
    const bool turns = v.hertz && !x.squared;
    out.values.push_back(turns ? v.scalar() * full_turn : v.scalar());
    if (turns) out.unit.factor *= maupertuis::evaluate(full_turn, Bindings{});
  }
  bool turns = false;
  const auto tolerance = tolerance_of(e, x.tolerance, dimension, out.unit, &turns);
  if (!tolerance || !good) return std::nullopt;
  out.at = std::move(*point);
  out.tolerance = *tolerance;
  if (turns && !x.squared) out.tolerance.size = tolerance->size * full_turn;
  return out;
}

/// One value of the point, perhaps ± 1e-7.
std::optional<expectation::Place> place_of_equilibrium(Elaboration& e, const written::Place& x, StartValue value) {
  if (!x.tolerance.size) return expectation::Place{std::move(value), std::nullopt, {}};
  if (value.order > 0) {
    e.diagnostics.error(
        "E0250", x.tolerance.size->span, "a rate is given, not found",
        "A steady motion belongs to its rates: the coordinates are solved for, beginning at their values.",
        "Give the tolerance beside a coordinate, and the rate without one.");
    return std::nullopt;
  }
  const Dimension dimension = e.system().coordinates[value.coordinate].dimension;
  const expectation::DisplayUnit unit = display_unit(e, *x.value.value, dimension).value_or(expectation::DisplayUnit{});
  const auto tolerance = tolerance_of(e, x.tolerance, dimension, unit);
  if (!tolerance) return std::nullopt;
  return expectation::Place{std::move(value), *tolerance, unit};
}

Expected meaning_of(Elaboration& e, const written::Equilibrium& x, Span line) {
  const std::string& word = x.word.text;
  const bool known = word.empty() || word == "stable" || word == "unstable" || word == "undecided";
  if (!known)
    e.diagnostics.error(
        "E0238", x.word.span, fmt::format("`{}` is no word for the stability of an equilibrium", word),
        "The energy or the eigenvalues prove it stable or unstable, or the linearization does not decide.",
        "Write stable, unstable or undecided.");
  if (!known) return std::nullopt;
  if (e.fields) return equilibrium_of_fields(e, x, line);
  written::Point written_point;
  for (const written::Place& place : x.at) written_point.push_back(place.value);
  const auto point = point_of_expectation(e, written_point);
  if (!point) return std::nullopt;
  expectation::Equilibrium out;
  out.word = word;
  std::size_t next = 0;  // coordinates and velocities as written, then the velocities that rates ask for
  for (const written::Place& place : x.at) {
    const bool rate = is_rate(e, *place.value.variable);
    auto of_place = place_of_equilibrium(e, place, rate ? StartValue{0, 1, {}, {}, {}, 1} : (*point)[next++]);
    if (!of_place) return std::nullopt;
    if (!rate) out.at.push_back(std::move(*of_place));
  }
  for (; next < point->size(); ++next) out.at.push_back({(*point)[next], std::nullopt, {}});
  return out;
}

// ----------------------------------------------------------------------------------------------------------------
// others

/// Whether the model has such an event or contact, which a change is told of.
bool names_an_event(Elaboration& e, const syntax::Name& name, const syntax::Name& change) {
  const Declaration* d = e.table.find(name.text);
  const bool event = d && d->kind == Declaration::Kind::Event;
  bool known = event || (d && d->kind == Declaration::Kind::Contact);
  for (const Friction& f : e.system().frictions) known = known || f.name == name.text;
  if (known && !(event && !change.text.empty())) return true;
  if (known) {
    e.diagnostics.error("E0261", change.span, fmt::format("`{}` is an event, which is not {}", name.text, change.text),
                        "Contacts are hit, made and lost; friction sticks and slips; an event happens.",
                        fmt::format("Write `expect event {} at …`.", name.text));
    return false;
  }
  std::vector<std::string> names;
  for (const Declaration& other : e.table.declarations())
    if (other.kind == Declaration::Kind::Event || other.kind == Declaration::Kind::Contact) names.push_back(other.name);
  const std::string near = did_you_mean(name.text, names);
  e.diagnostics.error("E0261", name.span, fmt::format("the model has no event or contact `{}`", name.text),
                      "An event is named by its statement, a contact by the name at its end.",
                      near.empty() ? "Name it: contact … >= … name floor, or event hit when … = … : record."
                                   : fmt::format("Did you mean `{}`?", near));
  return false;
}

Expected meaning_of(Elaboration& e, const written::Event& x, Span) {
  const auto time = expected_number(e, x.time, e.time(), in_words(e, "the time of an event"));
  if (!names_an_event(e, x.name, x.change) || !time) return std::nullopt;
  return expectation::Event{x.name.text, x.change.text, x.occurrence, *time};
}

Expected meaning_of(Elaboration& e, const written::EventCount& x, Span) {
  const Value number = constant_of(e, *x.number, Dimension{}, "how often something happens");
  if (!names_an_event(e, x.name, x.change) || number.poisoned) return std::nullopt;
  return expectation::EventCount{x.name.text, x.change.text, number.scalar()};
}

Expected meaning_of(Elaboration&, const written::Error& x, Span) { return expectation::Error{x.code.text}; }

/// E0244 where an expectation about a motion stands in a model with integral constraints.
bool refuse_motion_of_path(Elaboration& e, const written::Kind& kind, Span line) {
  const bool about_path =
      std::holds_alternative<written::Action>(kind) || std::holds_alternative<written::ActionAlong>(kind) ||
      std::holds_alternative<written::MorseIndex>(kind) || std::holds_alternative<written::PathAt>(kind);
  if (about_path || std::holds_alternative<written::Error>(kind) || e.system().integral_constraints.empty())
    return false;
  e.diagnostics.error("E0244", line, "this expectation is about a motion, and the model holds an integral of its paths",
                      "The multiplier of an integral belongs to a whole path: without its two ends there is no motion.",
                      "Expect `action`, `index` or `path q at …` instead.");
  return true;
}

}  // namespace

void elaborate_expectation(Elaboration& e, const syntax::ExpectStatement& s, Span line) {
  if (refuse_motion_of_path(e, s.kind, line)) return;
  if (e.fields && s.with) {
    e.diagnostics.error("E0509", *s.with, "not supported yet: an expectation of fields at other values of parameters",
                        "The expectations of fields are those at the values of the model.",
                        "Leave `with` out, or give another model these values.");
    return;
  }
  if (auto kind = std::visit([&](const auto& x) { return meaning_of(e, x, line); }, s.kind))
    e.experiment().expectations.push_back({std::string(e.texts.slice(line)), s.claim, line, std::move(*kind),
                                           s.with ? std::string(e.texts.slice(*s.with)) : std::string()});
}

}  // namespace maupertuis::elaboration
