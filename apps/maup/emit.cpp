#include "emit.hpp"

#include <fmt/format.h>

#include <maupertuis/kernel.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis::app {
namespace {

class Listing {
 public:
  explicit Listing(const ReadingOrder& order) : order_(order) {}
  void section(const std::string& head) { text_ += head + "\n"; }
  void line(const std::string& name, const std::string& text) { text_ += fmt::format("  {} = {}\n", name, text); }
  void line(const std::string& name, Expr e) { line(name, plain(e)); }
  void line(const std::string& name, const ExprVector& v) {
    std::vector<std::string> parts;
    for (const Expr e : v) parts.push_back(plain(e));
    line(name, fmt::format("({})", fmt::join(parts, ", ")));
  }
  std::string take() { return std::move(text_); }

 private:
  std::string plain(Expr e) const { return e ? to_plain(expand_time_derivatives(e), order_) : std::string("-"); }

  ReadingOrder order_;
  std::string text_;
};

std::string emit_system(const MechanicalSystem& system) {
  Listing out(reading_order(system));
  out.section(fmt::format("system {} ({}-dimensional)", system.name, system.space_dimension));
  for (const Coordinate& c : system.coordinates) out.line("coord " + c.name, to_string(c.dimension));
  for (const Parameter& p : system.parameters)
    out.line("param " + p.name, fmt::format("{:.17g} {}", p.si_value, to_string(p.dimension)));
  for (const Definition& d : system.definitions) {
    if (d.is_vector) out.line("let " + d.name, d.components);
    else out.line("let " + d.name, d.value);
  }
  for (const Input& u : system.inputs) out.line("input " + u.name, u.formula);
  for (const Point& p : system.points) out.line("point " + p.name, p.position);
  for (const Body& b : system.bodies) {
    out.line("body " + b.name, b.position);
    out.line(b.name + ".ω", b.angular_velocity);
  }
  const auto energy = [&out](const char* name, const std::vector<EnergyTerm>& terms) {
    for (const EnergyTerm& term : terms) out.line(fmt::format("{} [{}]", name, term.origin), term.value);
  };
  energy("T", system.kinetic);
  energy("V", system.potential);
  energy("U", system.generalized_potential);
  energy("D", system.dissipation);
  energy("L +", system.lagrangian_extra);
  out.line("L", system.lagrangian());
  const ExprVector forces = system.generalized_forces();
  for (std::size_t i = 0; i < forces.size(); ++i) out.line("Q[" + system.coordinates[i].name + "]", forces[i]);
  return out.take();
}

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
  if (stage == "system") return study.model() ? emit_system(study.model()->system) : std::string();
  if (!study.equations()) return {};
  if (stage == "equations") return emit_equations(*study.equations());
  if (stage == "program") return kernel_of(*study.equations()).print();
  if (stage == "jet") return emit_jet(*study.model(), *study.equations());
  return {};
}

}  // namespace maupertuis::app
