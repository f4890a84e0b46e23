#include <maupertuis/momentum.hpp>
#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

#include "system/elaboration.hpp"

#include <algorithm>
#include <functional>

/// Formulas are elaborated with the symbols of definitions in them (`I φ'^2`). What is computed with has their values
/// instead; the system as written is kept beside it for readable forms.
namespace maupertuis::elaboration {
namespace {

/// Calls `visit` on every expression of an expectation.
struct ExpectationVisitor {
  const std::function<void(Expr&)>& visit;
  const std::function<void(std::vector<StartValue>&)>& visit_starts;

  void present(Expr& e) const {
    if (e) visit(e);
  }
  void all(std::vector<Expr>& list) const {
    for (Expr& e : list) visit(e);
  }
  void starts(std::vector<StartValue>& list) const {
    visit_starts(list);
    for (StartValue& s : list) visit(s.value);
  }
  void number(expectation::Number& n) const { visit(n.value), present(n.tolerance.size); }
  void spectrum(expectation::Spectrum& s) const { all(s.real), all(s.imaginary), present(s.tolerance.size); }
  void path(PathFormulas& p) const { all(p.q), present(p.from), present(p.to); }

  void operator()(expectation::ValueAt& x) const { visit(x.subject), present(x.time), number(x.expected); }
  void operator()(expectation::ValueAtUntil& x) const { visit(x.subject), number(x.expected); }
  void operator()(expectation::UntilAt& x) const { number(x.expected); }
  void operator()(expectation::EnergyConserved& x) const { present(x.tolerance.size); }
  void operator()(expectation::ConservedAlongRun& x) const { visit(x.subject), present(x.tolerance.size); }
  void operator()(expectation::Conserved& x) const { visit(x.subject), all(x.where); }
  void operator()(expectation::NotConserved& x) const { visit(x.subject); }
  void operator()(expectation::Integral& x) const { visit(x.subject); }
  void operator()(expectation::Equation& x) const { visit(x.left), visit(x.right); }
  void operator()(expectation::Hamiltonian& x) const { visit(x.value); }
  void operator()(expectation::Routhian& x) const { visit(x.value); }
  void operator()(expectation::Bracket& x) const { visit(x.a), visit(x.b), visit(x.value); }
  void operator()(expectation::PhaseConstraints& x) const {
    for (std::vector<Expr>& generation : x.generations) all(generation);
  }
  void operator()(expectation::ClassCount& x) const { visit(x.number); }
  void operator()(expectation::Freedoms& x) const { visit(x.number); }
  void operator()(expectation::ConstraintClass&) const {}
  void operator()(expectation::Frequencies& x) const { starts(x.at), all(x.values), present(x.tolerance.size); }
  void operator()(expectation::Eigenvalues& x) const { starts(x.at), spectrum(x.expected); }
  void operator()(expectation::Matrix& x) const { starts(x.at), all(x.entries), present(x.tolerance.size); }
  void operator()(expectation::Equilibrium& x) const {
    for (expectation::Place& place : x.at) {
      visit(place.value.value);
      if (place.tolerance) present(place.tolerance->size);
    }
  }
  void operator()(expectation::Stable& x) const { number(x.critical), starts(x.at); }
  void operator()(expectation::Multipliers& x) const { present(x.over), spectrum(x.expected); }
  void operator()(expectation::Trace& x) const { present(x.over), number(x.expected); }
  void operator()(expectation::Period& x) const { present(x.over), number(x.expected); }
  void operator()(expectation::Action& x) const { number(x.expected); }
  void operator()(expectation::ActionAlong& x) const { path(x.along), number(x.expected); }
  void operator()(expectation::MorseIndex& x) const { visit(x.index); }
  void operator()(expectation::PathAt& x) const { visit(x.subject), visit(x.time), number(x.expected); }
  void operator()(expectation::Event& x) const { number(x.time); }
  void operator()(expectation::EventCount& x) const { visit(x.number); }
  void operator()(expectation::Error&) const {}
};

}  // namespace

void visit_experiment(Experiment& x, const std::function<void(Expr&)>& visit,
                      const std::function<void(std::vector<StartValue>&)>& starts) {
  const ExpectationVisitor of_expectation{visit, starts};
  const auto present = [&](Expr& e) {
    if (e) visit(e);
  };
  for (auto* list : {&x.start, &x.at}) of_expectation.starts(*list);
  if (x.path) {
    for (ExprVector* end : {&x.path->from, &x.path->to, &x.path->from_rates, &x.path->to_rates})
      for (Expr& component : *end) present(component);
    for (Expr* e : {&x.path->start, &x.path->end}) visit(*e);
  }
  if (x.sweep)
    for (Expr* e : {&x.sweep->from, &x.sweep->to}) visit(*e);
  for (StartCondition& r : x.start_conditions)
    for (Expr* e : {&r.formula, &r.value}) visit(*e);
  for (Expr* e : {&x.start_time, &x.duration, &x.until, &x.within, &x.output_every}) present(*e);
  if (x.method) present(x.method->step);
  for (ModelEvent& event : x.events) {
    visit(event.function);
    for (ModelEvent::Assignment& a : event.sets) visit(a.value);
  }
  for (DrawElement& d : x.drawing) {
    for (ExprVector& p : d.path)
      for (Expr& e : p) visit(e);
    for (Expr& e : d.sizes) visit(e);
    for (Expr& e : d.direction) visit(e);
  }
  for (Expectation& p : x.expectations) std::visit(of_expectation, p.kind);
  for (AskedFormula& f : x.asked) visit(f.value);
  present(x.section);
  if (x.given_path) of_expectation.path(*x.given_path);
}

namespace {

void for_each_expression(Experiment& x, const std::function<void(Expr&)>& visit) {
  visit_experiment(x, visit, [](std::vector<StartValue>&) {});
}

}  // namespace

void replace_momenta(Model& model) {
  const MechanicalSystem& s = model.system;
  ExprVector read;
  const auto visit_conditions = [&](const std::function<void(Expr&)>& visit) {
    Experiment& x = model.experiment;
    for (ModelEvent& event : x.events) visit(event.function);
    for (Expr* e : {&x.until, &x.section})
      if (*e) visit(*e);
    for (Friction& f : model.system.frictions)
      if (f.normal) visit(f.normal);
  };
  visit_conditions([&](Expr& e) { read.push_back(e); });
  const std::vector<Expr> symbols = symbols_of(read);
  ExprMap momenta;
  for (std::size_t i = 0; i < s.coordinates.size(); ++i)
    if (const Expr p = momentum_symbol(s, i); std::find(symbols.begin(), symbols.end(), p) != symbols.end())
      momenta.emplace(p, differentiate(expand_time_derivatives(s.lagrangian()), s.coordinates[i].velocity));
  if (!momenta.empty()) visit_conditions([&](Expr& e) { e = substitute(e, momenta); });
}

namespace {

/// g for g^r with r = 1/2, 3/2, …, which vanishes where g does; 1 − g for acos g: of the same sign, in factors of a
/// product and in branches of a piecewise formula too. One that rises or falls stays so where g is never negative, as
/// x² + y² is.
Expr without_root(Expr f, int direction) {
  using maupertuis::Kind;
  const auto parts = [&](std::size_t first, std::size_t step) {
    std::vector<Expr> out;
    for (std::size_t i = 0; i < f.size(); ++i)
      out.push_back(i >= first && (i - first) % step == 0 ? without_root(f[i], direction) : f[i]);
    return out;
  };
  if (f.is(Kind::Product)) return f.context().product(parts(0, 1));
  if (f.is(Kind::Piecewise)) {
    std::vector<Expr> branches = parts(1, 2);
    branches.back() = without_root(f[f.size() - 1], direction);
    return f.context().function(Kind::Piecewise, branches);
  }
  if (f.is(Kind::Acos) && direction == 0) return -f[0] + Rational(1);
  const Rational* exponent = f.is(Kind::Power) ? f[1].number_or_null() : nullptr;
  const bool is_root = exponent && exponent->sign() > 0 && !exponent->is_integer();
  return is_root && (direction == 0 || is_never_negative(f[0])) ? f[0] : f;
}

}  // namespace

void take_roots_off_conditions(Experiment& x) {
  for (ModelEvent& event : x.events) event.function = without_root(event.function, event.direction);
  if (x.until) x.until = without_root(x.until, 0);
}

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
