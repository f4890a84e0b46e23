#include "system/field_elaboration.hpp"
#include "system/field_places.hpp"

#include <fmt/format.h>

#include <algorithm>

/// Values of fields and of their derivatives: everywhere, at the start, and at places.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

bool is_outside(Elaboration& e, const SpaceVariable& along, double at) {
  return along.from && (at < *constant_value(e, along.from) || at > *constant_value(e, along.to));
}

bool holds_field_values(Elaboration& e, Expr place) {
  const std::vector<Expr> symbols = symbols_of({&place, 1});
  return std::any_of(symbols.begin(), symbols.end(), [&](const Expr& symbol) {
    return system_of(e).jet_of(symbol) ||
           std::any_of(e.fields->attached.begin(), e.fields->attached.end(), [&](const PlaceCoordinate& p) {
             const Coordinate& c = e.system().coordinates[p.coordinate];
             return symbol == c.q;
           });
  });
}

/// E0289 where a place that holds t or coordinates is none that can be followed.
bool refuse_moving_place(Elaboration& e, const Expression& x, const FieldJet& jet, const Value& read, Span place) {
  const FieldSystem& system = system_of(e);
  if (!e.fields->coupled || system.space.size() > 1 || read.is_vector) {
    e.diagnostics.error("E0289", place, "this place is not known before the run",
                        fmt::format("`{}(…)` is the value of the field at a place, never a product.", x.text),
                        fmt::format("Write the other factor first, or `{} * (…)`.", x.text));
    return true;
  }
  if (read.order > 0 || holds_field_values(e, read.scalar())) {
    e.diagnostics.error("E0289", place, "this place moves with a velocity, or with the field",
                        "What takes hold of a field does so at a constant place, or at one that coordinates and the "
                        "time tell.",
                        "Write a formula of coordinates, t and parameters.");
    return true;
  }
  if (jet.time <= x.primes) return false;
  const std::string value = fmt::format("{}({})", system.jet_name({jet.field, jet.space, 0}), e.texts.slice(place));
  e.diagnostics.error(
      "E0289", x.span, fmt::format("the velocity `{}` at a place that moves", x.text),
      fmt::format("What rides on the field has the velocity d/dt {}, the field's own and that along its slope.", value),
      fmt::format("Write {}'.", value));
  return true;
}

/// u_x(l - 0), u_x(l + 0): from which side; 0: from both.
int side_of(const Expression& place) {
  if (place.kind != Expression::Kind::Binary) return 0;
  const Expression& last = *place.arguments[1];
  const bool nothing = last.kind == Expression::Kind::Number && last.text == "0";
  return !nothing ? 0 : place.op == syntax::Operator::Subtract ? -1 : place.op == syntax::Operator::Add ? 1 : 0;
}

/// E0289 where a limit from one side stands elsewhere than in an equation that is expected.
bool refuse_side(Elaboration& e, const Expression& x) {
  if (system_of(e).space.size() == 1 && (e.fields->complete || !e.fields->coupled)) return false;
  e.diagnostics.error("E0289", x.span, fmt::format("`{}` is a limit from one side", e.texts.slice(x.span)),
                      "Bodies and forces act on a field at a place, with what it has on both sides of it.",
                      "Leave the `+ 0` or `- 0` out; `expect equation` may ask for such limits along a line.");
  return true;
}

/// The place along one space variable: a constant, or a function of coordinates and t; nothing, and told, where it is
/// neither.
std::optional<Expr> place_along(Elaboration& e, const Expression& x, const FieldJet& jet, std::size_t i) {
  const SpaceVariable& along = system_of(e).space[i];
  const Expression& written = side_of(*x.arguments[i]) != 0 ? *x.arguments[i]->arguments[0] : *x.arguments[i];
  Place quiet;
  quiet.inline_constants = true;
  const Value read = evaluate_formula(e, written, quiet);
  if (!read.poisoned && (read.is_vector || !constant_value(e, read.scalar()))) {
    if (refuse_moving_place(e, x, jet, read, written.span)) return std::nullopt;
    const Value v = scalar_of(e, written, along.dimension, "a place");
    if (v.poisoned) return std::nullopt;
    return drives_as_formulas(e, v.scalar());
  }
  const Value v = read.poisoned ? read : constant_of(e, written, along.dimension, "a place");
  if (v.poisoned) return std::nullopt;
  if (!is_outside(e, along, constant_value(e, v.scalar()).value_or(0))) return v.scalar();
  e.diagnostics.error("E0289", written.span, "this place lies outside of the domain", "The field has no value there.",
                      fmt::format("Choose a place between the ends of {}.", along.name));
  return std::nullopt;
}

}  // namespace

std::optional<FieldJet> jet_named(Elaboration& e, const Expression& x) {
  if (x.kind != Expression::Kind::Name && x.kind != Expression::Kind::Call) return std::nullopt;
  std::optional<FieldJet> jet = system_of(e).jet_of_name(x.text);
  if (jet) jet->time += x.primes;
  if (jet && system_of(e).fields[jet->field].given) return std::nullopt;
  return jet;
}

