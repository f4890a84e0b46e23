#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// start, run, output, method, precision, sweep.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Kind = Declaration::Kind;

bool refuse_acceleration_of_start(Elaboration& e, const Expression& x) {
  if (x.primes <= 1) return false;
  e.diagnostics.error("E0223", x.span, fmt::format("the acceleration `{}` cannot be chosen", e.texts.slice(x.span)),
                      "The equations of motion give it from positions and velocities.", "Leave it out.");
  return true;
}

}  // namespace

std::optional<StartValue> start_variable(Elaboration& e, const Expression& x) {
  if (const std::optional<std::size_t> q = quaternion_component(e, x)) {
    if (refuse_acceleration_of_start(e, x)) return std::nullopt;
    return StartValue{*q, x.primes, {}, {}, {}, 1};
  }
  if (x.kind == Expression::Kind::Member) {
    const Declaration* base =
        x.arguments[0]->kind == Expression::Kind::Name ? e.table.find(x.arguments[0]->text) : nullptr;
    if (base && base->value.poisoned) return std::nullopt;
    if (!base && x.arguments[0]->kind == Expression::Kind::Name)
      unknown_name(e, x.arguments[0]->text, x.arguments[0]->name_span);
    else
      e.diagnostics.error("E0504", x.span, fmt::format("`{}` is nothing that can be given here", e.texts.slice(x.span)),
                          "A start gives coordinates, their velocities, angular velocities of bodies, and points by "
                          "their place and velocity; a configuration that is asked about, coordinates and rates.",
                          "Give the coordinates and velocities that belong to it.");
    return std::nullopt;
  }
  const std::string text(e.texts.slice(x.span));
  Declaration* d = x.kind == Expression::Kind::Name ? e.table.find(x.text) : nullptr;
  if (x.kind == Expression::Kind::Name && (!d || !d->statement)) {
    unknown_name(e, x.text, x.name_span);
    return std::nullopt;
  }
  if (d && d->kind == Kind::Field && d->value.poisoned) return std::nullopt;
  if (!d || d->kind != Kind::Coordinate) {
    e.diagnostics.error("E0223", x.span,
                        d ? fmt::format("`{}` is a {}, not a coordinate", d->name, word_of(d->kind))
                          : fmt::format("`{}` is no coordinate", text),
                        "A start gives the coordinates and their velocities.", "");
    return std::nullopt;
  }
  d->used = true;
  const bool higher = x.primes <= 3 && e.higher.count(d->index);  // a state is (q, q', q'', q''') then
  if (!higher && refuse_acceleration_of_start(e, x)) return std::nullopt;
  if (d->value.poisoned) return std::nullopt;
  StartValue s;
  s.order = x.primes;
  s.coordinate = d->index;
  return s;
}

namespace {

void duplicate_start(Elaboration& e, Span second, Span first) {
  e.diagnostics.error("E0208", second, fmt::format("`{}` starts twice", e.texts.slice(second)),
                      fmt::format("Its start is already given in line {}.", e.texts.locate(first).line),
                      "Keep one of them.");
}

}  // namespace

namespace {

/// What stands in a model, and there has a value; or what is expected, which may have none with other parameters.
enum class Existence { Needed, OfExpectation };

bool exists(Elaboration& e, Expr value, const Expression& x, const std::string& what, Existence existence) {
  if (existence == Existence::Needed) return is_finite(e, value, x, what);
  const std::optional<double> size = constant_value(e, value);
  if (size && !std::isfinite(*size))
    e.diagnostics.note("N0252", x.span, fmt::format("{} that is expected has no value with these parameters", what),
                       "It is a division by zero, a root of a negative number, or beyond 1e308: the expectation fails, "
                       "and nothing else depends on it.",
                       "");
  return true;
}

Value known_before_the_run(Elaboration& e, const Value& v, const Expression& x, const std::string& what,
                           Existence existence = Existence::Needed) {
  if (v.poisoned) return v;
  for (const Expr& part : v.parts) {
    if (!e.context.depends_on_time(part.id())) {
      if (refuse_without_place(e, part, x)) return Value::poison();
      if (!exists(e, part, x, what, existence)) return Value::poison();
      continue;
    }
    const Span at = culprit_of_order(e, x, 0);
    e.diagnostics.error("E0222", at.end > at.begin ? at : x.span, fmt::format("{} must be known before the run", what),
                        in_words(e, "Numbers and parameters are; coordinates and the time change during it."), "");
    return Value::poison();
  }
  return v;
}

}  // namespace

Value constant_of(Elaboration& e, const Expression& x, const Dimension& expected, const std::string& what) {
  Place place;
  place.inline_constants = true;
  return known_before_the_run(e, scalar_of(e, x, expected, what, place), x, what);
}

