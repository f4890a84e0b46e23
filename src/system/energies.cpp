#include "system/elaboration.hpp"

#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

/// T, V, U, L and D: what masses, gravity, springs and dampers give, and what the text gives.
namespace maupertuis::elaboration {
namespace {

using syntax::EnergyStatement;
using Which = EnergyStatement::Which;

Dimension dimension_of(Which which) { return which == Which::D ? dimensions::power() : dimensions::energy(); }

std::vector<EnergyTerm>& terms_of(MechanicalSystem& s, Which which) {
  switch (which) {
    case Which::T:
      return s.kinetic;
    case Which::V:
      return s.potential;
    case Which::U:
      return s.generalized_potential;
    case Which::D:
      return s.dissipation;
    case Which::L:
      break;
  }
  return s.lagrangian_extra;
}

// ---------------------------------------------------------------------------------------- what masses and springs give

void kinetic_of_masses(MechanicalSystem& s) {
  for (const Point& p : s.points)
    if (p.mass) s.kinetic.push_back({translational_energy(p.mass, p.position), "particle " + p.name, p.span});
  for (const Body& b : s.bodies) {
    if (b.mass) s.kinetic.push_back({translational_energy(b.mass, b.position), "motion of body " + b.name, b.span});
    if (b.inertia.rows == 0) continue;
    const Expr rotation = Rational(1, 2) * dot_of(b.angular_velocity, rotate(b.inertia, b.angular_velocity));
    s.kinetic.push_back({rotation, "rotation of body " + b.name, b.span});
  }
}

/// −m g·r is a potential of the weight m g where g is the same everywhere.
bool refuse_motion(Elaboration& e, const Value& v, const syntax::GravityStatement& g) {
  if (v.order < 0) return false;
  e.diagnostics.error("E0436", culprit_of_order(e, *g.vector, v.order),
                      "gravity depends on where a body is or how it moves",
                      "`gravity` is the same for all bodies: their potential −m g·r gives the weight m g only then.",
                      "Write the potential of such a field, V = -G M m/r.");
  return true;
}

void gravity(Elaboration& e, const syntax::GravityStatement& g, Span span) {
  const Value v = vector_of(e, *g.vector, dimensions::acceleration(), "gravity");
  if (v.poisoned || refuse_motion(e, v, g)) return;
  for (const Expr& part : v.parts)
    if (refuse_without_place(e, part, *g.vector)) return;
  MechanicalSystem& s = e.system();
  s.gravity = v.parts;
  const auto weigh = [&](Expr mass, const ExprVector& position, const std::string& name) {
    if (mass && !dot_of(s.gravity, position).is_zero())
      s.potential.push_back({-(mass * dot_of(s.gravity, position)), "gravity on " + name, span});
  };
  for (const Point& p : s.points) weigh(p.mass, p.position, p.name);
  for (const Body& b : s.bodies) weigh(b.mass, b.position, b.name);
}

/// The way from one end to the other; the link is kept, to be drawn.
std::optional<ExprVector> between(Elaboration& e, Link::Kind kind, const syntax::Expression& from,
                                  const syntax::Expression& to) {
  const Value a = position_of(e, from, nullptr), b = position_of(e, to, nullptr);
  if (a.poisoned || b.poisoned) return std::nullopt;
  const auto name = [](const syntax::Expression& x) {
    return x.kind == syntax::Expression::Kind::Name ? x.text : std::string();
  };
  e.system().links.push_back({kind, name(from), name(to), a.parts, b.parts});
  return vector_sum(b.parts, scaled(e.number(-1), a.parts));
}

/// A link between a place and itself has no length and no direction.
bool refuse_one_place(Elaboration& e, const ExprVector& way, const syntax::Expression& from,
                      const syntax::Expression& to, const char* what) {
  if (!std::all_of(way.begin(), way.end(), [](const Expr& x) { return x.is_zero(); })) return false;
  e.diagnostics.error("E0441", Span{from.span.begin, to.span.end},
                      fmt::format("both ends of this {} are one place", what),
                      "It has no length that could change, and no direction of a force.",
                      "Write another point at one end; a fixed place is a vector, (0, 0).");
  return true;
}

std::string pair_name(const Elaboration& e, const syntax::ExpressionPtr& from, const syntax::ExpressionPtr& to) {
  return fmt::format("{} - {}", e.texts.slice(from->span), e.texts.slice(to->span));
}

/// A stiffness or damping coefficient below zero gives energy away.
void check_positive(Elaboration& e, const Value& v, const syntax::Expression& x, const char* what, const char* reason) {
  const std::optional<double> size = v.poisoned ? std::nullopt : constant_value(e, v.scalar());
  if (size && *size < 0) e.diagnostics.warning("W0419", x.span, fmt::format("{} is negative", what), reason, "");
}

/// A spring stores what depends on positions: no stiffness and no rest length holds a velocity.
bool refuse_velocity(Elaboration& e, const Value& v, const syntax::Expression& x, const char* what) {
  if (v.poisoned || v.order < 1) return v.poisoned;
  e.diagnostics.error(
      "E0405", culprit_of_order(e, x, v.order), fmt::format("a velocity stands in {}", what),
      "The energy of a spring is a potential energy, ½ k s²: it depends on positions (and perhaps on time).",
      "Write `U = …` for forces with a potential that depends on velocities, `force …` for others.");
  return true;
}

/// D = ½ c ṡ² gives the force c ṡ where c holds no velocity; c |ṡ| ṡ has D = c |ṡ|³/3.
bool refuse_velocity_in_coefficient(Elaboration& e, const Value& c, const syntax::Expression& x) {
  if (c.poisoned || c.order < 1) return c.poisoned;
  e.diagnostics.error("E0436", culprit_of_order(e, x, c.order), "a velocity stands in a damping coefficient",
                      "A damper is D = ½ c ṡ², with ṡ the rate of its length. Its force −∂D/∂ṡ is −c ṡ only where c "
                      "depends on no velocity.",
                      "Write D itself: D = 1/3 c abs(s')^3 has the force c abs(s') s'.");
  return true;
}

/// V = ½ k (|r| − l₀)², without the root where l₀ = 0.
void spring(Elaboration& e, const syntax::SpringStatement& s, Span span) {
  const std::optional<ExprVector> r = between(e, Link::Kind::Spring, *s.from, *s.to);
  const Value k = scalar_of(e, *s.stiffness, dimensions::force() / dimensions::length(), "a stiffness");
  const Value l0 = s.length ? scalar_of(e, *s.length, dimensions::length(), "the rest length of a spring")
                            : Value::of(e.number(0), Dimension{});
  check_positive(e, k, *s.stiffness, "this stiffness",
                 "Such a spring pushes away from its rest length: every rest is unstable.");
  if (s.length)
    check_positive(e, l0, *s.length, "this rest length", "No spring is shorter than 0: it pulls at every length.");
  const bool refused = refuse_velocity(e, k, *s.stiffness, "the stiffness of a spring") ||
                       (s.length && refuse_velocity(e, l0, *s.length, "the rest length of a spring"));
  if (!r || refused || refuse_one_place(e, *r, *s.from, *s.to, "spring")) return;
  const Expr square = square_of(*r);
  const Expr stretch = l0.scalar().is_zero() ? square : pow(sqrt(square) - l0.scalar(), Rational(2));
  e.system().potential.push_back(
      {Rational(1, 2) * (k.scalar() * stretch), "spring " + pair_name(e, s.from, s.to), span});
}

void torsion_spring(Elaboration& e, const syntax::TorsionSpringStatement& s, Span span) {
  Declaration* d = find_declared(e, s.coordinate);
  if (d && d->kind != Declaration::Kind::Coordinate && d->kind != Declaration::Kind::Definition) {
    e.diagnostics.error("E0212", s.coordinate.span,
                        fmt::format("`{}` is a {}, not a coordinate", s.coordinate.text, word_of(d->kind)),
                        "A torsion spring acts on an angle.", "");
    d = nullptr;
  }
  const Dimension angle = d && d->done && !d->value.poisoned ? d->value.dimension : dimensions::angle();
  const Value k =
      scalar_of(e, *s.stiffness, dimensions::energy() / (angle * angle), "the stiffness of a torsion spring");
  const Value rest = s.rest ? scalar_of(e, *s.rest, angle, "its rest angle") : Value::of(e.number(0), angle);
  check_positive(e, k, *s.stiffness, "this stiffness",
                 "Such a spring pushes away from its rest angle: every rest is unstable.");
  const bool refused = refuse_velocity(e, k, *s.stiffness, "the stiffness of a torsion spring") ||
                       (s.rest && refuse_velocity(e, rest, *s.rest, "the rest angle of a torsion spring"));
  if (!d || !d->done || d->value.poisoned || d->value.is_vector || refused) return;
  const Expr turn = d->value.scalar() - rest.scalar();
  e.system().potential.push_back(
      {Rational(1, 2) * (k.scalar() * pow(turn, Rational(2))), "torsion spring " + d->name, span});
}

/// Whether both ends stay on one line through space: r × ṙ = 0 wherever they are.
bool keeps_direction(const ExprVector& r, const ExprVector& rate) {
  for (std::size_t i = 0; i < r.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (zero_test(r[i] * rate[j] - r[j] * rate[i]).verdict != Verdict::Zero) return false;
  return true;
}

/// D = ½ c (d|r|/dt)². On a line that is ½ c ṙ·ṙ, at |r| = 0 too, where the rate of a length has no value.
void damper(Elaboration& e, const syntax::DamperStatement& s, Span span) {
  const std::optional<ExprVector> r = between(e, Link::Kind::Damper, *s.from, *s.to);
  const Value c = scalar_of(e, *s.coefficient, dimensions::force() / dimensions::velocity(), "a damping coefficient");
  check_positive(e, c, *s.coefficient, "this damping coefficient",
                 "Such a damper feeds energy in instead of taking it out.");
  if (!r || refuse_velocity_in_coefficient(e, c, *s.coefficient)) return;
  if (refuse_one_place(e, *r, *s.from, *s.to, "damper")) return;
  ExprVector rates;
  for (const Expr& component : *r) rates.push_back(e.context.time_derivative(component));
  const Expr length = sqrt(square_of(*r));
  const Expr rate = e.context.time_derivative(length.is(maupertuis::Kind::Abs) ? length[0] : length);
  const Expr square = keeps_direction(*r, rates) ? dot_of(rates, rates) : pow(rate, Rational(2));
  e.system().dissipation.push_back(
      {Rational(1, 2) * (c.scalar() * square), "damper " + pair_name(e, s.from, s.to), span});
}

void from_parts(Elaboration& e, Which which) {
  if (which == Which::T) kinetic_of_masses(e.system());
  for (const syntax::Statement& s : e.tree.statements) {
    if (which == Which::V) {
      if (const auto* g = std::get_if<syntax::GravityStatement>(&s.body)) gravity(e, *g, s.span);
      if (const auto* p = std::get_if<syntax::SpringStatement>(&s.body)) spring(e, *p, s.span);
      if (const auto* p = std::get_if<syntax::TorsionSpringStatement>(&s.body)) torsion_spring(e, *p, s.span);
    }
    if (which == Which::D)
      if (const auto* d = std::get_if<syntax::DamperStatement>(&s.body)) damper(e, *d, s.span);
  }
}

// ---------------------------------------------------------------------------------------------- what the text gives

/// Without the time L is the integrand of some action: its first part says of what dimension.
Value lagrangian_of_any_dimension(Elaboration& e, const syntax::Expression& x, const std::string& name) {
  if (e.lagrangian_settled) return scalar_of(e, x, e.system().lagrangian_dimension, name);
  const Value v = evaluate_formula(e, x);
  if (v.poisoned || v.fits_any) return v;
  if (v.is_vector) return scalar_of(e, x, v.dimension, name);  // says that it is a number
  e.system().lagrangian_dimension = v.dimension;
  e.lagrangian_settled = true;
  return v;
}

/// Whether L may hold the accelerations that stand in it; their coordinates are noted.
bool note_higher(Elaboration& e, const Value& v) {
  if (v.poisoned || v.is_vector || v.order < 2) return false;
  std::set<std::size_t> found;
  const Expr value = expand_time_derivatives(v.scalar());
  for (const Expr& symbol : symbols_of({&value, 1})) {
    if (symbol.order() < 2 || symbol.role() != Role::Coordinate) continue;
    const Coordinate* c = e.system().find_coordinate(symbol.name());
    if (symbol.order() > 2 || !c) return false;
    found.insert(static_cast<std::size_t>(c - e.system().coordinates.data()));
  }
  e.higher.insert(found.begin(), found.end());
  return true;
}

/// The value of a given energy, with what each of them may depend on; nothing after a mistake.
std::optional<Expr> given_value(Elaboration& e, const EnergyStatement& s) {
  const std::string name = fmt::format("the {}", name_of_energy(s.which));
  const bool any = s.which == Which::L && !e.independent_is_time;
  const Value v =
      any ? lagrangian_of_any_dimension(e, *s.value, name) : scalar_of(e, *s.value, dimension_of(s.which), name);
  const bool higher = s.which == Which::L && note_higher(e, v);
  if (v.poisoned || (!higher && refuse_acceleration(e, v, *s.value, name))) return std::nullopt;
  if (s.which != Which::V || v.order < 1) return v.scalar();
  e.diagnostics.error("E0405", culprit_of_order(e, *s.value, 1), "a velocity stands in the potential energy V",
                      "A potential energy depends on positions (and perhaps on time); what depends on velocities is a "
                      "generalized potential or a friction.",
                      "Write `U = …` for a magnetic or similar force, `D = …` for friction.");
  return std::nullopt;
}

/// Whether points, bodies, springs or gravity give this energy already, so that `=` claims what it is.
bool given_by_parts(const MechanicalSystem& s, Which which) {
  if (which == Which::T) return !s.kinetic.empty();
  if (which == Which::V) return !s.potential.empty() || !s.gravity.empty();
  if (which == Which::D) return !s.dissipation.empty();
  return which == Which::L && (!s.kinetic.empty() || !s.potential.empty());
}

/// Energies that stand in the text as `T = …` do not make `L = …` a claim: only masses, springs and gravity do.
bool lagrangian_given_by_parts(const MechanicalSystem& s) {
  for (const auto* terms : {&s.kinetic, &s.potential})
    for (const EnergyTerm& term : *terms)
      if (term.origin != "T" && term.origin != "V") return true;
  return false;
}

void given_twice(Elaboration& e, const EnergyStatement& s, Span first) {
  e.diagnostics.error("E0207", s.name_span, fmt::format("the {} is given twice", name_of_energy(s.which)),
                      fmt::format("It is already given in line {}.", e.texts.locate(first).line),
                      fmt::format("Write `{} += …` to add to it.", e.texts.slice(s.name_span)));
}

void refuse_over_dampers(Elaboration& e, const EnergyStatement& s) {
  e.diagnostics.error("E0220", s.name_span, "the dissipation function is given beside dampers",
                      "Each damper gives its part of D.", "Write `D += …` to add to them.");
}

void place_value_of(Elaboration& e, const EnergyStatement& s, Expr value, bool claimed) {
  MechanicalSystem& system = e.system();
  const EnergyTerm term{value, std::string(1, "TVULD"[static_cast<int>(s.which)]), s.value->span};
  if (s.adds)
    terms_of(system, s.which).push_back(term);
  else if (claimed)
    system.claims.push_back({s.which, value, s.value->span});
  else if (s.which == Which::L)
    system.lagrangian_given = term;
  else
    terms_of(system, s.which).push_back(term);
}

Expr total(const MechanicalSystem& s, Which which) {
  switch (which) {
    case Which::T:
      return s.kinetic_energy();
    case Which::V:
      return s.potential_energy();
    case Which::U:
      return s.total_generalized_potential();
    case Which::D:
      return s.dissipation_function();
    case Which::L:
      break;
  }
  return s.lagrangian();
}

int order_of(Elaboration& e, Which which) {
  return which == Which::V ? 0 : which == Which::L && !e.higher.empty() ? 2 : 1;
}

}  // namespace

void elaborate_energy(Elaboration& e, Which which, Declaration& d) {
  from_parts(e, which);
  const bool by_parts = which == Which::L ? lagrangian_given_by_parts(e.system()) : given_by_parts(e.system(), which);
  std::optional<Span> first;
  bool poisoned = false;
  for (const syntax::Statement& statement : e.tree.statements) {
    const auto* s = std::get_if<EnergyStatement>(&statement.body);
    if (!s || s->which != which) continue;
    if (!s->adds && first) {
      given_twice(e, *s, *first);
      continue;
    }
    if (!s->adds) first = s->name_span;
    const std::optional<Expr> value = given_value(e, *s);
    poisoned = poisoned || !value;
    if (!value) continue;
    if (!s->adds && which == Which::D && by_parts)
      refuse_over_dampers(e, *s);
    else
      place_value_of(e, *s, *value, by_parts);
  }
  d.done = true;
  d.value = poisoned ? Value::poison()
                     : Value::of(total(e.system(), which),
                                 which == Which::L ? e.system().lagrangian_dimension : e.dimension(dimension_of(which)),
                                 order_of(e, which));
}

}  // namespace maupertuis::elaboration
