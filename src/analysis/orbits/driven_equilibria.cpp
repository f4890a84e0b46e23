#include <maupertuis/orbits.hpp>

#include <fmt/format.h>

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

}  // namespace

std::vector<std::optional<FloquetResult>> settle_driven(ModalStudy& study, const PointEquations& points,
                                                        const Model& model, const EquationsOfMotion& equations,
                                                        const StopFlag* interrupt) {
  std::vector<std::optional<FloquetResult>> out;
  if (points.autonomous()) return out;
  for (ModalEntry& entry : study.entries) {
    const OperatingPoint& at = entry.equilibrium.point;
    Diagnostics unheard;  // a drive without a period is no mistake here: the entry stays undecided
    std::optional<FloquetResult> found =
        floquet(model, equations, {std::nullopt, interrupt, MotionState{at.t, at.q, at.v}}, unheard);
    entry.analysis.modes.clear();
    entry.analysis.eigenvalues.clear();
    if (found && !found->motion.rests) found.reset();
    if (found) entry.analysis.stability = report_of(*found);
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace maupertuis