Value expected_constant_of(Elaboration& e, const Expression& x, const Dimension& expected, const std::string& what) {
  Place place;
  place.inline_constants = true;
  return known_before_the_run(e, scalar_of(e, x, expected, what, place), x, what, Existence::OfExpectation);
}

Value constant_vector_of(Elaboration& e, const Expression& x, const Dimension& expected, const std::string& what) {
  Place place;
  place.inline_constants = true;
  return known_before_the_run(e, vector_of(e, x, expected, what, place), x, what);
}

namespace {

/// 60 deg of `start θ = -60 deg`: what shows the start shows it in the unit of the text.
void note_written_unit(Elaboration& e, StartValue& s, const Expression& value, const Dimension& expected) {
  const Expression* x = &value;
  while (x->kind == Expression::Kind::Unary) x = x->arguments[0].get();
  if (x->kind != Expression::Kind::Quantity || !x->unit || x->unit->factors.empty() || !all_units(*x->unit)) return;
  if (has_words_of_no_unit(e, *x)) return;
  const std::optional<Unit> unit = unit_of(e, *x->unit);
  if (!unit || !unit->dimension.same_as(expected)) return;  // its words are names of the model
  s.unit = written_unit(e.texts, *x->unit);
  s.unit_factor = maupertuis::evaluate(factor_of(e.context, *unit), Bindings{});
}

}  // namespace

std::optional<StartValue> start_value(Elaboration& e, const syntax::StartStatement::Item& item) {
  std::optional<StartValue> s = start_variable(e, *item.variable);
  if (!s) {
    evaluate_formula(e, *item.value, Place{});
    return std::nullopt;
  }
  const Coordinate& c = e.system().coordinates[s->coordinate];
  const Dimension expected = c.dimension / pow(e.time(), s->order);
  const Value v = constant_of(e, *item.value, expected, fmt::format("`{}`", e.texts.slice(item.variable->span)));
  if (v.poisoned) return std::nullopt;
  warn_of_degrees(e, v, expected, *item.value);
  s->value = v.scalar();
  s->span = item.variable->span;
  note_written_unit(e, *s, *item.value, expected);
  return s;
}

namespace {

void start_of_conditions(Elaboration& e, const syntax::StartStatement::Item& item) {
  std::vector<StartCondition>& list = e.experiment().start_conditions;
  const std::vector<StartCondition> found = start_conditions(e, item);
  for (const StartCondition& condition : found)
    for (const StartCondition& first : list)
      if (first.formula == condition.formula) return duplicate_start(e, condition.span, first.span);
  list.insert(list.end(), found.begin(), found.end());
}

void start(Elaboration& e, const syntax::StartStatement& s) {
  Experiment& x = e.experiment();
  x.start_exactly = x.start_exactly || s.exactly;
  if (s.at) {
    const Value t = constant_of(e, *s.at, e.time(), in_words(e, "the start time"));
    if (!t.poisoned) x.start_time = t.scalar();
  }
  for (const auto& item : s.items) {
    if (start_of_field(e, item)) continue;
    if (is_start_condition(e, *item.variable)) {
      start_of_conditions(e, item);
      continue;
    }
    const std::optional<StartValue> value = start_value(e, item);
    if (!value) continue;
    const StartValue* first = nullptr;
    for (const StartValue& other : x.start)
      if (other.coordinate == value->coordinate && other.order == value->order) first = &other;
    if (first)
      duplicate_start(e, value->span, first->span);
    else
      x.start.push_back(*value);
  }
}

}  // namespace

bool refuse_along_motion(Elaboration& e, const Value& v, const Expression& x) {
  if (v.order > 2 && e.higher.empty() && refuse_acceleration(e, v, x, "a value along the motion")) return true;
  return std::any_of(v.parts.begin(), v.parts.end(), [&](Expr part) { return refuse_without_place(e, part, x); });
}

Expr condition(Elaboration& e, const Expression& left_side, const Expression& right_side, const char* what) {
  Place along_motion;
  along_motion.reactions = true;
  const Value left = evaluate_formula(e, left_side, along_motion);
  if (left.poisoned) return {};
  if (left.is_vector) {
    e.diagnostics.error("E0210", left_side.span, fmt::format("{} when a number reaches its value, not a vector", what),
                        "", "Take a component with .x or .y.");
    return {};
  }
  Place place;
  place.inline_constants = true;
  const Value right =
      scalar_of(e, right_side, left.dimension, fmt::format("`{}`", e.texts.slice(left_side.span)), place);
  if (!right.poisoned) warn_of_degrees(e, right, left.dimension, right_side);
  if (right.poisoned || refuse_along_motion(e, left, left_side) || refuse_along_motion(e, right, right_side)) return {};
  return left.scalar() - right.scalar();
}

