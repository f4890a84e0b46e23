#include <maupertuis/higher_order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace maupertuis {

std::string written_name(const MechanicalSystem& system, std::size_t coordinate) {
  for (const HigherDerivative& h : system.higher) {
    if (h.momentum == coordinate) return {};
    if (h.rate == coordinate) return system.coordinates[h.coordinate].name + "'";
  }
  return system.coordinates[coordinate].name;
}
namespace {

const HigherDerivative* higher_of(const MechanicalSystem& system, std::size_t coordinate) {
  for (const HigherDerivative& h : system.higher)
    if (h.coordinate == coordinate) return &h;
  return nullptr;
}

/// v, v', v'', v''' → q', q'', q''', q''''.
ExprMap rates_as_derivatives(const MechanicalSystem& system) {
  ExprMap out;
  for (const HigherDerivative& h : system.higher)
    for (int order = 0; order <= 3; ++order)
      out.emplace(system.context->symbol(system.coordinates[h.rate].name, Role::Coordinate, order),
                  system.context->symbol(system.coordinates[h.coordinate].name, Role::Coordinate, order + 1));
  return out;
}

Expr derivative(Expr e) { return expand_time_derivatives(total_time_derivative(e)); }

/// −q'·∂D/∂q' + Q·q'
Expr power_of_forces(const EquationsOfMotion& equations, const HigherOrderForm& form) {
  Expr out = equations.system->context->number(0);
  for (const std::size_t i : form.coordinates)
    out = out + equations.system->coordinates[i].velocity *
                    (equations.generalized_forces[i] - equations.dissipative_terms[i]);
  return expand_time_derivatives(out);
}

/// ∂L/∂t of what stands explicitly, inputs included.
Expr explicit_rate(Expr lagrangian) {
  Expr out = differentiate(lagrangian, lagrangian.context().time());
  for (const Expr& s : symbols_of({&lagrangian, 1}))
    if (s.role() == Role::Input) out = out + differentiate(lagrangian, s) * s.context().time_derivative(s);
  return out;
}

Layout slope_of_lagrangian(Expr by, const ReadingOrder& order) {
  return layouts::partial(layouts::name("L"), lay_out(by, order));
}

/// The lines of one list, each in readable form.
class Lines {
 public:
  explicit Lines(const ReadingOrder& order) : order_(order) {}
  void add(const std::string& section, const std::string& rule, Layout left, Expr value) {
    const ReadableForm form = readable(value, order_);
    steps.push_back({section, rule, std::move(left), form.value, {}, form.intermediates});
  }
  std::vector<DerivationStep> steps;

 private:
  const ReadingOrder& order_;
};

}  // namespace

HigherOrderForm higher_order_form(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const Expr l = system.higher_lagrangian, zero = system.context->number(0);
  HigherOrderForm out;
  out.energy_function = -l;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    const bool added = std::any_of(system.higher.begin(), system.higher.end(),
                                   [&](const HigherDerivative& h) { return h.rate == i || h.momentum == i; });
    if (added) continue;
    out.coordinates.push_back(i);
    const HigherDerivative* h = higher_of(system, i);
    const Expr second = h ? h->acceleration_momentum : zero;
    const Expr first = h ? h->velocity_momentum : differentiate(l, c.velocity);
    out.momenta.push_back(first);
    out.acceleration_momenta.push_back(second);
    out.energy_function = out.energy_function + first * c.velocity + second * c.acceleration;
    out.residual.push_back(derivative(first) - differentiate(l, c.q) +
                           expand_time_derivatives(equations.dissipative_terms[i]) -
                           expand_time_derivatives(equations.generalized_forces[i]));
  }
  out.power = power_of_forces(equations, out) - explicit_rate(l);
  return out;
}

std::vector<HigherOrderProof> higher_order_proofs(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const HigherOrderForm form = higher_order_form(equations);
  const ExprMap as_derivatives = rates_as_derivatives(system);
  ExprVector rows;
  Expr work = derivative(form.energy_function) - form.power;
  for (std::size_t k = 0; k < form.coordinates.size(); ++k) {
    const std::size_t i = form.coordinates[k];
    Expr left = expand_time_derivatives(equations.residual[i]);
    if (const HigherDerivative* h = higher_of(system, i))
      left = left - derivative(expand_time_derivatives(equations.residual[h->rate]));
    rows.push_back(substitute(left, as_derivatives) - form.residual[k]);
    work = work - system.coordinates[i].velocity * form.residual[k];
  }
  return {{"higher_order", "R is what the equations of L* leave when q' takes the place of v and p is eliminated",
           zero_test(rows)},
          {"higher_power", "dh_E/dt = q'·R − ∂L/∂t − q'·∂D/∂q' + Q·q' along any path", zero_test(work)}};
}

std::vector<DerivationStep> higher_order_steps(const EquationsOfMotion& equations) {
  const EquationsOfMotion& shown = equations.shown();
  const MechanicalSystem& system = *shown.system;
  const HigherOrderForm form = higher_order_form(shown);
  const Expr l = system.higher_lagrangian;
  Lines out(shown.order);
  out.add("Lagrangian", "as given", layouts::name("L"), l);
  for (std::size_t k = 0; k < form.coordinates.size(); ++k) {
    const Coordinate& c = system.coordinates[form.coordinates[k]];
    const std::string section = "Equation of " + c.name;
    out.add(section, "partial derivative", slope_of_lagrangian(c.q, shown.order), differentiate(l, c.q));
    out.add(section, "partial derivative", slope_of_lagrangian(c.velocity, shown.order), differentiate(l, c.velocity));
    if (higher_of(system, form.coordinates[k]))
      out.add(section, "partial derivative", slope_of_lagrangian(c.acceleration, shown.order),
              form.acceleration_momenta[k]);
    out.add(section, "d/dt of ∂L/∂q' − d/dt ∂L/∂q'', less ∂L/∂q, with forces", layouts::number("0"), form.residual[k]);
  }
  return std::move(out.steps);
}

std::vector<DerivationStep> higher_order_lines(const EquationsOfMotion& equations) {
  const EquationsOfMotion& shown = equations.shown();
  const MechanicalSystem& system = *shown.system;
  const HigherOrderForm form = higher_order_form(shown);
  Lines out(shown.order);
  const std::string d = "d/d" + system.independent;
  for (std::size_t k = 0; k < form.coordinates.size(); ++k) {
    const Coordinate& c = system.coordinates[form.coordinates[k]];
    if (!higher_of(system, form.coordinates[k])) {
      out.add("Momenta", "∂L/∂" + c.name + "'", layouts::name("p_" + c.name), form.momenta[k]);
      continue;
    }
    out.add("Momenta", fmt::format("∂L/∂{0}' - {1} ∂L/∂{0}''", c.name, d), layouts::name("p1_" + c.name),
            form.momenta[k]);
    out.add("Momenta", fmt::format("∂L/∂{}''", c.name), layouts::name("p2_" + c.name), form.acceleration_momenta[k]);
  }
  out.add("Energy function", "Σ p1 q' + p2 q'' - L", layouts::name("h_E"), form.energy_function);
  const ZeroTest constant = zero_test(higher_order_form(equations).power);
  if (constant.verdict == Verdict::Zero)
    out.steps.push_back({"Energy function", {}, {}, {}, "It is conserved.", {}});
  else
    out.add("Energy function", "along the motion", layouts::name("dh_E/d" + system.independent), form.power);
  return std::move(out.steps);
}

}  // namespace maupertuis
