#include "system/elaboration.hpp"

#include <maupertuis/language_words.hpp>
#include <maupertuis/look_alikes.hpp>
#include <maupertuis/momentum.hpp>
#include <maupertuis/spelling.hpp>

#include <fmt/format.h>

#include <algorithm>

/// Names in formulas.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Kind = Declaration::Kind;

/// A coordinate, a definition, a point, … as it is, without primes. A point is the vector from the frame's origin.
Value meaning(Declaration& d, const Place& place) {
  d.used = true;
  if (!d.done) return Value::poison();  // a member of a cycle, or lost to an error: told there
  Value v = d.value;
  if (v.poisoned || !place.frame || !v.is_vector) return v;
  if (!v.anchored) {
    v.parts = rotate(place.frame->rotation, v.parts);
    v.anchored = true;
  } else if (v.weight) {
    v.parts = vector_sum(v.parts, scaled(-v.weight, place.frame->origin));
  }
  return v;
}

Value origin(Elaboration& e, const Place& place) {
  Value v;
  v.is_vector = v.anchored = true;
  v.dimension = e.dimension(dimensions::length());
  v.weight = e.number(1);
  v.parts.assign(static_cast<std::size_t>(e.system().space_dimension), e.number(0));
  if (place.frame) v.parts = scaled(e.number(-1), place.frame->origin);
  return v;
}

Value derivative_of_coordinate(Elaboration& e, Value v, int primes) {
  for (int i = 0; i < primes; ++i) {
    v.parts = {e.context.time_derivative(v.scalar())};
    v.dimension = v.dimension / e.time();
  }
  v.order = primes;
  return v;
}

Value refuse_as_quantity(Elaboration& e, Declaration& d, const Expression& x) {
  e.diagnostics.error(
      "E0212", x.name_span, fmt::format("`{}` is a {}, not a quantity", d.name, word_of(d.kind)),
      "The name of a constraint stands for the whole relation.",
      fmt::format("Its force is reaction({0}){1}.", d.name,
                  d.kind == Kind::Constraint ? fmt::format(", its multiplier multiplier({})", d.name) : ""));
  return Value::poison();
}

/// Third and fourth derivatives have a meaning where the second stands in L.
bool refuse_high_order(Elaboration& e, const Expression& x) {
  if (x.primes <= 2) return false;
  const Declaration* d = x.kind == Expression::Kind::Name ? e.table.find(x.text) : nullptr;
  const bool higher = d && d->kind == Kind::Coordinate && d->done && e.higher.count(d->index);
  if (higher && x.primes <= 4) return false;
  constexpr int shown = 8;  // a thousand primes are not read, they are counted
  const std::string written = x.primes <= shown ? std::string(e.texts.slice(x.span)) : x.text + "''…";
  e.diagnostics.error("E0401", x.span, fmt::format("`{}` is a derivative of order {}", written, x.primes),
                      higher ? "Its equation of motion is of the fourth order."
                             : "Mechanics knows positions, velocities and accelerations.",
                      "");
  return true;
}

Value component(Elaboration& e, const Value& base, const Expression& x) {
  const std::size_t index = x.text == "x" ? 0 : x.text == "y" ? 1 : x.text == "z" ? 2 : 3;
  if (!base.is_vector || index == 3) {
    const std::string text(e.texts.slice(x.arguments[0]->span));
    e.diagnostics.error(
        "E0216", x.name_span, fmt::format("`{}` has no `.{}`", text, x.text),
        base.is_vector ? "A vector has the components .x, .y and .z."
                       : "Only points, bodies and vectors have components.",
        x.text == "w" && base.is_vector       ? "The angular velocity of a body is .ω."
        : !base.is_vector && x.text == "diff" ? fmt::format("A derivative by the time is written {}'.", text)
        : x.text.size() == 2 && x.text[0] == 'q'
            ? "A body or frame has .qw, .qx, .qy and .qz where it is declared with `rotation quaternion`."
            : "");
    return Value::poison();
  }
  if (index >= base.parts.size()) {
    e.diagnostics.error("E0216", x.name_span, fmt::format("there is no .{} in a two-dimensional model", x.text),
                        "Its vectors have the components .x and .y.", "");
    return Value::poison();
  }
  Value v = base;
  v.is_vector = v.anchored = false;
  v.weight = Expr();
  v.parts = {base.parts[index]};
  return v;
}