namespace {

void run(Elaboration& e, const syntax::RunStatement& s) {
  Experiment& x = e.experiment();
  if (s.duration) {
    const Value v = constant_of(e, *s.duration, e.time(), "the duration of a run");
    if (!v.poisoned) x.duration = v.scalar();
    return;
  }
  constexpr int usual_limit = 60;
  const Value within =
      s.within ? constant_of(e, *s.within, e.time(), in_words(e, "the longest time of a run")) : Value::poison();
  if (!s.within) x.within = e.number(usual_limit);
  if (!within.poisoned) x.within = within.scalar();
  x.until = condition(e, *s.until_left, *s.until_right, "a run ends");
  if (x.until && !e.context.depends_on_time(x.until.id()))
    e.diagnostics.error("E0253", cover(s.until_left->span, s.until_right->span),
                        "the condition of `run until` does not depend on the motion",
                        "Both sides are equal always, or never: it marks no moment of the run.",
                        "Write for example run until x = 0 within 10 s.");
}

void output(Elaboration& e, const syntax::OutputStatement& s) {
  const Value v = constant_of(e, *s.every, e.time(), "the interval of output");
  if (v.poisoned) return;
  const std::optional<double> size = constant_value(e, v.scalar());
  if (size && !(*size > 0)) {
    e.diagnostics.error("E0222", s.every->span, "the interval of output is not positive",
                        in_words(e, "Rows of output follow each other in time."), "");
    return;
  }
  e.experiment().output_every = v.scalar();
}

/// How the runs of this model step, where the command line says nothing.
const std::pair<const char*, StepMethod> kMethods[] = {{"auto", StepMethod::Automatic},
                                                       {"taylor", StepMethod::Taylor},
                                                       {"variational", StepMethod::Variational},
                                                       {"stiff", StepMethod::Stiff}};

/// The parameter that a sweep names; null, and a message, if it is none.
const Parameter* swept_parameter(Elaboration& e, const Expression& x) {
  const std::string text(e.texts.slice(x.span));
  Declaration* d = x.kind == Expression::Kind::Name && x.primes == 0 ? e.table.find(x.text) : nullptr;
  if (x.kind == Expression::Kind::Name && (!d || !d->statement)) {
    unknown_name(e, x.text, x.name_span);
    return nullptr;
  }
  if (!d || d->kind != Kind::Parameter) {
    e.diagnostics.error("E0239", x.span, fmt::format("`{}` is no parameter", text),
                        "A sweep goes through the values of a parameter and leaves the rest of the model as it is.",
                        "Make it a `param` with a value of its own.");
    return nullptr;
  }
  d->used = true;
  for (const Parameter& p : e.system().parameters)
    if (p.name == d->name) return &p;
  return nullptr;
}

/// E0403 for the end of a sweep that takes a mass below 0.
bool is_mass_that_may_be(Elaboration& e, const Parameter& parameter, const Value& end, const Expression& x) {
  if (e.dimensionless || !(parameter.dimension == dimensions::mass())) return true;
  const std::optional<double> size = constant_value(e, end.scalar());
  if (!size || *size >= 0) return true;
  e.diagnostics.error("E0403", x.span, fmt::format("the sweep makes the mass `{}` negative", parameter.name),
                      "Masses are positive: a negative one would gain speed against every force.",
                      "Begin and end it at positive values.");
  return false;
}

void sweep(Elaboration& e, const syntax::SweepStatement& s, Span span) {
  const Parameter* parameter = swept_parameter(e, *s.variable);
  if (!parameter) return;
  const std::string what = fmt::format("`{}`", parameter->name);
  const Value from = constant_of(e, *s.from, parameter->dimension, what),
              to = constant_of(e, *s.to, parameter->dimension, what);
  constexpr double usual_count = 121;
  const Value steps =
      s.steps ? constant_of(e, *s.steps, Dimension{}, "the number of values of a sweep") : Value::poison();
  if (from.poisoned || to.poisoned || (s.steps && steps.poisoned)) return;
  if (!is_mass_that_may_be(e, *parameter, from, *s.from) || !is_mass_that_may_be(e, *parameter, to, *s.to)) return;
  const double count = s.steps ? constant_value(e, steps.scalar()).value_or(0) : usual_count;
  constexpr double most = 1e6;
  if (!(count >= 2 && count <= most && count == std::floor(count))) {
    e.diagnostics.error("E0239", s.steps->span,
                        "a sweep has a whole number of values, at least 2 and at most a million",
                        "Both ends are counted: `steps 121` from 0 to 12 is a tenth apart.", "");
    return;
  }
  e.experiment().sweep = Sweep{static_cast<std::size_t>(parameter - e.system().parameters.data()), from.scalar(),
                               to.scalar(), static_cast<std::size_t>(count), span};
}

}  // namespace

