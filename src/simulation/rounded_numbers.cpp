#include "simulation/rounded_numbers.hpp"

#include "simulation/literals.hpp"
#include "simulation/motion_kernel.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/rounded_value.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace maupertuis {
namespace {

/// Up or down by one unit in the last place.
class Nudge {
 public:
  explicit Nudge(std::uint64_t seed) : random_(seed) {}
  double operator()(double value) {
    const double direction = (random_() >> 63) != 0 ? 1 : -1;
    return value == 0 ? value : std::nextafter(value, direction * std::numeric_limits<double>::infinity());
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace

RoundedNumbers::RoundedNumbers(const Model& model, const EquationsOfMotion& equations, const RunPlan& plan,
                               const WantedFunctions& wanted) {
  for (const Parameter& p : equations.system->parameters) {
    parameters_.push_back({p.si_value, is_rounded(p.value, p.si_value)});
    symbols_.push_back(p.symbol);
  }
  if (!goes_through_modes(model)) {  // else each mode has a kernel of its own
    KernelSource source =
        motion_source(equations, {wanted.observables, plan.until ? wanted.events : std::vector<Expr>{}, {}});
    take_literals(source);
    kernel_ = build_kernel(source);
  }
  take_start(model, plan);
}

void RoundedNumbers::take_literals(KernelSource& source) {
  std::vector<Expr> roots = source.residual;
  for (const auto* list : {&source.observables, &source.events}) roots.insert(roots.end(), list->begin(), list->end());
  for (const KernelConstraint& c : source.constraints) roots.push_back(c.value);
  ExprMap symbols;
  for (const Expr& literal : rounded_literals(roots)) {
    const bool pi = literal.is(Kind::Pi);
    const Expr symbol =
        literal.context().symbol("literal " + (pi ? "π" : literal.number().to_string()), Role::Parameter);
    symbols.emplace(literal, symbol);
    source.parameters.push_back(symbol);
    parameters_.push_back({pi ? 3.14159265358979323846 : literal.number().to_double(), true});
  }
  if (symbols.empty()) return;
  for (auto* list : {&source.residual, &source.observables, &source.events}) *list = substitute(*list, symbols);
  for (KernelConstraint& c : source.constraints) c.value = substitute(c.value, symbols);
}

void RoundedNumbers::take_start(const Model& model, const RunPlan& plan) {
  const MechanicalSystem& system = model.system;
  const bool moved = system.constrained() || !model.experiment.start_conditions.empty();
  ExprMap values;
  for (const Parameter& p : system.parameters) values[p.symbol] = p.value;
  values[system.context->time()] = system.context->number(0);
  const Bindings bindings = parameter_bindings(system);
  for (const double q : plan.q) q_.push_back({q, moved, !moved, {}});
  for (const double v : plan.v) v_.push_back({v, moved, !moved, {}});
  for (const StartValue& start : model.experiment.start) {
    StartNumber& number = (start.order == 0 ? q_ : v_)[start.coordinate];
    const Expr formula = in_terms_of_motion(system, {&start.value, 1}).front();
    if (moved && rounded_value(formula, bindings) != number.value) continue;  // brought onto the constraints
    number.given = true;
    number.rounded = is_rounded(substitute(formula, values), number.value);
    if (number.rounded && !moved) number.formula = formula;
  }
}

RoundedNumbers::Draw RoundedNumbers::draw(std::uint64_t seed) const {
  Nudge nudge(seed);
  Draw out;
  for (const Value& p : parameters_) out.parameters.push_back(p.rounded ? nudge(p.value) : p.value);
  Bindings bindings;
  for (std::size_t i = 0; i < symbols_.size(); ++i) bindings.emplace(symbols_[i], out.parameters[i]);
  const auto start = [&](const StartNumber& number) {
    if (!number.rounded) return number.value;
    return nudge(number.formula ? rounded_value(number.formula, bindings) : number.value);
  };
  for (const StartNumber& q : q_) out.q.push_back(start(q));
  for (const StartNumber& v : v_) out.v.push_back(start(v));
  return out;
}

}  // namespace maupertuis
