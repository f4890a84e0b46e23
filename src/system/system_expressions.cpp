#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

void for_each_expression(MechanicalSystem& s, const std::function<void(Expr&)>& visit) {
  const auto vector = [&](ExprVector& v) {
    for (Expr& x : v) visit(x);
  };
  const auto terms = [&](std::vector<EnergyTerm>& list) {
    for (EnergyTerm& t : list) visit(t.value);
  };
  for (Input& i : s.inputs) visit(i.formula);
  for (Rate& r : s.rates) visit(r.value);
  for (Definition& d : s.definitions) vector(d.components);
  for (Frame& f : s.frames) {
    vector(f.origin);
    vector(f.rotation.entries);
    vector(f.angular_velocity);
  }
  for (Point& p : s.points) {
    if (p.mass) visit(p.mass);
    vector(p.position);
  }
  for (Body& b : s.bodies) {
    if (b.mass) visit(b.mass);
    vector(b.inertia.entries);
    vector(b.position);
    vector(b.rotation.entries);
    vector(b.angular_velocity);
    vector(b.angular_velocity_world);
  }
  for (Link& l : s.links) {
    vector(l.from);
    vector(l.to);
  }
  vector(s.gravity);
  for (auto* list : {&s.kinetic, &s.potential, &s.generalized_potential, &s.dissipation, &s.lagrangian_extra})
    terms(*list);
  if (s.lagrangian_given) visit(s.lagrangian_given->value);
  for (EnergyClaim& c : s.claims) visit(c.value);
  for (AppliedForce& f : s.forces) {
    vector(f.components);
    vector(f.lever);
  }
  for (Constraint& c : s.constraints) visit(c.value);
  for (Gauge& g : s.gauges) visit(g.value);
  for (HigherDerivative& h : s.higher) visit(h.acceleration_momentum), visit(h.velocity_momentum);
  if (s.higher_lagrangian) visit(s.higher_lagrangian);
  const auto friction = [&](Friction& f) {
    vector(f.slip);
    for (Expr* x : {&f.kinetic, &f.static_, &f.normal})
      if (*x) visit(*x);
  };
  for (Contact& c : s.contacts) {
    visit(c.gap), visit(c.restitution);
    friction(c.friction);
  }
  for (Friction& f : s.frictions) friction(f);
  for (IntegralConstraint& c : s.integral_constraints)
    for (Expr* x : {&c.integrand, &c.value}) visit(*x);
}

namespace {

/// Symbols that formulas stand for, or that stand in formulas derived from them; and what is shown beside them.
void for_each_symbol(MechanicalSystem& s, const std::function<void(Expr&)>& visit) {
  const auto present = [&](Expr& e) {
    if (e) visit(e);
  };
  const auto friction = [&](Friction& f) {
    for (Expr& multiplier : f.multipliers) visit(multiplier);
  };
  for (Coordinate& c : s.coordinates)
    for (Expr* e : {&c.q, &c.velocity, &c.acceleration}) visit(*e);
  for (Parameter& p : s.parameters) visit(p.symbol), present(p.value);
  for (Input& i : s.inputs) visit(i.symbol);
  for (Rate& r : s.rates) present(r.symbol);
  for (Definition& d : s.definitions)
    for (Expr* e : {&d.symbol, &d.value, &d.formula}) present(*e);
  for (Constraint& c : s.constraints) present(c.multiplier), present(c.reaction);
  for (Release& r : s.releases) present(r.reaction);
  for (Contact& c : s.contacts) present(c.multiplier), present(c.reaction), friction(c.friction);
  for (Friction& f : s.frictions) friction(f);
}

}  // namespace

MechanicalSystem in_own_context(const MechanicalSystem& system, std::span<std::vector<Expr>* const> along) {
  MechanicalSystem out = system;
  out.written = nullptr;
  out.context = std::make_shared<Context>();
  Expr time = system.context->time();
  std::vector<Expr*> places{&time};
  const auto collect = [&](Expr& e) {
    if (e) places.push_back(&e);
  };
  for_each_symbol(out, collect);
  for_each_expression(out, collect);
  for (std::vector<Expr>* list : along)
    for (Expr& e : *list) collect(e);
  ExprVector roots;
  for (const Expr* place : places) roots.push_back(*place);
  // In the order of their making, which is the order of terms in sums.
  std::unordered_map<NodeId, Expr> copies;
  std::vector<Expr> arguments;
  for (const Expr& e : topological_order(roots)) {
    arguments.clear();
    for (const NodeId id : e.argument_ids()) arguments.push_back(copies.at(id));
    copies[e.id()] = e.is_number()    ? out.context->number(e.number())
                     : e.is(Kind::Pi) ? out.context->pi()
                     : e.is_symbol()  ? out.context->symbol(e.name(), e.role(), e.order())
                                      : out.context->make(e.kind(), arguments);
  }
  for (Expr* place : places) *place = copies.at(place->id());
  return out;
}

}  // namespace maupertuis
