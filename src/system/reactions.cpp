#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

/// Forces of constraint in formulas: multiplier(rod), reaction(rod), and `reaction rod = release l`.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Kind = Declaration::Kind;

const char* const kReasonOfPlace =
    "A force of constraint follows from the equations of motion: energies, forces and constraints cannot be made of "
    "it.";

const char* const kHelpOfPlace =
    "It may stand in events, `run until`, `expect` and `claim`, and as the normal force of a friction: friction x "
    "coefficient μ normal reaction(rod).";

/// λ is conjugate to the constraint: λ δφ is an energy, λ ψ a power.
Dimension dimension_of_multiplier(Elaboration& e, const Constraint& c) {
  const bool position = c.level == Constraint::Level::Position;
  const Dimension& energy = e.system().lagrangian_dimension;
  return (position ? energy : energy / e.time()) / c.dimension;
}

bool is_power_of_length(Dimension d) {
  d.exponents[Dimension::Length] = {};
  return d.is_one();
}

/// A reaction is a force, or a torque. Which of them, the multiplier says where its own unit is one; else the
/// coordinates that the constraint ties, or the unit of φ: x² + y² = l² is a relation of lengths. Between charges it is
/// the multiplier itself, a voltage.
Dimension dimension_of_reaction(Elaboration& e, const Constraint& c) {
  if (e.dimensionless) return {};
  const auto all = [&](const Dimension& kind) {
    const Expr roots[] = {c.value};
    for (const Coordinate& q : e.system().coordinates)
      for (const Expr& s : symbols_of(roots))
        if ((s == q.q || s == q.velocity) && (!q.dimension.same_as(kind) || q.dimension.angle() != kind.angle()))
          return false;
    return true;
  };
  const Dimension multiplier = dimension_of_multiplier(e, c);
  if (all(dimensions::length()) || multiplier.same_as(dimensions::force())) return dimensions::force();
  if (!c.dimension.is_one() && is_power_of_length(c.dimension)) return dimensions::force();
  return all(dimensions::angle()) ? dimensions::torque() : multiplier;
}

Declaration* find_named(Elaboration& e, const syntax::Name& name) {
  Declaration* d = e.table.find(name.text);
  if (!d && e.table.is_lost(name.text)) return nullptr;
  const auto* held =
      d && d->kind == Kind::Constraint ? std::get_if<syntax::ConstraintStatement>(&d->statement->body) : nullptr;
  if (held && held->integral) {
    e.diagnostics.error("E0226", name.span, fmt::format("`{}` holds an integral and exerts no force", name.text),
                        "Its multiplier is one number of a whole path, which `maup action` finds.", "");
    return nullptr;
  }
  if (d && (d->kind == Kind::Constraint || d->kind == Kind::Reaction || d->kind == Kind::Contact)) return d;
  std::vector<std::string> names;
  for (const Declaration& other : e.table.declarations())
    if (other.kind == Kind::Constraint || other.kind == Kind::Reaction || other.kind == Kind::Contact)
      names.push_back(other.name);
  const std::string near = did_you_mean(name.text, names);
  e.diagnostics.error("E0226", name.span,
                      d && d->statement ? fmt::format("`{}` is a {}, not a constraint", name.text, word_of(d->kind))
                                        : fmt::format("the model has no constraint `{}`", name.text),
                      "A constraint is called by the name that stands at its end.",
                      near.empty() ? fmt::format("Name the one that is meant: constraint … = … name {}.",
                                                 d && d->statement ? "rod" : name.text)
                                   : fmt::format("Did you mean `{}`?", near));
  return nullptr;
}

Value of_constraint(Elaboration& e, const Constraint& c, bool multiplier) {
  return Value::of(multiplier ? c.multiplier : c.reaction,
                   multiplier ? dimension_of_multiplier(e, c) : dimension_of_reaction(e, c), 2);
}

Value of_release(Elaboration& e, const Release& r, bool multiplier, const Expression& x) {
  if (multiplier) {
    e.diagnostics.error("E0226", x.span, fmt::format("`{}` is a reaction without a multiplier", r.name),
                        "The choice of coordinates has removed its constraint from the equations.",
                        fmt::format("Write reaction({}).", r.name));
    return Value::poison();
  }
  return Value::of(r.reaction, e.dimension(dimensions::energy()) / e.system().parameters[r.parameter].dimension, 2);
}

}  // namespace

Value value_of_multiplier(Elaboration& e, const Constraint& c) { return of_constraint(e, c, true); }

