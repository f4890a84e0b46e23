#include "simulation/rounded_numbers.hpp"

#include "simulation/literals.hpp"
#include "simulation/motion_kernel.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/rounded_constants.hpp>
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

  /// In [1, 2), of all digits.
  double factor() { return 1 + std::ldexp(static_cast<double>(random_() >> 12), -52); }

 private:
  std::mt19937_64 random_;
};

}  // namespace

RoundedNumbers::RoundedNumbers(const Model& model, const EquationsOfMotion& equations, const RunPlan& plan,
                               const WantedFunctions& wanted)
    : has_modes_(goes_through_modes(model)) {
  for (const Parameter& p : equations.system->parameters) {
    parameters_.push_back({p.si_value, is_rounded(p.value, p.si_value)});
    symbols_.push_back(p.symbol);
  }
  if (!has_modes_) {  // else each mode has a kernel of its own
    KernelSource source =
        motion_source(equations, {wanted.observables, plan.until ? wanted.events : std::vector<Expr>{}, {}});
    Context& context = *equations.system->context;
    const Expr factor = context.symbol("factor of equations", Role::Parameter);
    if (source.residual.size() > 1 && source.constraints.empty())  // else λ would have it, too
      for (Expr& row : source.residual) row = factor * row;
    source.parameters.push_back(factor);
    source.parameters.push_back(context.symbol("rounding of constants", Role::Parameter));
    kernel_ = with_rounded_constants(build_kernel(source), source.parameters.size() - 1);
  }
  take_start(model, plan);
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
    if (rounded_value(formula, bindings) != number.value) {  // brought onto the constraints
      number.rounded = true, number.given = false;
      continue;
    }
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
  if (!has_modes_) out.parameters.insert(out.parameters.end(), {nudge.factor(), static_cast<double>(seed)});
  const auto start = [&](const StartNumber& number) {
    if (!number.rounded) return number.value;
    return nudge(number.formula ? rounded_value(number.formula, bindings) : number.value);
  };
  for (const StartNumber& q : q_) out.q.push_back(start(q));
  for (const StartNumber& v : v_) out.v.push_back(start(v));
  return out;
}

}  // namespace maupertuis