std::optional<Value> angular_velocity(Elaboration& e, const Expression& x) {
  const bool world = x.text == "ω_world";
  if (!world && x.text != "ω") return std::nullopt;
  if (x.arguments[0]->kind != Expression::Kind::Name) return std::nullopt;
  Declaration* d = e.table.find(x.arguments[0]->text);
  if (!d || (d->kind != Kind::Body && d->kind != Kind::Frame)) return std::nullopt;
  d->used = true;
  if (!d->done || d->value.poisoned) return Value::poison();
  const Pose& pose = e.poses.at(e.table.id(*d));
  Value v;
  v.parts = world ? pose.omega_world : pose.omega;
  v.is_vector = v.parts.size() > 1;
  v.anchored = v.is_vector;
  v.dimension = e.dimension(dimensions::angle()) / e.time();
  v.order = pose.order >= 0 ? 1 : -1;
  return v;
}

/// p_θ, p_ball.qw where momenta may stand; nothing where it names none.
std::optional<Value> momentum(Elaboration& e, const std::string& name) {
  const MechanicalSystem& system = e.system();
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    if (name != momentum_name(system, i)) continue;
    const Dimension action = system.lagrangian_dimension * e.time();
    return Value::of(momentum_symbol(system, i), action / system.coordinates[i].dimension, 1);
  }
  return std::nullopt;
}

/// λ_rod as derivations print it, where multiplier(rod) may stand. A multiplier never has the name of something
/// declared.
std::optional<Value> multiplier(Elaboration& e, const std::string& name) {
  for (const Constraint& c : e.system().constraints)
    if (c.multiplier && c.multiplier.name() == name) return value_of_multiplier(e, c);
  return std::nullopt;
}

/// A poisoned or lost name is no second mistake.
bool is_silent(Elaboration& e, const std::string& text) { return e.table.is_lost(text); }

/// Where another variable stands in its place, t is a name like any other.
void unknown_time(Elaboration& e, Span span) {
  const std::string& x = e.system().independent;
  if (x == "t") {
    e.diagnostics.error("E0201", span, "`t` is no name that the model declares", "It is the time, in every model.",
                        "The time of the start is 0, or written: start at 5 s.");
    return;
  }
  e.diagnostics.error(
      "E0201", span, "`t` is not declared",
      fmt::format("The independent variable of this model is {}: it stands in the place of the time.", x),
      fmt::format("Write {}, or declare t.", x));
}

/// Runs print it and write it as a column.
void unknown_energy(Elaboration& e, Span span) {
  e.diagnostics.error("E0201", span, "`energy` is not declared",
                      "It is a column of runs; a formula names what the energy is made of.",
                      "Write T + V, or T or V alone.");
}

/// A declared name that looks as this one does, in letters of another alphabet; empty if there is none.
std::string twin_of(const std::string& text, const std::vector<std::string>& names) {
  const std::string look = latin_look(text);
  const auto twin =
      std::find_if(names.begin(), names.end(), [&](const std::string& name) { return latin_look(name) == look; });
  return twin == names.end() ? std::string() : *twin;
}

/// A declared name that differs in capital letters alone; empty if there is none.
std::string other_case_of(const std::string& text, const std::vector<std::string>& names) {
  const auto small = [](std::string name) {
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return name;
  };
  const auto other =
      std::find_if(names.begin(), names.end(), [&](const std::string& name) { return small(name) == small(text); });
  return other == names.end() ? std::string() : *other;
}