void elaborate_method(Elaboration& e, const syntax::MethodStatement& s) {
  const auto* known =
      std::find_if(std::begin(kMethods), std::end(kMethods), [&](const auto& m) { return s.word.text == m.first; });
  if (known == std::end(kMethods)) {
    e.diagnostics.error("E0251", s.word.span, fmt::format("`{}` is no method", s.word.text),
                        "A method makes the steps of a run.", "Write auto, taylor, variational or stiff.");
    return;
  }
  MethodChoice out{known->second, s.order, {}};
  const bool variational = out.method == StepMethod::Variational;
  if (s.step && !variational) {
    e.diagnostics.error("E0249", s.step->span, fmt::format("the method `{}` chooses its steps itself", s.word.text),
                        "Its steps are as long as the tolerance allows; those of the variational method are all alike.",
                        "Leave the step out, or write for example `method variational step 10 ms`.");
    return;
  }
  if (s.order && out.method != StepMethod::Taylor && !variational) {
    e.diagnostics.error("E0249", s.word.span, fmt::format("the method `{}` chooses its order itself", s.word.text),
                        "The stiff method goes through the orders 1 to 5.", "Leave the order out.");
    return;
  }
  if (s.step) {
    const Value step = constant_of(e, *s.step, e.time(), in_words(e, "the time of a step"));
    if (step.poisoned) return;
    out.step = step.scalar();
  }
  e.experiment().method = out;
}

void elaborate_precision(Elaboration& e, const syntax::PrecisionStatement& s) {
  const std::string& word = s.word.text;
  if (word == "double")
    e.experiment().precision = NumberFormat::Double;
  else if (word == "quad")
    e.experiment().precision = NumberFormat::Quad;
  else if (word == "100")
    e.experiment().precision = NumberFormat::Digits100;
  else
    e.diagnostics.error("E0251", s.word.span, fmt::format("`{}` is no precision", word),
                        "It says how many digits a run calculates with.",
                        "Write double (16 digits), quad (33 digits) or 100 (digits).");
}

namespace {

/// What was said beside the model takes the place of its own, and is not looked at there.
void override_experiment(Elaboration& e) {
  const ExperimentOverrides& o = e.overrides;
  if (o.run) run(e, *o.run);
  if (o.sweep) sweep(e, *o.sweep, o.sweep->variable->span);
  if (o.path) elaborate_path(e, *o.path, cover(o.path->from.span, o.path->to.at->span));
  if (o.section)
    e.experiment().section = condition(e, *o.section->left, *o.section->right, "a motion meets its section");
  for (const syntax::ExpressionPtr& formula : o.formulas) {
    Place along_motion;
    along_motion.reactions = true;
    if (const auto v = number_of(e, *formula, along_motion, "a formula that is asked for");
        v && !refuse_along_motion(e, *v, *formula))
      e.experiment().asked.push_back({v->scalar(), v->dimension, formula->span});
  }
  override_given_path(e);
}

}  // namespace

void elaborate_experiment(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* x = std::get_if<syntax::ReactionStatement>(&s.body)) elaborate_release(e, *x);
  override_experiment(e);
  for (const syntax::Statement& s : e.tree.statements) {
    if (const auto* x = std::get_if<syntax::StartStatement>(&s.body)) start(e, *x);
    if (const auto* x = std::get_if<syntax::RunStatement>(&s.body); x && !e.overrides.run) run(e, *x);
    if (const auto* x = std::get_if<syntax::OutputStatement>(&s.body)) output(e, *x);
    if (const auto* x = std::get_if<syntax::MethodStatement>(&s.body)) elaborate_method(e, *x);
    if (const auto* x = std::get_if<syntax::PrecisionStatement>(&s.body)) elaborate_precision(e, *x);
    if (const auto* x = std::get_if<syntax::SweepStatement>(&s.body); x && !e.overrides.sweep) sweep(e, *x, s.span);
    if (const auto* x = std::get_if<syntax::PathStatement>(&s.body); x && !e.overrides.path)
      elaborate_path(e, *x, s.span);
    if (const auto* x = std::get_if<syntax::EventStatement>(&s.body)) elaborate_event(e, *x, s.span);
    if (const auto* x = std::get_if<syntax::DrawStatement>(&s.body)) elaborate_drawing(e, *x);
    if (const auto* x = std::get_if<syntax::ExpectStatement>(&s.body)) elaborate_expectation(e, *x, s.span);
  }
}

}  // namespace maupertuis::elaboration
