#include <maupertuis/degenerate.hpp>

#include <cmath>

namespace maupertuis {
namespace {

/// A number in (0, 1) that looks random and is the same in every run.
double scattered(std::size_t index) {
  const double x = static_cast<double>(index + 1) * 0.6180339887498949;
  return x - std::floor(x);
}

}  // namespace

Bindings generic_state(const Model& model) {
  const MechanicalSystem& system = model.system;
  Bindings out;
  for (const Parameter& p : system.parameters) out[p.symbol] = p.si_value;
  out[system.context->time()] = 0.3;
  const Bindings parameters = out;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    out[system.coordinates[i].q] = 0.4 + 0.8 * scattered(2 * i);
    out[system.coordinates[i].velocity] = 0.4 + 0.8 * scattered(2 * i + 1);
  }
  for (const StartValue& v : model.experiment.start) {
    const double value = evaluate(v.value, parameters);
    const Coordinate& c = system.coordinates[v.coordinate];
    if (value != 0 && std::isfinite(value)) out[v.order == 0 ? c.q : c.velocity] = value;
  }
  return out;
}

}  // namespace maupertuis