bool differ_in_number_alone(const std::string& x, const std::string& y) {
  const auto stem = [](const std::string& name) { return name.substr(0, name.find_last_not_of("0123456789") + 1); };
  return stem(x) == stem(y) && stem(x) != x && stem(y) != y;
}

/// What to do about a name that is not declared, of which `near` is a neighbour. `in_model`: not in an option.
std::string advice_on_name(Elaboration& e, const std::string& text, const std::string& near, bool in_model) {
  const std::vector<Coordinate>& coordinates = e.system().coordinates;
  const std::string declare = fmt::format("`param {0} = …`, `coord {0} : …` or `let {0} = …`", text);
  if (text == "v" && near.empty() && coordinates.size() == 1)
    return fmt::format("The velocity of {0} is written {0}'; another quantity is declared, {1}.",
                       coordinates.front().name, declare);
  if (near.empty()) return fmt::format("Declare it: {}.", declare);
  // In a model one of a row that was forgotten, sooner than a slip of the finger: θ2 beside θ1.
  if (in_model && differ_in_number_alone(text, near))
    return fmt::format("Declare it: {}. Did you mean `{}`?", declare, near);
  return fmt::format("Did you mean `{}`?", near);
}

/// `sim θ` is a product of two names for the grammar: where no declared name is near, a function may be.
std::string near_function(const std::string& text) {
  std::vector<std::string> functions;
  for (const syntax::Function& f : syntax::functions()) functions.emplace_back(f.name);
  return did_you_mean(text, functions);
}

/// What stands before a function in other languages: np.sin.
bool is_library(const std::string& text) {
  static constexpr std::string_view names[] = {"np", "numpy", "math", "Math", "sp", "sympy", "mpmath", "std", "cmath"};
  return std::find(std::begin(names), std::end(names), text) != std::end(names);
}

/// `… 3 m` where the unit was meant, and a name is near: m1.
std::string or_a_unit(const Elaboration& e, const std::string& text) {
  return !e.dimensionless && find_unit(text)
             ? fmt::format(" A unit stands in square brackets directly after a number: 3 [{}].", text)
             : "";
}

void unknown_name_of(Elaboration& e, const std::string& text, Span span, bool in_formula) {
  if (is_silent(e, text)) return;
  if (!e.unknown_names.insert(text).second) return;  // told at its first use
  if (text == "t") return unknown_time(e, span);
  if (text == "energy") return unknown_energy(e, span);
  // Who has more of them reads no proposals for each, and every proposal looks at all names.
  constexpr std::size_t most_proposals = 200, most_names = 2000;
  std::vector<std::string> names;
  if (e.unknown_names.size() <= most_proposals) names = e.table.names();
  if (names.size() > most_names) names.resize(most_names);
  if (const std::string twin = twin_of(text, names); !twin.empty()) {
    const std::string foreign = foreign_letter(twin).empty() ? foreign_letter(text) : foreign_letter(twin);
    e.diagnostics.error(
        "E0201", span, fmt::format("`{}` is not declared; a name that looks the same is", text),
        foreign.empty() ? "Its letters are of another alphabet." : fmt::format("In one of the two {}.", foreign),
        "Type both with the same letters.");
    return;
  }
  if (const std::string other = other_case_of(text, names); !other.empty()) {
    e.diagnostics.error("E0201", span, fmt::format("`{}` is not declared", text),
                        "Capital and small letters are different names.", fmt::format("Did you mean `{}`?", other));
    return;
  }
  if (is_library(text)) {
    e.diagnostics.error("E0201", span, fmt::format("`{}` is not declared", text),
                        "Functions of the language stand by themselves.",
                        fmt::format("Leave out `{}.`: sin(x), not {}.sin(x).", text, text));
    return;
  }
  if (const syntax::Spelling right = syntax::right_spelling(text, names); !right.text.empty()) {
    e.diagnostics.error("E0201", span, fmt::format("`{}` is not declared", text), right.reason,
                        fmt::format("Write {}.", right.text));
    return;
  }
  const std::string near = did_you_mean(text, names);
  if (near.empty() && find_unit(text) && !e.dimensionless) {
    e.diagnostics.error(
        "E0312", span, fmt::format("`{}` is no name of this model", text),
        "In a formula a unit stands in square brackets, so that it cannot be taken for a name.",
        fmt::format("Write 3 [{0}] for a number with the unit {0}, or declare {0} with `param`.", text));
    return;
  }
  const std::string function = in_formula && near.empty() ? near_function(text) : "";
  e.diagnostics.error("E0201", span, fmt::format("`{}` is not declared", text),
                      "Every name of a formula is declared somewhere in the model.",
                      advice_on_name(e, text, near, span.source == 0) + or_a_unit(e, text) +
                          (function.empty() ? "" : fmt::format(" Did you mean `{}`?", function)));
}

}  // namespace

