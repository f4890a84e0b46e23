#pragma once
#include "../model_text.hpp"
#include "simulation/function_kernels.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/variational.hpp>

#include <cmath>

/// A model with its variational functions; the integrands are the power, as in a run.
struct Variational : ModelText {
  explicit Variational(const std::string& text, std::vector<maupertuis::Expr> observables = {})
      : ModelText(text),
        functions(maupertuis::variational_functions(equations, {observables, {}, {equations.power}})),
        parameters(maupertuis::parameter_values(*system)) {}

  maupertuis::VariationalStepper stepper(double step, int order) const {
    maupertuis::VariationalOptions options;
    options.step = step, options.order = order;
    return {functions, parameters, options};
  }

  double value(maupertuis::Expr e, double t, std::span<const double> q, std::span<const double> v) const {
    maupertuis::Bindings bindings;
    for (const auto& p : system->parameters) bindings.emplace(p.symbol, p.si_value);
    bindings.emplace(system->context->time(), t);
    for (std::size_t i = 0; i < q.size(); ++i) {
      bindings.emplace(system->coordinates[i].q, q[i]);
      bindings.emplace(system->coordinates[i].velocity, v[i]);
    }
    return maupertuis::evaluate(maupertuis::expand_time_derivatives(e), bindings);
  }
  double energy(const maupertuis::VariationalStepper& s) const {
    return value(equations.energy_function, s.time(), s.q(), s.v());
  }

  maupertuis::VariationalFunctions functions;
  std::vector<double> parameters;
};

inline void run(maupertuis::VariationalStepper& stepper, double end) {
  while (stepper.time() != end) {
    const maupertuis::Step step = stepper.step(end);
    INFO(step.reason);
    REQUIRE(step.ending == maupertuis::StepEnding::None);
  }
}
