#include "report/orbits.hpp"

#include "report/notation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Finding = ReportContent::Finding;

std::string in(const MechanicalSystem& system, double value, const std::string& unit) {
  return quantity(value, system.dimensionless ? "" : unit);
}

std::string complex_text(std::complex<double> z) {
  if (z.imag() == 0) return short_number(z.real());
  return fmt::format("{} {} {} i", short_number(z.real()), z.imag() < 0 ? "−" : "+", short_number(std::abs(z.imag())));
}

std::string multiplier_text(const FloquetResult& r, std::size_t i) {
  if (i + r.lost + r.trivial >= r.multipliers.size()) return "0 to rounding";
  const bool below_numbers = r.log_smallest && r.multipliers[i] == 0.0;
  return below_numbers ? "exp(" + short_number(*r.log_smallest) + ")" : complex_text(r.multipliers[i]);
}

std::string stability_text(const FloquetResult& r) {
  const std::string factor = short_number(r.largest);
  if (r.stability == OrbitalStability::Unstable)
    return fmt::format("unstable: neighbours move away by a factor {} in each period", factor);
  constexpr double vanishing = 1e-13;  // of a contact that closes, or friction that sticks
  if (r.stability == OrbitalStability::Attracting && r.largest < vanishing)
    return "attracting: after a period neighbours are in the same motion";
  if (r.stability == OrbitalStability::Attracting)
    return fmt::format("attracting: neighbours come nearer by a factor {} in each period", factor);
  if (r.stability == OrbitalStability::Undecided)
    return "undecided: the multipliers contradict what the geometry of the motion asks of them";
  return "neutral: all multipliers lie on the unit circle";
}

Finding periodic_motion(const FloquetResult& r, const MechanicalSystem& system) {
  Finding out{"Periodic motion", {}, "", {}, {}};
  const auto add = [&out](std::string name, std::string value) {
    out.facts.emplace_back(std::move(name), std::move(value));
  };
  add("period", in(system, r.motion.period, "s"));
  add("closes to", short_number(r.motion.closure, 2) + " of its size");
  std::string multipliers;
  for (std::size_t i = 0; i + r.trivial < r.multipliers.size(); ++i)
    multipliers += (i ? ", " : "") + multiplier_text(r, i);
  if (r.trivial > 0)
    multipliers += fmt::format("{}1{}", multipliers.empty() ? "" : ", ", r.trivial == 2 ? " twice" : "");
  add("Floquet multipliers", multipliers);
  add("stability", stability_text(r));
  if (r.symplectic_residual)
    add("symplectic form preserved to", short_number(*r.symplectic_residual, 2));
  else if (r.log_determinant)
    add("log |det dΦ| and ∫ divergence dt",
        fmt::format("{} and {}", short_number(*r.log_determinant, 9), short_number(*r.integrated_divergence, 9)));
  return out;
}

Finding section_finding(const SectionResult& r, const std::string& what, const MechanicalSystem& system) {
  Finding out{"Poincaré section", {}, what, section_rows(r, system), section_picture(r, what, system)};
  out.picture.title.clear();
  const std::size_t motions = r.orbits.size();
  out.facts.emplace_back("points",
                         fmt::format("{} of {} motion{}", r.crossings.size(), motions, motions == 1 ? "" : "s"));
  if (!r.energy_conserved) return out;
  double drift = 0;
  for (const SectionOrbit& o : r.orbits) drift = std::max(drift, o.energy_drift);
  out.facts.emplace_back("energy", in(system, r.orbits.front().energy, "J"));
  out.facts.emplace_back("energy drift", short_number(drift, 2));
  return out;
}

Finding exponents(const LyapunovResult& r, const MechanicalSystem& system) {
  Finding out{"Lyapunov exponents", {}, "the averages up to t", lyapunov_rows(r, system), {}};
  const std::string unit = system.dimensionless ? "" : " 1/s";
  for (std::size_t j = 0; j < r.exponents.size(); ++j)
    out.facts.emplace_back(fmt::format("λ{}", j + 1), fmt::format("{} ± {}{}", short_number(r.exponents[j], 4),
                                                                  short_number(r.errors[j], 2), unit));
  if (r.expected_sum)
    out.facts.emplace_back("sum; mean divergence",
                           fmt::format("{}; {}{}", short_number(r.sum, 3), short_number(*r.expected_sum, 3), unit));
  if (r.kaplan_yorke) out.facts.emplace_back("Kaplan-Yorke dimension", short_number(*r.kaplan_yorke, 4));
  return out;
}

}  // namespace

std::string picture_title(const MechanicalSystem& system, const std::string& what) {
  const std::string& name = system.title.empty() ? system.name : system.title;
  return name.empty() ? what : name + ": " + what;
}

PlotOptions section_picture(const SectionResult& section, const std::string& what, const MechanicalSystem& system) {
  PlotOptions out;
  const std::string& name = system.coordinates[section.across].name;
  out.against = name;
  out.columns = {name + "'"};
  out.dots_by = "orbit";
  out.outline = section.outline;
  out.title = picture_title(system, what);
  if (section.energy_conserved)
    out.title += fmt::format(", E = {:.6g}{}", section.orbits.front().energy, system.dimensionless ? "" : " J");
  return out;
}

void add_orbits(ReportContent& content, const MechanicalSystem& system, const ReportParts& parts) {
  if (parts.floquet) content.orbits.push_back(periodic_motion(*parts.floquet, system));
  if (parts.section) content.orbits.push_back(section_finding(*parts.section, parts.section_what, system));
  if (parts.lyapunov) content.orbits.push_back(exponents(*parts.lyapunov, system));
}

}  // namespace maupertuis