Value value_of_reaction(Elaboration& e, const Expression& x, const Place& place) {
  const Expression& name = *x.arguments[0];
  if (name.kind != Expression::Kind::Name || name.primes > 0) {
    e.diagnostics.error("E0226", name.span, fmt::format("`{}` takes the name of a constraint", x.text), "",
                        fmt::format("Name the constraint, constraint … = … name rod, and write {}(rod).", x.text));
    return Value::poison();
  }
  if (!place.reactions) {
    e.diagnostics.error("E0225", x.span, fmt::format("`{}` cannot stand here", e.texts.slice(x.span)), kReasonOfPlace,
                        kHelpOfPlace);
    return Value::poison();
  }
  Declaration* d = find_named(e, {name.text, name.span});
  if (!d) return Value::poison();
  const bool multiplier = x.text == "multiplier";
  for (const Constraint& c : e.system().constraints)
    if (c.name == name.text) return of_constraint(e, c, multiplier);
  for (const Contact& c : e.system().contacts)
    if (c.name == name.text) return of_constraint(e, as_constraint(c), multiplier);
  for (const Release& r : e.system().releases)
    if (r.name == name.text) return of_release(e, r, multiplier, x);
  return Value::poison();  // its own line has a mistake
}

namespace {

/// The friction of the contact of this name, or along this coordinate, with the dimension of its force.
std::pair<const Friction*, Dimension> find_friction(Elaboration& e, const std::string& name) {
  for (const Contact& c : e.system().contacts)
    if (c.name == name && c.friction.present()) return {&c.friction, e.dimension(dimensions::force())};
  for (const Friction& f : e.system().frictions)
    if (f.name == name)
      for (const Coordinate& c : e.system().coordinates)
        if (c.name == name) return {&f, e.system().lagrangian_dimension / c.dimension};
  return {nullptr, {}};
}

}  // namespace

Value value_of_friction(Elaboration& e, const Expression& x, const Place& place) {
  if (!place.reactions) {
    e.diagnostics.error("E0225", x.span, fmt::format("`{}` cannot stand here", e.texts.slice(x.span)), kReasonOfPlace,
                        kHelpOfPlace);
    return Value::poison();
  }
  const Expression& name = *x.arguments[0];
  const bool is_name = name.kind == Expression::Kind::Name && name.primes == 0;
  const auto [found, dimension] = is_name ? find_friction(e, name.text) : std::pair<const Friction*, Dimension>();
  if (!found) {
    e.diagnostics.error("E0226", name.span, fmt::format("the model has no friction `{}`", e.texts.slice(name.span)),
                        "friction(…) takes the name of a contact with friction, or a coordinate along which it acts.",
                        "Name the contact, contact … friction μ slip x' name floor, and write friction(floor).");
    return Value::poison();
  }
  if (found->in_space()) {
    e.diagnostics.error("E0226", x.span, fmt::format("the friction of `{}` is no number", name.text),
                        "In space it has two components, along those of its slip.",
                        "While it slides its size is the coefficient times the normal force, μ reaction(floor).");
    return Value::poison();
  }
  if (Declaration* d = e.table.find(name.text)) d->used = true;
  return Value::of(found->multipliers[0], dimension, 2);
}

bool names_a_reaction(Elaboration& e, const syntax::Name& name) { return find_named(e, name) != nullptr; }

bool check_class_of_constraint(Elaboration& e, const syntax::expectation::ConstraintClass& x) {
  static const std::array<std::string, 5> classes = {"holonomic", "nonholonomic", "scleronomic", "rheonomic",
                                                     "integrable"};
  Declaration* d = find_named(e, x.constraint);
  if (d && d->kind != Kind::Constraint) {
    e.diagnostics.error("E0226", x.constraint.span,
                        fmt::format("`{}` is a {}, not a constraint", d->name, word_of(d->kind)),
                        d->kind == Kind::Contact ? "An inequality holds as a constraint only while it is closed."
                                                 : "The choice of coordinates has removed its constraint.",
                        "");
    d = nullptr;
  }
  if (std::find(classes.begin(), classes.end(), x.word.text) != classes.end()) return d != nullptr;
  const std::string near = did_you_mean(x.word.text, classes);
  e.diagnostics.error("E0227", x.word.span, fmt::format("`{}` is no class of constraints", x.word.text),
                      "A constraint is holonomic, nonholonomic, scleronomic, rheonomic or integrable.",
                      near.empty() ? "" : fmt::format("Did you mean `{}`?", near));
  return false;
}

void elaborate_release(Elaboration& e, const syntax::ReactionStatement& s) {
  Declaration* d = find_declared(e, s.released);
  if (!d) return;
  if (d->kind != Kind::Parameter) {
    e.diagnostics.error("E0212", s.released.span,
                        fmt::format("`{}` is a {}, not a parameter", d->name, word_of(d->kind)),
                        "A reaction shows the force that keeps a parameter, such as a length, at its value.", "");
    return;
  }
  const Expr symbol = e.context.symbol(fmt::format("reaction({})", s.name.text), Role::Multiplier);
  for (std::size_t i = 0; i < e.system().parameters.size(); ++i)
    if (e.system().parameters[i].name == d->name) e.system().releases.push_back({s.name.text, i, symbol, s.name.span});
}

}  // namespace maupertuis::elaboration
