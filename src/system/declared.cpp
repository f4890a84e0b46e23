#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <maupertuis/rounded_value.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Parameters, coordinates, definitions and inputs.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

/// A number or a vector of numbers, perhaps calculated, perhaps with a unit: 3 kg, -1/2, 10 pi rad/s, (1, 2) m.
bool is_quantity(const Expression& x) {
  using Form = Expression::Kind;
  if (x.kind == Form::Name) return x.text == "pi" && x.primes == 0;
  const bool calculated =
      x.kind == Form::Unary || x.kind == Form::Vector || x.kind == Form::Binary || x.kind == Form::Call;
  if (x.kind != Form::Number && x.kind != Form::Quantity && !calculated) return false;
  return std::all_of(x.arguments.begin(), x.arguments.end(), [](const auto& a) { return is_quantity(*a); });
}

struct WrittenUnit {
  std::string text;
  double factor = 1;  // in SI
};

/// Words after a number that are names and no units: 1/3 m l^2.
bool names_stand_in(Elaboration& e, const Expression& x) {
  if (x.unit && !x.unit_bracketed)
    for (const auto& word : x.unit->factors)
      if (const Declaration* d = e.table.find(word.word); d && d->statement && !find_unit(word.word)) return true;
  return std::any_of(x.arguments.begin(), x.arguments.end(), [&](const auto& a) { return names_stand_in(e, *a); });
}

void quantities_in(const Expression& x, std::vector<const Expression*>& out) {
  if (x.kind == Expression::Kind::Quantity)
    out.push_back(&x);
  else
    for (const auto& a : x.arguments) quantities_in(*a, out);
}

/// Of a quantity that was read without a mistake. Of 10 pi [rad/s] it is rad/s; of a calculation with several units
/// that of SI.
WrittenUnit unit_of_quantity(Elaboration& e, const Expression& x, const Dimension& dimension) {
  std::vector<const Expression*> quantities;
  quantities_in(x, quantities);
  if (quantities.empty()) return {};
  const bool vector = x.kind == Expression::Kind::Vector;
  if (quantities.size() > 1 && !vector) return {to_string(dimension), 1};
  const std::optional<Unit> unit = unit_of(e, *quantities.front()->unit);
  if (!unit || !unit->dimension.same_as(dimension)) return {to_string(dimension), 1};
  return {written_unit(e.texts, *quantities.front()->unit),
          maupertuis::evaluate(factor_of(e.context, *unit), Bindings{})};
}

Expr add_parameter(Elaboration& e, const Declaration& d, const std::string& name, Expr value,
                   const Dimension& dimension, const WrittenUnit& unit) {
  Parameter p;
  p.name = name;
  p.symbol = e.context.symbol(name, Role::Parameter);
  p.value = value;
  p.si_value = rounded_value(value, Bindings{});
  p.dimension = dimension;
  p.unit = unit.text;
  p.unit_factor = unit.factor;
  p.span = d.span;
  e.values[p.symbol] = p.si_value;
  e.exact_values[p.symbol] = value;
  e.system().parameters.push_back(p);
  return p.symbol;
}

/// True if the value makes sense as a physical quantity.
bool is_possible(Elaboration& e, const Declaration& d, const Value& v, const Expression& x) {
  for (const Expr& part : v.parts) {
    const double si = maupertuis::evaluate(part, Bindings{});
    if (!std::isfinite(si) || (si == 0 && !part.is_zero())) {
      e.diagnostics.error("E0218", x.span, fmt::format("the value of `{}` is beyond the range of computation", d.name),
                          "In SI base units it lies outside 1e-308 … 1e308.", "");
      return false;
    }
    if (!e.dimensionless && v.dimension == dimensions::mass() && si < 0) {
      e.diagnostics.error("E0403", x.span, fmt::format("the mass `{}` is negative", d.name),
                          "Masses are positive: a negative one would gain speed against every force.",
                          "Give it a positive value.");
      return false;
    }
  }
  return true;
}

Dimension dimension_of_kind(const std::string& kind) {
  if (kind == "angle") return dimensions::angle();
  if (kind == "length") return dimensions::length();
  if (kind == "charge") return dimensions::charge();
  return Dimension{};
}

/// A definition of parameters alone: it stays a symbol in print. Plain numbers and other names for one symbol do not.
bool stays_a_symbol(Elaboration& e, const Value& v) {
  if (v.is_vector || v.scalar().is_symbol() || e.context.depends_on_time(v.scalar().id())) return false;
  const Expr roots[] = {v.scalar()};
  const std::vector<Expr> symbols = symbols_of(roots);
  for (const Expr& s : symbols)
    if (e.values.find(s) == e.values.end()) return false;
  return !symbols.empty();
}

}  // namespace

/// 9.81 m s-2, a difference for the grammar.
static bool power_without_sign(const Expression& x) {
  using Kind = Expression::Kind;
  return x.kind == Kind::Binary && x.op == syntax::Operator::Subtract && x.arguments[1]->kind == Kind::Number &&
         x.arguments[0]->span.end + 1 == x.arguments[1]->span.begin;
}

