#include "system/elaboration.hpp"

#include <functional>

/// Formulas are elaborated with the symbols of definitions in them (`I φ'^2`). What is computed with has their values
/// instead; the system as written is kept beside it for readable forms.
namespace maupertuis::elaboration {
namespace {

/// Calls `visit` on every expression of the system that the equations come from.
void for_each_expression(MechanicalSystem& s, const std::function<void(Expr&)>& visit) {
  const auto vector = [&](ExprVector& v) {
    for (Expr& x : v) visit(x);
  };
  const auto terms = [&](std::vector<EnergyTerm>& list) {
    for (EnergyTerm& t : list) visit(t.value);
  };
  for (Input& i : s.inputs) visit(i.formula);
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
  for (IntegralConstraint& c : s.integral_constraints)
    for (Expr* x : {&c.integrand, &c.value}) visit(*x);
}

void for_each_expression(Experiment& x, const std::function<void(Expr&)>& visit) {
  const auto present = [&](Expr& e) {
    if (e) visit(e);
  };
  const auto starts = [&](std::vector<StartValue>& list) {
    for (StartValue& s : list) visit(s.value);
  };
  starts(x.start);
  starts(x.at);
  if (x.path) {
    for (ExprVector* end : {&x.path->from, &x.path->to})
      for (Expr& component : *end) present(component);
    for (Expr* e : {&x.path->start, &x.path->end}) visit(*e);
  }
  if (x.sweep)
    for (Expr* e : {&x.sweep->from, &x.sweep->to}) visit(*e);
  for (StartRate& r : x.start_rates)
    for (Expr* e : {&r.rate, &r.value}) visit(*e);
  for (Expr* e : {&x.start_time, &x.duration, &x.until, &x.within, &x.output_every}) present(*e);
  if (x.method) present(x.method->step);
  for (DrawElement& d : x.drawing) {
    for (ExprVector& p : d.path)
      for (Expr& e : p) visit(e);
    for (Expr& e : d.sizes) visit(e);
    for (Expr& e : d.direction) visit(e);
  }
  for (Expectation& p : x.expectations) {
    for (Expr* e : {&p.subject, &p.subject_right, &p.time, &p.value, &p.tolerance, &p.from, &p.to}) present(*e);
    for (ExprVector* list : {&p.values, &p.imaginary, &p.where})
      for (Expr& e : *list) visit(e);
    for (PointTolerance& t : p.at_tolerances) present(t.size);
    starts(p.at);
  }
}

}  // namespace

void expand_definitions(Model& model) {
  const ExprMap values = model.system.definition_values();
  ExprVector all;
  const auto collect = [&](Expr& x) { all.push_back(x); };
  if (values.empty()) return;
  model.system.written = std::make_shared<const MechanicalSystem>(model.system);
  for_each_expression(model.system, collect);
  for_each_expression(model.experiment, collect);
  for (Definition& d : model.system.definitions)
    if (d.value) all.push_back(d.value);
  const ExprVector expanded = substitute(all, values);  // once: what is shared stays shared
  std::size_t next = 0;
  const auto replace = [&](Expr& x) { x = expanded[next++]; };
  for_each_expression(model.system, replace);
  for_each_expression(model.experiment, replace);
  for (Definition& d : model.system.definitions)
    if (d.value) d.value = expanded[next++];
}

}  // namespace maupertuis::elaboration
