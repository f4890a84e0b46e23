#include "simulation/literals.hpp"

#include <maupertuis/simulation.hpp>
#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <set>

namespace maupertuis {

bool is_rounded(Expr exact, double value) {
  if (!std::isfinite(value)) return false;
  const Rational* const number = exact.number_or_null();
  return !number || *number != Rational::from_double(value);
}

std::vector<Expr> rounded_literals(const std::vector<Expr>& roots) {
  const std::vector<Expr> nodes = topological_order(roots);
  std::set<NodeId> exponents;
  for (const Expr& e : nodes)
    if (e.is(Kind::Power)) exponents.insert(e[1].id());
  std::vector<Expr> out;
  for (const Expr& e : nodes)
    if ((e.is(Kind::Pi) || (e.is_number() && is_rounded(e, e.number().to_double()))) && !exponents.count(e.id()))
      out.push_back(e);
  return out;
}

namespace {

void for_each_formula(Model& model, WantedFunctions& wanted, const std::function<void(Expr&)>& visit) {
  for_each_expression(model.system, visit);
  for (ModelEvent& e : model.experiment.events) {
    visit(e.function);
    for (ModelEvent::Assignment& a : e.sets) visit(a.value);
  }
  for (auto* list : {&wanted.observables, &wanted.events, &wanted.integrands})
    for (Expr& e : *list) visit(e);
}

}  // namespace

/// −0.3 is the parameter of 0.3 with its sign: feet at both stay in a line.
std::unique_ptr<const ModelOfLiterals> with_literals_as_parameters(const Model& model, const WantedFunctions& wanted) {
  constexpr std::size_t most_contacts = 64;
  if (!goes_through_modes(model) || model.system.contacts.size() > most_contacts) return nullptr;
  ModelOfLiterals out{model, {}, wanted};
  MechanicalSystem& system = out.model.system;
  system.written = nullptr;
  ExprVector formulas;
  for_each_formula(out.model, out.wanted, [&](Expr& e) {
    if (e) formulas.push_back(e);
  });
  Context& context = *system.context;
  ExprMap symbols;
  std::set<NodeId> known;
  for (const Expr& literal : rounded_literals(formulas)) {
    const bool pi = literal.is(Kind::Pi), negative = !pi && literal.number().to_double() < 0;
    const Expr size = negative ? context.number(abs(literal.number())) : literal;
    const std::string name = "literal " + (pi ? "π" : size.number().to_string());
    const Expr symbol = context.symbol(name, Role::Parameter);
    symbols.emplace(literal, negative ? -symbol : symbol);
    if (!known.insert(symbol.id()).second) continue;
    Parameter parameter;
    parameter.name = name;
    parameter.symbol = symbol;
    parameter.value = size;
    parameter.si_value = pi ? 3.14159265358979323846 : size.number().to_double();
    system.parameters.push_back(std::move(parameter));
  }
  if (symbols.empty()) return nullptr;
  for_each_formula(out.model, out.wanted, [&](Expr& e) {
    if (e) e = substitute(e, symbols);
  });
  Diagnostics unheard;  // the system passed its checks with its literals
  auto equations = euler_lagrange(std::make_shared<const MechanicalSystem>(system), unheard);
  if (!equations) return nullptr;
  out.equations = std::move(*equations);
  return std::make_unique<const ModelOfLiterals>(std::move(out));
}

}  // namespace maupertuis
