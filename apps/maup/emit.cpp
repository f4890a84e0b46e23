#include "emit.hpp"

#include <fmt/format.h>

#include <maupertuis/kernel.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis::app {
namespace {

std::string emit_equations(const EquationsOfMotion& equations) {
  return "# nodes of the computational form; the last ones named are R, row by row\n" +
         to_dag_text(equations.residual);
}

Kernel kernel_of(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  KernelSource source;
  for (const Coordinate& c : system.coordinates) source.coordinates.push_back(c.q);
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.residual = in_terms_of_motion(system, equations.residual);
  return build_kernel(source);
}

/// The Taylor coefficients of the motion at its start, q(t0 + τ) = Σ q_k τ^k.
std::string emit_jet(const Model& model, const EquationsOfMotion& equations) {
  constexpr int order = 20;
  const MechanicalSystem& system = model.system;
  const Bindings parameters = parameter_bindings(system);
  std::vector<double> values;
  for (const Parameter& p : system.parameters) values.push_back(p.si_value);
  const auto value_of = [&](Expr e) { return evaluate(in_terms_of_motion(system, {&e, 1})[0], parameters); };
  const std::size_t n = system.coordinates.size();
  std::vector<double> q(n, 0.0), v(n, 0.0);
  for (const StartValue& start : model.experiment.start)
    (start.order == 0 ? q : v)[start.coordinate] = value_of(start.value);
  const double t = model.experiment.start_time ? value_of(model.experiment.start_time) : 0;

  const Kernel kernel = kernel_of(equations);
  KernelWorkspace work(kernel, order);
  work.set_parameters(values);
  const KernelStatus status = work.expand(t, q, v);
  if (status != KernelStatus::Ok) return "# no jet: the accelerations have no value at the start\n";
  std::string out = "# k";
  for (const Coordinate& c : system.coordinates) out += "  " + c.name;
  for (int k = 0; k <= order; ++k) {
    out += fmt::format("\n{}", k);
    for (std::size_t i = 0; i < n; ++i) out += fmt::format("  {:.17g}", work.coordinate(k)[i]);
  }
  return out + "\n";
}

}  // namespace

std::string emit(const std::string& stage, Study& study) {
  if (stage == "syntax") return study.tree() ? syntax::dump(*study.tree()) : std::string();
  if (stage == "system") return study.model() ? dump(study.model()->system) : std::string();
  if (!study.equations()) return {};
  if (stage == "equations") return emit_equations(*study.equations());
  if (stage == "program") return kernel_of(*study.equations()).print();
  if (stage == "jet") return emit_jet(*study.model(), *study.equations());
  return {};
}

}  // namespace maupertuis::app
