#include "emit.hpp"

#include <fmt/format.h>

#include <maupertuis/kernel.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis::app {
namespace {

std::string emit_equations(const EquationsOfMotion& equations) {
  ExprVector roots = equations.residual;
  std::string heading = "# nodes of the computational form; the last ones named are R, row by row";
  if (equations.system->constrained()) {
    heading += ", then Aᵀλ, then A q'' − b";
    for (const ExprVector* part : {&equations.constraint_forces, &equations.constraint_accelerations})
      roots.insert(roots.end(), part->begin(), part->end());
  }
  return heading + "\n" + to_dag_text(roots);
}

/// The Taylor coefficients of the motion at its start, q(t0 + τ) = Σ q_k τ^k.
std::string emit_jet(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  constexpr int order = 20;
  const MechanicalSystem& system = model.system;
  std::vector<double> values;
  for (const Parameter& p : system.parameters) values.push_back(p.si_value);
  const std::size_t n = system.coordinates.size();
  const auto start = consistent_start(model, equations, diagnostics);
  if (!start) return {};
  const auto& [t, q, v] = start->state;

  const Kernel kernel = build_kernel(motion_source(equations));
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
  if (stage == "program") return build_kernel(motion_source(*study.equations())).print();
  if (stage == "jet") return emit_jet(*study.model(), *study.equations(), study.diagnostics());
  return {};
}

}  // namespace maupertuis::app
