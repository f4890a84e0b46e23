#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// A number in (0, 1) that looks random and is the same in every run.
double scattered(std::size_t index) {
  const double x = static_cast<double>(index + 1) * 0.6180339887498949;
  return x - std::floor(x);
}

/// The start; what is not given, or is 0, lies up to `size` away from 0.
Bindings near_start(const Model& model, double size) {
  const MechanicalSystem& system = model.system;
  Bindings out;
  for (const Parameter& p : system.parameters) out[p.symbol] = p.si_value;
  out[system.context->time()] = 0.3;
  const Bindings parameters = out;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    out[system.coordinates[i].q] = size * (0.4 + 0.8 * scattered(2 * i));
    out[system.coordinates[i].velocity] = size * (0.4 + 0.8 * scattered(2 * i + 1));
  }
  for (const StartValue& v : model.experiment.start) {
    const double value = evaluate(v.value, parameters);
    const Coordinate& c = system.coordinates[v.coordinate];
    if (value != 0 && std::isfinite(value)) out[v.order == 0 ? c.q : c.velocity] = value;
  }
  return out;
}

}  // namespace

Bindings written_start(const Model& model) {
  Bindings out = near_start(model, 0);
  out[model.system.context->time()] = 0;
  return out;
}

Bindings start_on_constraints(const Model& model, const EquationsOfMotion& equations) {
  const DegenerateAnalysis* found = equations.degenerate.get();
  return found && found->start ? *found->start : written_start(model);
}

Bindings generic_state(const Model& model) {
  const MechanicalSystem& system = model.system;
  const Expr whole = system.lagrangian();
  ExprVector wanted{expand_time_derivatives(in_terms_of_motion(system, {&whole, 1}).front())};
  for (const Coordinate& c : system.coordinates) wanted.push_back(differentiate(wanted.front(), c.velocity));
  // As far from special values as L allows: a particle slower than light stays so.
  constexpr double least = 1.0 / 1024;
  for (double size = 1; size >= least; size /= 2) {
    Bindings state = near_start(model, size);
    const std::vector<double> values = evaluate(wanted, state);
    if (std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) return state;
  }
  return near_start(model, 1);
}

}  // namespace maupertuis