bool start_of_field(Elaboration& e, const syntax::StartStatement::Item& item) {
  if (!e.fields) return false;
  const auto jet = jet_named(e, *item.variable);
  if (!jet) return false;
  if (item.variable->kind == Expression::Kind::Call) {
    e.diagnostics.error("E0223", item.variable->span,
                        fmt::format("`{}` cannot be chosen", e.texts.slice(item.variable->span)),
                        "A start gives the field and its velocity everywhere, and so at each place.",
                        fmt::format("Write `start {} = …` as a formula of space.", item.variable->text));
    return true;
  }
  const Dimension dimension = system_of(e).dimension_of(*jet);
  Place place;
  place.inline_constants = true;
  const Value v = scalar_of(e, *item.value, dimension, fmt::format("`{}`", e.texts.slice(item.variable->span)), place);
  const std::string text(e.texts.slice(item.variable->span));
  if (jet->time > 1 || jet->order() > jet->time) {
    e.diagnostics.error("E0223", item.variable->span, fmt::format("`{}` cannot be chosen", text),
                        "A start gives the field and its velocity everywhere; their derivatives follow.",
                        "Leave it out.");
    return true;
  }
  if (v.poisoned) return true;
  if (e.context.depends_on_time(v.scalar().id())) {
    e.diagnostics.error("E0222", item.value->span, fmt::format("`{}` must be known before the run", text),
                        "It is a formula of the space variables and parameters.", "");
    return true;
  }
  for (const FieldStart& other : e.fields->start)
    if (other.field == jet->field && other.order == jet->time) {
      e.diagnostics.error("E0208", item.variable->span, fmt::format("`{}` starts twice", text),
                          fmt::format("Its start is already given in line {}.", e.texts.locate(other.span).line),
                          "Keep one of them.");
      return true;
    }
  e.fields->start.push_back({jet->field, jet->time, v.scalar(), item.variable->span});
  return true;
}

std::optional<Value> value_of_jet(Elaboration& e, const syntax::Expression& x) {
  if (!e.fields) return std::nullopt;
  std::optional<FieldJet> jet = system_of(e).jet_of_name(x.text);
  if (!jet) return std::nullopt;
  jet->time += x.primes;
  const bool given = system_of(e).fields[jet->field].given;
  return Value::of(system_of(e).jet_symbol(*jet), system_of(e).dimension_of(*jet), given ? -1 : jet->time);
}

bool refuse_without_place(Elaboration& e, Expr value, const syntax::Expression& x) {
  if (!e.fields) return false;
  const FieldSystem& system = system_of(e);
  std::string name;
  for (const Expr& symbol : symbols_of({&value, 1})) {
    if (const auto jet = system.jet_of(symbol)) name = system.jet_name(*jet);
    for (const SpaceVariable& v : system.space)
      if (v.symbol == symbol) name = v.name;
  }
  if (name.empty()) return false;
  e.diagnostics.error("E0289", x.span, fmt::format("`{}` stands without a place", name),
                      "A field has a value at each place; a value that is asked for needs one.",
                      "Write u(3 m), u_x(3 m), or for the velocity u_t(3 m); or `total` for the integral.");
  return true;
}

Value value_at_place(Elaboration& e, const syntax::Expression& x) {
  FieldSystem& system = system_of(e);
  std::optional<FieldJet> jet = system.jet_of_name(x.text);
  jet->time += x.primes;
  if (x.arguments.size() != system.space.size()) {
    e.diagnostics.error(
        "E0289", x.span,
        fmt::format("a place has {} coordinate{}", system.space.size(), system.space.size() == 1 ? "" : "s"),
        "It gives each space variable of the field its value.",
        system.space.size() == 1 ? "Write u(3 m)." : "Write them one after the other, u(3 m, 1 m).");
    return Value::poison();
  }
  PlaceValue out{{}, system.jet_symbol(*jet), {}, x.span};
  for (std::size_t i = 0; i < x.arguments.size(); ++i) {
    const std::optional<Expr> place = place_along(e, x, *jet, i);
    if (!place) return Value::poison();
    out.side = side_of(*x.arguments[i]);
    if (out.side != 0 && refuse_side(e, x)) return Value::poison();
    out.place.push_back(*place);
  }
  if (e.fields->coupled && !e.fields->complete) return coordinate_at_place(e, x, *jet, out.place.front());
  if (e.fields->coupled)
    if (const auto q = attached_symbol(e, *jet, out.place.front()))
      return Value::of(*q, system.dimension_of(*jet), jet->time);
  if (out.side == 0 &&
      !std::all_of(out.place.begin(), out.place.end(), [&](Expr at) { return constant_value(e, at).has_value(); })) {
    e.diagnostics.error("E0289", x.span, "not supported yet: a place that moves where nothing takes hold of the field",
                        "Runs follow the places of masses and forces; other values are asked for at fixed places.",
                        "Ask at the place where the load is at that time.");
    return Value::poison();
  }
  out.symbol = e.context.symbol(name_of_place_value(e, x, *jet), Role::Coordinate, jet->time);
  const Expr symbol = out.symbol;
  const bool known = std::any_of(e.fields->places.begin(), e.fields->places.end(),
                                 [&](const PlaceValue& p) { return p.symbol == symbol; });
  if (!known) e.fields->places.push_back(std::move(out));
  return Value::of(symbol, system.dimension_of(*jet), jet->time);
}

}  // namespace maupertuis::elaboration
