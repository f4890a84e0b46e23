#include <maupertuis/field_statements.hpp>
#include <maupertuis/field_system.hpp>

#include "system/elaboration.hpp"

#include <fmt/format.h>

/// What is expected of fields: that both sides can be equal at all.
namespace maupertuis::elaboration {
namespace {

using written_field = syntax::FieldExpectation;
using FieldMeaning = std::optional<field_expectation::Kind>;

/// left − right of one dimension; an empty handle after a mistake.
Expr difference_of(Elaboration& e, const syntax::Equation& x) {
  Place place;
  const Value left = evaluate_formula(e, *x.left, place);
  if (left.poisoned) return {};
  const Value right = scalar_of(e, *x.right, left.fits_any ? Dimension{} : left.dimension, "the right side", place);
  if (right.poisoned || left.is_vector) return {};
  return left.scalar() - right.scalar();
}

FieldMeaning field_meaning(Elaboration& e, const written_field::Natural& x) {
  field_expectation::Natural out;
  for (const syntax::Equation& one : x.conditions) out.conditions.push_back(difference_of(e, one));
  for (const Expr& c : out.conditions)
    if (!c) return std::nullopt;
  return out;
}

FieldMeaning field_meaning(Elaboration& e, const written_field::Solution& x) {
  field_expectation::Solution out;
  const FieldSystem& system = e.fields->system;
  for (const syntax::Equation& one : x.fields) {
    const auto jet = one.left->kind == syntax::Expression::Kind::Name && one.left->primes == 0
                         ? system.jet_of_name(one.left->text)
                         : std::nullopt;
    if (!jet || jet->order() != 0) {
      e.diagnostics.error("E0291", one.left->span, fmt::format("`{}` is no field", e.texts.slice(one.left->span)),
                          "A solution gives every field as a formula of space and time.",
                          "Write for example u = sin(k x) cos(ω t).");
      return std::nullopt;
    }
    const Value v = scalar_of(e, *one.right, system.dimension_of(*jet), fmt::format("`{}`", one.left->text));
    if (v.poisoned) return std::nullopt;
    out.fields.push_back(jet->field);
    out.values.push_back(expand_time_derivatives(v.scalar()));
  }
  std::size_t varied = 0;
  for (const Field& f : system.fields) varied += !f.given;
  if (out.fields.size() == varied) return out;
  e.diagnostics.error("E0291", cover(x.fields.front().left->span, x.fields.back().right->span),
                      "a solution gives every field of the model", "The equations of one field hold the others.",
                      "Separate them by commas: a = …, b = ….");
  return std::nullopt;
}

FieldMeaning field_meaning(Elaboration& e, const written_field::Total& x) {
  field_expectation::Total out;
  const Value density = evaluate_formula(e, *x.density, Place{});
  if (density.poisoned || density.is_vector) return std::nullopt;
  Dimension dimension = density.dimension;
  for (const SpaceVariable& v : e.fields->system.space) dimension = dimension * v.dimension;
  const auto expected = expected_number(e, x.expected, dimension, "the integral over space");
  if (x.time) {
    const Value time = constant_of(e, *x.time, e.time(), "the time of an expectation");
    if (time.poisoned) return std::nullopt;
    out.time = time.scalar();
  }
  if (!expected) return std::nullopt;
  out.density = density.scalar();
  out.expected = *expected;
  out.at_equilibrium = x.at_equilibrium;
  return out;
}

/// j^x of a current has the dimension of its density times a velocity.
FieldMeaning field_meaning(Elaboration& e, const written_field::Current& x) {
  const FieldSystem& system = e.fields->system;
  if (x.fluxes.size() != system.space.size()) {
    e.diagnostics.error(
        "E0291", x.density->span,
        fmt::format("a current has {} flux{} here", system.space.size(), system.space.size() == 1 ? "" : "es"),
        "What is conserved flows along each space variable.", "Write one flux a space variable, separated by commas.");
    return std::nullopt;
  }
  const Value density = evaluate_formula(e, *x.density, Place{});
  if (density.poisoned || density.is_vector) return std::nullopt;
  field_expectation::Current out{expand_time_derivatives(density.scalar()), {}};
  for (std::size_t i = 0; i < x.fluxes.size(); ++i) {
    const Dimension flux = density.dimension * system.space[i].dimension / system.time_dimension;
    const Value v =
        density.fits_any ? evaluate_formula(e, *x.fluxes[i], Place{}) : scalar_of(e, *x.fluxes[i], flux, "a flux");
    if (v.poisoned || v.is_vector) return std::nullopt;
    out.fluxes.push_back(expand_time_derivatives(v.scalar()));
  }
  return out;
}

/// ω and k stand for the frequency and the wave numbers there, unless the model declares such names.
class WaveNames {
 public:
  explicit WaveNames(Elaboration& e) : e_(e) {}
  Value value(const syntax::Expression& x) {
    if (x.kind == syntax::Expression::Kind::Name && x.primes == 0 && !e_.table.find(x.text))
      if (const auto v = wave(x.text)) return *v;
    if (x.kind != syntax::Expression::Kind::Binary && x.kind != syntax::Expression::Kind::Unary &&
        x.kind != syntax::Expression::Kind::Call)
      return evaluate_formula(e_, x, Place{});
    return combined(x);
  }