void unknown_name(Elaboration& e, const std::string& text, Span span) { unknown_name_of(e, text, span, false); }

Declaration* find_declared(Elaboration& e, const syntax::Name& name) {
  Declaration* d = e.table.find(name.text);
  if (d && d->statement) {
    d->used = true;
    return d;
  }
  unknown_name(e, name.text, name.span);
  return nullptr;
}

Value value_of_name(Elaboration& e, const Expression& x, const Place& place) {
  Declaration* d = e.table.find(x.text);
  if (d) {
    if (refuse_high_order(e, x)) return Value::poison();
    if ((d->kind == Kind::Coordinate || d->kind == Kind::Field) && d->done && !d->value.poisoned) {
      d->used = true;
      return derivative_of_coordinate(e, d->value, x.primes);
    }
    if (d->kind == Kind::Constraint || d->kind == Kind::Reaction || d->kind == Kind::Contact || d->kind == Kind::Event)
      return refuse_as_quantity(e, *d, x);
    return time_derivative(e, meaning(*d, place), x.primes, x);
  }
  if (e.table.is_lost(x.text)) return Value::poison();
  if (const std::optional<Value> jet = value_of_jet(e, x)) return *jet;
  if (x.text == "t" && e.system().independent == "t")
    return time_derivative(e, Value::of(e.context.time(), e.time()), x.primes, x);
  if (x.text == "pi") {
    Value v = Value::of(e.context.pi(), Dimension{});
    v.has_pi = true;
    return time_derivative(e, v, x.primes, x);
  }
  if (x.text == "O") return origin(e, place);
  if (place.reactions && x.primes == 0) {
    if (const std::optional<Value> p = momentum(e, x.text)) return *p;
    if (const std::optional<Value> force = multiplier(e, x.text)) return *force;
  }
  unknown_name_of(e, x.text, x.name_span, true);
  return Value::poison();
}

Value value_of_member(Elaboration& e, const Expression& x, const Place& place) {
  if (refuse_high_order(e, x)) return Value::poison();
  if (const std::optional<Value> omega = angular_velocity(e, x)) return time_derivative(e, *omega, x.primes, x);
  if (const std::optional<std::size_t> q = quaternion_component(e, x)) {
    e.table.find(x.arguments[0]->text)->used = true;
    return derivative_of_coordinate(e, Value::of(e.system().coordinates[*q].q, Dimension{}, 0), x.primes);
  }
  if (place.reactions && x.primes == 0 && x.arguments[0]->kind == Expression::Kind::Name)
    if (const std::optional<Value> p = momentum(e, x.arguments[0]->text + "." + x.text)) return *p;
  Place world = place;
  world.frame = nullptr;  // .x is a world component
  const Value base = evaluate_formula(e, *x.arguments[0], world);
  if (base.poisoned) return base;
  Value v = component(e, base, x);
  return time_derivative(e, v, x.primes, x);
}

}  // namespace maupertuis::elaboration