void elaborate_parameter(Elaboration& e, Declaration& d) {
  const Expression& x = *std::get<syntax::ParamStatement>(d.statement->body).items[d.item].value;
  d.done = true;
  d.value = Value::poison();
  if (!is_quantity(x) || names_stand_in(e, x)) {
    e.diagnostics.error("E0209", x.span, "a parameter is given by a quantity, not by a formula",
                        "A parameter is a number with its unit, which a study may change; what follows from other "
                        "quantities is a definition.",
                        power_without_sign(x) ? "The power of a unit has the sign ^: m s^-2, m/s^2."
                                              : fmt::format("Write `let {} = …`.", d.name));
    return;
  }
  Place place;
  place.in_parameter = place.inline_constants = true;
  Value v = evaluate_formula(e, x, place);
  if (v.poisoned || !is_possible(e, d, v, x)) return;
  const WrittenUnit unit = unit_of_quantity(e, x, v.dimension);
  const char* axes[] = {".x", ".y", ".z"};
  for (std::size_t i = 0; i < v.parts.size(); ++i)
    v.parts[i] = add_parameter(e, d, v.is_vector ? d.name + axes[i] : d.name, v.parts[i], v.dimension, unit);
  v.is_literal = false;
  d.value = v;
}

void elaborate_coordinate(Elaboration& e, Declaration& d) {
  const auto& item = std::get<syntax::CoordStatement>(d.statement->body).items[d.item];
  d.done = true;
  Coordinate c;
  c.name = d.name;
  c.kind = item.unit ? "" : item.kind.text;
  c.q = e.context.symbol(d.name, Role::Coordinate, 0);
  c.velocity = e.context.symbol(d.name, Role::Coordinate, 1);
  c.acceleration = e.context.symbol(d.name, Role::Coordinate, 2);
  c.span = d.span;
  d.value = Value::poison();
  if (item.unit) {
    const std::optional<Unit> unit = unit_of(e, *item.unit);
    if (!unit) return;
    c.dimension = unit->dimension;
    if (c.dimension.same_as(dimensions::length()) && c.dimension.angle() == Dimension::Exponent{}) c.kind = "length";
  } else {
    c.dimension = e.dimension(dimension_of_kind(item.kind.text));
  }
  d.value = Value::of(c.q, c.dimension, 0);
  d.index = e.system().coordinates.size();
  e.system().coordinates.push_back(std::move(c));
}

void elaborate_definition(Elaboration& e, Declaration& d) {
  const Expression& x = *std::get<syntax::LetStatement>(d.statement->body).items[d.item].value;
  d.done = true;
  d.value = evaluate_formula(e, x);
  if (d.value.poisoned) return;
  d.value.is_literal = false;
  Definition definition;
  definition.name = d.name;
  definition.dimension = d.value.dimension;
  definition.is_vector = d.value.is_vector;
  definition.span = d.span;
  if (d.value.is_vector) {
    definition.components = d.value.parts;
  } else {
    definition.formula = definition.value = d.value.scalar();
    if (stays_a_symbol(e, d.value)) {
      definition.symbol = e.context.symbol(d.name, Role::Auxiliary);
      definition.value = substitute(definition.formula, e.exact_definitions);
      if (!is_finite(e, definition.formula, x, fmt::format("`{}`", d.name))) {
        d.value = Value::poison();
        return;
      }
      e.values[definition.symbol] = rounded_value(substitute(definition.formula, e.exact_values), Bindings{});
      e.exact_values[definition.symbol] = substitute(definition.formula, e.exact_values);
      e.exact_definitions[definition.symbol] = definition.value;
      d.value.parts = {definition.symbol};
    }
  }
  e.system().definitions.push_back(std::move(definition));
}

/// input M : [N m] = 5, told in the unit that stands there: a torque is no energy in J.
static bool refuse_number_without_unit(Elaboration& e, const syntax::InputStatement& s, const Unit& unit,
                                       const std::string& name) {
  const bool bare = s.value->kind == Expression::Kind::Number && s.unit && !e.dimensionless;
  if (!bare || unit.dimension.is_one() || std::strtod(s.value->text.c_str(), nullptr) == 0) return false;
  const std::string_view written = e.texts.slice(s.unit->span);
  e.diagnostics.error("E0304", s.value->span,
                      fmt::format("the input {} is in {}, this is a bare number", name, written),
                      "Both sides of an equation have one dimension.",
                      fmt::format("A number has a unit here, such as {} {}.", s.value->text, written));
  return true;
}

void elaborate_input(Elaboration& e, Declaration& d) {
  const auto& s = std::get<syntax::InputStatement>(d.statement->body);
  if (!s.variables.empty()) return;  // a given field
  d.done = true;
  d.value = Value::poison();
  const std::optional<Unit> unit = s.unit ? unit_of(e, *s.unit) : std::optional<Unit>(Unit{});
  if (!unit) return;
  if (refuse_number_without_unit(e, s, *unit, d.name)) return;
  const Value v = scalar_of(e, *s.value, unit->dimension, fmt::format("the input {}", d.name));
  if (v.poisoned) return;
  if (v.order >= 0) {
    Span at = culprit_of_order(e, *s.value, 0);
    e.diagnostics.error("E0222", at, fmt::format("the input `{}` depends on the motion", d.name),
                        "An input is a drive from outside: a formula of t and parameters.",
                        "Write what depends on coordinates as a force or a `let`.");
    return;
  }
  Input input;
  input.name = d.name;
  input.symbol = e.context.symbol(d.name, Role::Input);
  input.formula = v.scalar();
  input.dimension = unit->dimension;
  input.span = d.span;
  d.value = Value::of(input.symbol, input.dimension);
  e.system().inputs.push_back(std::move(input));
}

}  // namespace maupertuis::elaboration