 private:
  std::optional<Value> wave(const std::string& name) const {
    const FieldSystem& s = e_.fields->system;
    // A mistake in the fields, which is told, leaves them without waves.
    if (!e_.fields->omega) return std::nullopt;
    if (name == "ω") return Value::of(e_.fields->omega, Dimension{} / s.time_dimension);
    for (std::size_t i = 0; i < s.space.size(); ++i)
      if (name == "k_" + s.space[i].name || (s.space.size() == 1 && name == "k"))
        return Value::of(e_.fields->wave_numbers[i], Dimension{} / s.space[i].dimension);
    return std::nullopt;
  }
  Value combined(const syntax::Expression& x);
  Elaboration& e_;
};

Value WaveNames::combined(const syntax::Expression& x) {
  using syntax::Operator;
  std::vector<Value> parts;
  for (const auto& a : x.arguments) parts.push_back(value(*a));
  for (const Value& v : parts)
    if (v.poisoned || v.is_vector) return Value::poison();
  if (x.kind == syntax::Expression::Kind::Unary) return negative(parts[0]);
  if (x.kind == syntax::Expression::Kind::Call) {
    if (x.text == "sqrt" && parts.size() == 1) {
      Value half = Value::of(e_.number(Rational(1, 2)), Dimension{});
      return power(e_, parts[0], half, x);
    }
    return evaluate_formula(e_, x, Place{});
  }
  if (x.op == Operator::Add || x.op == Operator::Subtract) {
    Value sum = add(e_, parts[0], parts[1], x.op == Operator::Subtract, x, Place{});
    if (!sum.poisoned)
      sum.parts = {x.op == Operator::Add ? parts[0].scalar() + parts[1].scalar()
                                         : parts[0].scalar() - parts[1].scalar()};
    return sum;
  }
  if (x.op == Operator::Divide) return divide(e_, parts[0], parts[1], x);
  if (x.op == Operator::Power) return power(e_, parts[0], parts[1], x);
  return multiply(e_, parts[0], parts[1], x);
}

FieldMeaning field_meaning(Elaboration& e, const written_field::Dispersion& x) {
  WaveNames names(e);
  const Value left = names.value(*x.left), right = names.value(*x.right);
  if (left.poisoned || right.poisoned) return std::nullopt;
  if (!e.dimensionless && !left.fits_any && !right.fits_any && !left.dimension.same_as(right.dimension)) {
    e.diagnostics.error(
        "E0304", x.right->span,
        fmt::format("the left side is {}, this is {}", describe(left.dimension), describe(right.dimension)),
        "Both sides of an equation have one dimension.", "");
    return std::nullopt;
  }
  return field_expectation::Dispersion{left.scalar(), right.scalar()};
}

FieldMeaning field_meaning(Elaboration& e, const written_field::Frequencies& x) {
  field_expectation::Frequencies out;
  const auto jet = e.fields->system.jet_of_name(x.field.text);
  if (!jet || jet->order() != 0) {
    e.diagnostics.error("E0291", x.field.span, fmt::format("`{}` is no field", x.field.text), "", "");
    return std::nullopt;
  }
  out.field = jet->field;
  const Dimension rate = Dimension{} / e.time();
  const Expr full_turn = e.number(2) * e.context.pi();
  bool turns = false;
  for (const auto& value : x.values) {
    const Value v = constant_of(e, *value, rate, "a frequency");
    if (v.poisoned) return std::nullopt;
    if (const auto unit = display_unit(e, *value, rate)) out.unit = *unit;
    out.values.push_back(v.hertz ? v.scalar() * full_turn : v.scalar());
    if (v.hertz) out.unit.factor *= maupertuis::evaluate(full_turn, Bindings{});
  }
  const auto tolerance = tolerance_of(e, x.tolerance, rate, out.unit, &turns);
  if (!tolerance) return std::nullopt;
  out.tolerance = *tolerance;
  return out;
}

/// E0291 where a velocity is asked for.
bool refuse_velocity(Elaboration& e, const Value& value, const syntax::Expression& x) {
  if (value.order == 0) return false;
  e.diagnostics.error(
      "E0291", x.span, fmt::format("`{}` is a velocity, and an equilibrium rests", e.texts.slice(x.span)),
      "Fields that stay what they are have no velocity anywhere.", "Ask for the field, a slope or a coordinate.");
  return true;
}

}  // namespace

Expected equilibrium_of_fields(Elaboration& e, const written::Equilibrium& x, Span line) {
  field_expectation::Equilibrium out;
  out.word = x.word.text;
  for (const written::Place& place : x.at) {
    const syntax::Expression& subject = *place.value.variable;
    const Value v = evaluate_formula(e, subject, Place{});
    if (v.poisoned || v.is_vector || refuse_without_place(e, v.scalar(), subject) || refuse_velocity(e, v, subject))
      return std::nullopt;
    const std::string name(e.texts.slice(subject.span));
    const auto expected = expected_number(e, {place.value.value, place.tolerance}, v.dimension, "`" + name + "`");
    if (!expected) return std::nullopt;
    out.places.push_back({v.scalar(), name, *expected});
  }
  e.fields->expectations.push_back({std::string(e.texts.slice(line)), line, std::move(out)});
  return std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::OfField& x, Span line) {
  if (!e.fields) {
    e.diagnostics.error("E0281", line, "this expectation is about a field, and the model has none",
                        "It speaks of densities, boundaries or waves.", "Declare a field, or expect something else.");
    return std::nullopt;
  }
  if (auto kind = std::visit([&](const auto& said) { return field_meaning(e, said); }, x.said->body))
    e.fields->expectations.push_back({std::string(e.texts.slice(line)), line, std::move(*kind)});
  return std::nullopt;
}

}  // namespace maupertuis::elaboration
