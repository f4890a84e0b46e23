#include <maupertuis/degenerate.hpp>
#include <maupertuis/interrupt.hpp>
#include <maupertuis/orbits.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

StabilityReport report_of(const FloquetResult& neighbours) {
  StabilityReport out;
  switch (neighbours.stability) {
    case OrbitalStability::Unstable:
      out.verdict = Stability::Unstable;
      out.reason = fmt::format("a Floquet multiplier has the modulus {:.6g}", neighbours.largest);
      break;
    case OrbitalStability::Attracting:
      out.verdict = Stability::Asymptotic;
      out.reason = fmt::format("all Floquet multipliers lie within the circle of radius {:.6g}", neighbours.largest);
      break;
    case OrbitalStability::Neutral:
      out.reason = "all Floquet multipliers lie on the unit circle: stable to first order";
      break;
    case OrbitalStability::Undecided:
      out.reason = "the Floquet multipliers contradict what the geometry of the motion asks of them";
  }
  return out;
}

/// Of a point that rests at all times; nothing where the drive does not repeat, which is no mistake here.
std::optional<FloquetResult> floquet_at_rest(const Model& model, const EquationsOfMotion& equations,
                                             const OperatingPoint& at, const StopFlag* interrupt) {
  Diagnostics unheard;
  auto found = floquet(model, equations, {std::nullopt, interrupt, MotionState{at.t, at.q, at.v}}, unheard);
  return found && found->motion.rests ? std::move(found) : std::nullopt;
}

std::vector<std::complex<double>> exponents(const FloquetResult& neighbours) {
  std::vector<std::complex<double>> out;
  for (const std::complex<double>& mu : neighbours.multipliers)
    if (mu != 0.0) out.push_back(std::log(mu) / neighbours.motion.period);
  std::sort(out.begin(), out.end(),
            [](auto a, auto b) { return std::pair(a.real(), a.imag()) < std::pair(b.real(), b.imag()); });
  return out;
}

/// Π (1 − μ) and Π (1 + μ).
std::vector<double> passes(const FloquetResult& neighbours) {
  std::complex<double> one = 1, minus_one = 1;
  for (const std::complex<double>& mu : neighbours.multipliers) one *= 1.0 - mu, minus_one *= 1.0 + mu;
  return {one.real(), minus_one.real()};
}

/// A model and equations whose parameter can be given values.
struct Tuned {
  Model model;
  EquationsOfMotion equations;

  Tuned(const Model& given, const EquationsOfMotion& solvable)
      : model(with_system_of(given, solvable)), equations(solvable) {}

  void set(std::size_t parameter, double value) {
    Parameter& p = model.system.parameters[parameter];
    p.value = model.system.context->number(Rational::from_double(value));
    p.si_value = value;
    equations.system = std::make_shared<const MechanicalSystem>(model.system);
  }

 private:
  static Model with_system_of(const Model& given, const EquationsOfMotion& solvable) {
    Model out = given;
    out.system = *solvable.system;
    return out;
  }
};

}  // namespace

std::vector<std::optional<FloquetResult>> settle_driven(ModalStudy& study, const PointEquations& points,
                                                        const Model& model, const EquationsOfMotion& equations,
                                                        const StopFlag* interrupt) {
  std::vector<std::optional<FloquetResult>> out;
  if (points.autonomous()) return out;
  for (ModalEntry& entry : study.entries) {
    std::optional<FloquetResult> found = floquet_at_rest(model, equations, entry.equilibrium.point, interrupt);
    entry.analysis.modes.clear();
    entry.analysis.eigenvalues.clear();
    if (found) entry.analysis.stability = report_of(*found);
    out.push_back(std::move(found));
  }
  return out;
}

NeighboursAt driven_neighbours(const Model& model, const EquationsOfMotion& equations, std::size_t parameter,
                               const StopFlag* interrupt) {
  const auto tuned = std::make_shared<Tuned>(model, solvable_equations(equations));
  return [tuned, parameter, interrupt](double value, const Equilibrium& x) -> std::optional<NeighboursInTime> {
    tuned->set(parameter, value);
    const auto found = floquet_at_rest(tuned->model, tuned->equations, x.point, interrupt);
    Interrupt(interrupt).throw_if_asked();
    if (!found) return std::nullopt;
    return NeighboursInTime{report_of(*found), exponents(*found), passes(*found)};
  };
}

}  // namespace maupertuis
