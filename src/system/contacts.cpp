#include "system/elaboration.hpp"
#include "system/field_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

/// Inequalities g(q, t) ≥ 0 and Coulomb's friction.
namespace maupertuis::elaboration {
namespace {

using syntax::ContactStatement;
using syntax::FrictionStatement;

/// Nothing after a mistake.
std::optional<Value> gap_of(Elaboration& e, const ContactStatement& s) {
  const Value left = evaluate_formula(e, *s.left);
  Place place;
  if (!left.poisoned && !left.fits_any) place.expected = left.dimension;
  const Value right = evaluate_formula(e, *s.right, place);
  if (left.poisoned || right.poisoned) return std::nullopt;
  for (const auto& [side, text] : {std::pair{&left, &s.left}, std::pair{&right, &s.right}}) {
    if (side->is_vector) {
      e.diagnostics.error("E0210", (*text)->span, "a contact compares numbers, not vectors",
                          "It says on which side of a surface the system stays.", "Take a component with .x or .y.");
      return std::nullopt;
    }
    if (side->order < 1) continue;
    e.diagnostics.error("E0262", (*text)->span, "a velocity stands in a contact",
                        "A contact bounds positions; when it is closed its velocities follow.",
                        "Write an inequality between coordinates and time.");
    return std::nullopt;
  }
  if (!left.fits_any && !check_dimension(e, right, left.dimension, "the left side", *s.right)) return std::nullopt;
  Value v = add(e, left, right, true, *s.right, {});
  if (v.poisoned) return std::nullopt;
  const Expr difference = s.at_most ? right.scalar() - left.scalar() : left.scalar() - right.scalar();
  v.parts = {with_inputs_as_formulas(e.system(), expand_time_derivatives(difference))};
  return v;
}

/// A number of parameters alone, e or μ; nothing after a mistake.
std::optional<Expr> number_in(Elaboration& e, const syntax::ExpressionPtr& x, const char* what, double most,
                              const char* reason) {
  if (!x) return e.number(0);
  const Value v = constant_of(e, *x, Dimension{}, what);
  if (v.poisoned) return std::nullopt;
  const std::optional<double> size = constant_value(e, v.scalar());
  if (size && *size >= 0 && *size <= most) return v.scalar();
  e.diagnostics.error("E0263", x->span, fmt::format("{} is {:g}", what, size.value_or(NAN)), reason,
                      most == 1 ? "Choose a number from 0 (it does not bounce) to 1 (it bounces without loss)."
                                : "Choose a number that is not negative.");
  return std::nullopt;
}

const char* const kReasonOfCoefficient = "Friction takes energy from the motion: its coefficient is not negative.";

bool has_coordinates(Expr gap) {
  const Expr roots[] = {gap};
  for (const Expr& s : symbols_of(roots))
    if (s.role() == Role::Coordinate) return true;
  return false;
}

/// λ_floor, or λ_c1 for the first contact without a name.
Expr new_multiplier(Elaboration& e, const std::string& tail) {
  for (const char* letter : {"λ_", "Λ_", "λ̃_"})
    if (!e.table.find(letter + tail)) return e.context.symbol(letter + tail, Role::Multiplier);
  throw std::logic_error("no name is left for a multiplier; please report");
}

/// E0264 where μ_s < μ.
bool refuse_order_of_coefficients(Elaboration& e, Expr kinetic, Expr static_, const syntax::Expression& x) {
  const std::optional<double> k = constant_value(e, kinetic), s = constant_value(e, static_);
  if (!k || !s || *s >= *k) return false;
  e.diagnostics.error("E0264", x.span, fmt::format("static friction {:g} is below kinetic friction {:g}", *s, *k),
                      "What holds a body that rests is at least what brakes one that slides.",
                      "Exchange the two, or leave `static` out.");
  return true;
}

bool are_independent(const ExprVector& a, const ExprVector& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (zero_test(a[i] * b[j] - a[j] * b[i]).verdict != Verdict::Zero) return true;
  return false;
}

/// Two components are those in the plane of contact, in a model of any dimension.
Value slip_value(Elaboration& e, const syntax::Expression& slip) {
  if (slip.kind != syntax::Expression::Kind::Vector || slip.arguments.size() != 2) return evaluate_formula(e, slip);
  Value first = evaluate_formula(e, *slip.arguments[0]);
  const Value second = evaluate_formula(e, *slip.arguments[1]);
  if (first.poisoned || second.poisoned) return Value::poison();
  if (first.is_vector || second.is_vector) return evaluate_formula(e, slip);  // which says what is wrong
  if (!first.fits_any && !check_dimension(e, second, first.dimension, "the first component", *slip.arguments[1]))
    return Value::poison();
  first.parts.push_back(second.scalar());
  first.is_vector = true;
  return first;
}

/// v_t: linear in the velocities, and not along the normal. Empty after a mistake.
ExprVector slip_of(Elaboration& e, const ContactStatement& s, Expr gap) {
  Value v = slip_value(e, *s.slip);
  if (v.poisoned) return {};
  std::erase_if(v.parts, [&](const Expr& part) { return v.parts.size() > 1 && part.is_zero(); });
  if (v.parts.size() > 2) {
    e.diagnostics.error("E0265", s.slip->span, "a slip velocity of three components",
                        "The point of contact slides in the plane of contact: two components, along two directions at "
                        "right angles to each other.",
                        "Write the components in that plane, such as slip (x', y').");
    return {};
  }
  const Dimension speed = e.dimension(dimensions::length()) / e.time();
  if (!v.fits_any && !check_dimension(e, v, speed, "a slip velocity", *s.slip)) return {};
  ExprVector velocities, coordinates, out;
  for (const Coordinate& c : e.system().coordinates) velocities.push_back(c.velocity), coordinates.push_back(c.q);
  const ExprVector normal = gradient(gap, coordinates);
  for (const Expr& part : v.parts) {
    const Expr slip = with_inputs_as_formulas(e.system(), expand_time_derivatives(part));
    const ExprVector row = gradient(slip, velocities);
    bool moves = false, along_normal = true, linear = true;
    for (std::size_t i = 0; i < row.size(); ++i) {
      moves = moves || !row[i].is_zero();
      for (const Expr& entry : gradient(row[i], velocities))
        linear = linear && zero_test(entry).verdict == Verdict::Zero;
      for (std::size_t j = 0; j < i; ++j)
        along_normal = along_normal && zero_test(row[i] * normal[j] - row[j] * normal[i]).verdict == Verdict::Zero;
    }
    const bool one_coordinate = row.size() == 1;
    if (!moves || !linear || (along_normal && (!one_coordinate || !normal[0].is_zero()))) {
      const char* reason = !moves || !linear
                               ? "The velocity of the point of contact along the surface is linear in the velocities."
                               : "It is the velocity along the normal, at which the contact opens or closes.";
      e.diagnostics.error("E0265", s.slip->span, "this is no slip velocity of the contact", reason,
                          "Write the velocity of the touching point along the surface, such as slip x' - R φ'.");
      return {};
    }
    out.push_back(slip);
  }
  if (out.size() == 2 && !are_independent(gradient(out[0], velocities), gradient(out[1], velocities))) {
    e.diagnostics.error("E0265", s.slip->span, "the two components of this slip velocity are one",
                        "Where friction acts in a plane they are those along two directions at right angles.",
                        "Write two different components, such as slip (x', y'), or one alone.");
    return {};
  }
  return out;
}

/// E0266 where g is no length: then λ is no force.
bool refuse_gap_of_friction(Elaboration& e, const ContactStatement& s, const Dimension& gap) {
  if (e.dimensionless || gap.same_as(dimensions::length())) return false;
  e.diagnostics.error("E0266", s.left->span, "friction needs a gap that is a length",
                      "Friction is μ times the normal force, and λ is that force only where g is the distance to the "
                      "surface.",
                      "Write the contact as a distance: sqrt(x^2 + z^2) >= R instead of x^2 + z^2 >= R^2.");
  return true;
}

/// False after a mistake.
bool add_friction(Elaboration& e, const ContactStatement& s, const Dimension& gap, const std::string& tail,
                  Contact& c) {
  if (!s.friction && !s.static_friction && !s.slip && !s.sticking) return true;
  if (!s.slip || (!s.friction && !s.sticking)) {
    const Span at = s.slip ? s.slip->span : s.friction ? s.friction->span : s.left->span;
    e.diagnostics.error("E0265", at, s.slip ? "a slip velocity without friction" : "friction without a slip velocity",
                        "Friction acts against the velocity of the point of contact along the surface.",
                        "Write both: friction μ slip x'; or slip x' sticking, where it never slides.");
    return false;
  }
  const auto kinetic = number_in(e, s.friction, "a coefficient of friction", 1e300, kReasonOfCoefficient);
  const auto static_ = s.static_friction
                           ? number_in(e, s.static_friction, "a coefficient of friction", 1e300, kReasonOfCoefficient)
                           : kinetic;
  if (!kinetic || !static_) return false;
  if (s.static_friction && refuse_order_of_coefficients(e, *kinetic, *static_, *s.static_friction)) return false;
  if (!s.sticking && refuse_gap_of_friction(e, s, gap)) return false;
  c.friction.slip = slip_of(e, s, c.gap);
  if (c.friction.slip.empty()) return false;
  c.friction.name = c.name;
  c.friction.kinetic = *kinetic;
  c.friction.static_ = *static_;
  c.friction.sticking = s.sticking;
  c.friction.span = s.slip->span;
  for (std::size_t k = 0; k < c.friction.slip.size(); ++k)
    c.friction.multipliers.push_back(
        new_multiplier(e, tail + "_t" + (c.friction.slip.size() == 1 ? "" : std::to_string(k + 1))));
  return true;
}

void contact(Elaboration& e, const ContactStatement& s, Span span) {
  const std::optional<Value> gap = gap_of(e, s);
  const auto restitution =
      number_in(e, s.restitution, "a restitution", 1, "It is the part of the speed that an impact gives back.");
  if (!gap) return;
  Contact c;
  c.gap = gap->scalar();
  c.dimension = gap->dimension;
  c.name = s.name ? s.name->text : "";
  c.span = span;
  if (!has_coordinates(c.gap)) {
    e.diagnostics.error("E0267", span, "this contact contains no coordinate",
                        "Its sides are known for all times, whatever the motion: it bounds nothing.",
                        "Write an inequality of coordinates.");
    return;
  }
  const std::string tail = c.name.empty() ? "c" + std::to_string(e.system().contacts.size() + 1) : c.name;
  if (!restitution || !add_friction(e, s, c.dimension, tail, c)) return;
  c.restitution = *restitution;
  c.multiplier = new_multiplier(e, tail);
  c.reaction = e.context.symbol(fmt::format("reaction({})", c.name.empty() ? tail : c.name), Role::Multiplier);
  e.system().contacts.push_back(std::move(c));
}

/// E0225: the force of a contact is not one of the equations while the contact is open.
bool refuse_force_of_contact(Elaboration& e, Expr normal, const syntax::Expression& x) {
  const ExprVector symbols = symbols_of({&normal, 1});
  for (const Contact& c : e.system().contacts) {
    if (std::none_of(symbols.begin(), symbols.end(),
                     [&](const Expr& s) { return s == c.reaction || s == c.multiplier; }))
      continue;
    e.diagnostics.error("E0225", x.span, "the force of a contact cannot be the normal force of another friction",
                        "A contact has friction of its own, which begins and ends with it.",
                        "Write it there: contact … friction μ slip x'.");
    return true;
  }
  return false;
}

/// The coordinate along which friction acts, the value of a field at a place among them.
std::optional<std::size_t> rubbed_coordinate(Elaboration& e, const syntax::Expression& x) {
  if (e.fields && x.kind == syntax::Expression::Kind::Call && e.fields->system.jet_of_name(x.text))
    return coordinate_of_place(e, x);
  if (e.fields && x.kind == syntax::Expression::Kind::Name && e.fields->system.jet_of_name(x.text)) {
    e.diagnostics.error("E0299", x.span, fmt::format("friction along `{}` without a place", e.texts.slice(x.span)),
                        "Dry friction acts at places; along all of a field it would hold every piece by itself.",
                        fmt::format("Write the value at a place, such as `friction {}(l) limit F`.", x.text));
    return std::nullopt;
  }
  const auto of = start_variable(e, x);
  return of ? std::optional(of->coordinate) : std::nullopt;
}

/// q'' itself; a reaction, which follows from accelerations, may be a normal force.
bool knows_acceleration(Expr value) {
  const Expr plain = expand_time_derivatives(value);
  const std::vector<Expr> symbols = symbols_of({&plain, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [](const Expr& s) { return s.role() == Role::Coordinate && s.order() >= 2; });
}

/// friction x coefficient μ static μs normal m g,   friction θ limit M static Ms
void friction(Elaboration& e, const FrictionStatement& s, Span span) {
  const auto along = rubbed_coordinate(e, *s.coordinate);
  if (!along) return;
  const Coordinate c = e.system().coordinates[*along];  // a copy: u(l) in the limit may be a new coordinate
  const Dimension force = e.dimension(dimensions::energy()) / c.dimension;
  Friction f;
  f.name = c.name;
  f.slip = {c.velocity};
  f.span = span;
  if (s.limit) {
    const Value most = scalar_of(e, *s.limit, force, fmt::format("the greatest friction along {}", c.name));
    const Value holds =
        s.static_friction ? scalar_of(e, *s.static_friction, force, "the greatest static friction") : most;
    if (most.poisoned || holds.poisoned || refuse_acceleration(e, most, *s.limit, "a limit of friction") ||
        (s.static_friction && refuse_acceleration(e, holds, *s.static_friction, "a limit of friction")))
      return;
    f.kinetic = most.scalar(), f.static_ = holds.scalar();
    const std::optional<double> size = constant_value(e, f.kinetic);
    if (size && *size < 0) {
      e.diagnostics.error("E0263", s.limit->span, fmt::format("a limit of friction is {:g}", *size),
                          kReasonOfCoefficient, "Choose a number that is not negative.");
      return;
    }
  } else {
    const auto kinetic = number_in(e, s.coefficient, "a coefficient of friction", 1e300, kReasonOfCoefficient);
    const auto static_ = s.static_friction
                             ? number_in(e, s.static_friction, "a coefficient of friction", 1e300, kReasonOfCoefficient)
                             : kinetic;
    Place along_motion;
    along_motion.reactions = true;
    const Value normal = scalar_of(e, *s.normal, force, "the normal force", along_motion);
    if (!kinetic || !static_ || normal.poisoned || refuse_force_of_contact(e, normal.scalar(), *s.normal) ||
        (knows_acceleration(normal.scalar()) && refuse_acceleration(e, normal, *s.normal, "a normal force")))
      return;
    f.kinetic = *kinetic, f.static_ = *static_, f.normal = normal.scalar();
  }
  if (s.static_friction && refuse_order_of_coefficients(e, f.kinetic, f.static_, *s.static_friction)) return;
  f.multipliers = {new_multiplier(e, c.name + "_t")};
  e.system().frictions.push_back(std::move(f));
}

/// W0443: a run ends where a contact that rubs is hit together with another one.
void warn_of_friction_at_once(Elaboration& e, Span impact) {
  const std::vector<Contact>& contacts = e.system().contacts;
  const auto rubs = std::find_if(contacts.begin(), contacts.end(), [&](const Contact& c) {
    return c.friction.sticking || (c.friction.present() && constant_value(e, c.friction.kinetic) != 0.0);
  });
  if (rubs == contacts.end() || contacts.size() < 2) return;
  const auto index = static_cast<std::size_t>(rubs - contacts.begin());
  e.diagnostics.warning(
      "W0443", impact,
      fmt::format("simultaneous impacts say nothing of the friction of {}", e.system().contact_label(index)),
      "Their law has normal impulses alone. A contact that is hit alone has its friction; a run ends where one with "
      "friction is hit together with others.",
      "Leave `impact simultaneous` out: one contact after the other is hit then, with its friction.");
}

}  // namespace

void elaborate_contacts(Elaboration& e) {
  std::optional<Span> at_once;
  for (const syntax::Statement& statement : e.tree.statements) {
    if (const auto* s = std::get_if<ContactStatement>(&statement.body)) contact(e, *s, statement.span);
    if (const auto* s = std::get_if<syntax::ImpactStatement>(&statement.body); s && s->simultaneous) {
      e.system().impact_law = ImpactLaw::Simultaneous;
      at_once = statement.span;
    }
  }
  if (at_once) warn_of_friction_at_once(e, *at_once);
  for (const syntax::Statement& statement : e.tree.statements)
    if (const auto* s = std::get_if<FrictionStatement>(&statement.body)) friction(e, *s, statement.span);
}

void elaborate_event(Elaboration& e, const syntax::EventStatement& s, Span span) {
  ModelEvent event;
  event.name = s.name.text;
  event.span = span;
  event.direction = s.direction;
  using Written = syntax::EventStatement::Action;
  event.action = s.action == Written::Stop  ? ModelEvent::Action::Stop
                 : s.action == Written::Set ? ModelEvent::Action::Set
                                            : ModelEvent::Action::Record;
  event.function = condition(e, *s.left, *s.right, "an event happens");
  bool complete = static_cast<bool>(event.function);
  if (complete && constant_value(e, event.function)) {
    e.diagnostics.error("E0268", cover(s.left->span, s.right->span), "this event never happens, or always",
                        "Its two sides are known before the motion: they do not cross.",
                        "Write a condition on coordinates, velocities, forces or time.");
    return;
  }
  for (const auto& item : s.sets) {
    const auto variable = start_variable(e, *item.variable);
    if (!variable) return;
    const Coordinate& c = e.system().coordinates[variable->coordinate];
    const Dimension expected = variable->order == 0 ? c.dimension : c.dimension / e.time();
    Place place;
    place.inline_constants = true;
    const Value v = scalar_of(e, *item.value, expected, fmt::format("`{}`", e.texts.slice(item.variable->span)), place);
    complete = complete && !v.poisoned && !refuse_without_place(e, v.scalar(), *item.value) &&
               !refuse_acceleration(e, v, *item.value, "what an event sets");
    if (complete)
      event.sets.push_back(
          {variable->coordinate, variable->order, expand_time_derivatives(v.scalar()), item.value->span});
  }
  if (complete) e.experiment().events.push_back(std::move(event));
}

}  // namespace maupertuis::elaboration
