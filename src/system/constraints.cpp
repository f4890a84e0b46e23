#include "system/constraint_checks.hpp"
#include "system/elaboration.hpp"

#include <fmt/format.h>

/// Constraints: both sides to one expression φ(q,t) or ψ(q,q̇,t) = left − right, which vanishes along the motion.
namespace maupertuis::elaboration {
namespace {

using syntax::ConstraintStatement;

ExprVector velocities_in(Expr value) {
  ExprVector out;
  const Expr roots[] = {value};
  for (const Expr& s : symbols_of(roots))
    if (s.role() == Role::Coordinate && s.order() == 1) out.push_back(s);
  return out;
}

/// A velocity that cancels, as in (x + y)' - x' - y' + x = l, makes no velocity constraint.
Constraint::Level settle_level(Expr& value) {
  const ExprVector velocities = velocities_in(value);
  if (velocities.empty()) return Constraint::Level::Position;
  const ExprVector rows = gradient(value, velocities);
  if (zero_test(rows).verdict != Verdict::Zero) return Constraint::Level::Velocity;
  ExprMap zero;
  for (const Expr& v : velocities) zero[v] = v.context().number(0);
  value = substitute(value, zero);
  return Constraint::Level::Position;
}

bool refuse_acceleration_in_constraint(Elaboration& e, const Value& v, const syntax::Expression& side) {
  if (v.order < 2) return false;
  const Span at = culprit_of_order(e, side, 2);
  e.diagnostics.error("E0401", at.end > at.begin ? at : side.span, "an acceleration stands in a constraint",
                      "A constraint relates positions, or velocities; what it asks of accelerations follows from it.",
                      "Write the relation between velocities of which this is the derivative.");
  return true;
}

/// Both sides of the constraint; nothing after a mistake.
template <class Statement>
std::optional<Value> difference(Elaboration& e, const Statement& s) {
  const Value left = evaluate_formula(e, *s.left);
  Place place;
  if (!left.poisoned && !left.fits_any) place.expected = left.dimension;
  const Value right = evaluate_formula(e, *s.right, place);
  if (left.poisoned || right.poisoned) return std::nullopt;
  for (const Value* side : {&left, &right}) {
    if (!side->is_vector) continue;
    e.diagnostics.error("E0210", (side == &left ? s.left : s.right)->span,
                        "a constraint is an equation between numbers, not vectors",
                        "Each component of a vector equation is a constraint of its own, with a multiplier of its own.",
                        "Write one constraint for each component, with .x and .y.");
    return std::nullopt;
  }
  if (!left.fits_any && !check_dimension(e, right, left.dimension, "the left side", *s.right)) return std::nullopt;
  if (refuse_acceleration_in_constraint(e, left, *s.left) || refuse_acceleration_in_constraint(e, right, *s.right))
    return std::nullopt;
  Value v = add(e, left, right, true, *s.right, {});
  if (!v.poisoned) v.parts = {left.scalar() - right.scalar()};
  return v.poisoned ? std::nullopt : std::optional(v);
}

/// λ_rod, or λ alone, or λ1, λ2, …; Λ where the model uses λ for something else. `written`: without those of
/// quaternions.
std::string multiplier_name(Elaboration& e, const Constraint& c, std::size_t index, std::size_t written) {
  const std::string tail = !c.name.empty()   ? "_" + c.name
                           : !c.body.empty() ? "_" + c.body
                           : written == 1    ? std::string()
                                             : std::to_string(index + 1);
  for (const char* letter : {"λ", "Λ", "λ̃"})
    if (!e.table.find(letter + tail)) return letter + tail;
  throw std::logic_error("no name is left for a multiplier; please report");
}

void name_multipliers(Elaboration& e, std::size_t written) {
  std::vector<Constraint>& list = e.system().constraints;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = multiplier_name(e, list[i], i, written);
    list[i].multiplier = e.context.symbol(name, Role::Multiplier);
    list[i].reaction =
        e.context.symbol(fmt::format("reaction({})", list[i].name.empty() ? name : list[i].name), Role::Multiplier);
  }
}

}  // namespace

Expr with_inputs_as_formulas(const MechanicalSystem& s, Expr value) {
  ExprMap formulas;
  const Expr roots[] = {value};
  for (const Expr& symbol : symbols_of(roots)) {
    if (symbol.role() != Role::Input) continue;
    for (const Input& u : s.inputs) {
      if (u.name != symbol.name()) continue;
      Expr derivative = u.formula;
      for (int order = 0; order < symbol.order(); ++order) derivative = total_time_derivative(derivative);
      formulas[symbol] = derivative;
    }
  }
  return formulas.empty() ? value : substitute(value, formulas);
}

void elaborate_gauges(Elaboration& e) {
  for (const syntax::Statement& statement : e.tree.statements) {
    const auto* s = std::get_if<syntax::GaugeStatement>(&statement.body);
    const std::optional<Value> v = s ? difference(e, *s) : std::nullopt;
    if (!v) continue;
    Gauge gauge;
    gauge.text = e.texts.slice(cover(s->left->span, s->right->span));
    gauge.value = with_inputs_as_formulas(e.system(), expand_time_derivatives(v->scalar()));
    gauge.dimension = v->dimension;
    gauge.span = statement.span;
    e.system().gauges.push_back(std::move(gauge));
  }
}

void elaborate_constraints(Elaboration& e) {
  for (const syntax::Statement& statement : e.tree.statements) {
    const auto* s = std::get_if<ConstraintStatement>(&statement.body);
    if (s && s->integral) elaborate_integral_constraint(e, *s, statement.span);
    if (!s || s->integral) continue;
    const std::optional<Value> v = difference(e, *s);
    if (!v) continue;
    Constraint c;
    c.name = s->name ? s->name->text : "";
    c.value = with_inputs_as_formulas(e.system(), expand_time_derivatives(v->scalar()));
    c.dimension = v->dimension;
    c.span = statement.span;
    const bool names_coordinates = v->order >= 0;  // they may cancel
    if (refuse_switch(e, *s, c.value) || (names_coordinates && refuse_identity(e, c)) ||
        refuse_without_coordinates(e, c))
      continue;
    c.level = settle_level(c.value);
    e.system().constraints.push_back(std::move(c));
  }
  warn_of_repetition(e);
  const std::size_t written = e.system().constraints.size();
  constrain_quaternions(e);
  name_multipliers(e, written);
}

}  // namespace maupertuis::elaboration
