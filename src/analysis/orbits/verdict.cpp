#include "analysis/orbits/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::orbits {
namespace {

constexpr double rounding = 1e-14;
/// Of dΦ_T: some 1e-13 after hundreds of steps.
constexpr double largest_sound_error = 1e-10;
/// Divergence over a period that is none.
constexpr double no_divergence = 1e-12;

bool misses_geometry(const FloquetResult& r) { return !(r.error.value_or(0) <= largest_sound_error); }

/// Multipliers of a Lagrangian motion come in pairs μ, 1/μ, and so do those of forces that could have been one: pairs
/// that meet on the circle may be defective, and then an error ε shows as √ε.
bool has_pairs(const FloquetResult& r) {
  return r.symplectic_residual || (r.integrated_divergence && std::abs(*r.integrated_divergence) <= no_divergence);
}

/// All multipliers but the trivial ones can lie inside the circle only if their product does.
bool may_attract(const FloquetResult& r, double width) {
  if (r.symplectic_residual) return false;
  if (!r.integrated_divergence) return true;
  const auto others = static_cast<double>(r.multipliers.size() - r.trivial);
  return *r.integrated_divergence <= others * std::log1p(-width);
}

}  // namespace

double width_of_circle(const FloquetResult& result) {
  const double error = std::max({result.motion.closure, result.error.value_or(0), rounding});
  const double width = has_pairs(result) ? std::max(1e-6, 10 * std::sqrt(error)) : std::max(1e-9, 1e3 * error);
  return std::min(width, 0.5);
}

OrbitalStability stability_of(const FloquetResult& result) {
  if (result.multipliers.size() == result.trivial)
    return result.vanished > 0 ? OrbitalStability::Attracting : OrbitalStability::Neutral;
  const double width = width_of_circle(result);
  if (result.largest > 1 + width) return OrbitalStability::Unstable;
  if (misses_geometry(result)) return OrbitalStability::Undecided;
  if (!(result.largest < 1 - width)) return OrbitalStability::Neutral;
  return may_attract(result, width) ? OrbitalStability::Attracting : OrbitalStability::Undecided;
}

void warn_of_error(const FloquetResult& result, Diagnostics& diagnostics) {
  if (!misses_geometry(result)) return;
  diagnostics.warning(
      "W1402", {}, fmt::format("the derivative of the return map is right to {:.2g} only", *result.error),
      result.symplectic_residual
          ? "The motion of a Lagrangian preserves the symplectic form, and this derivative does not."
          : "Its determinant is not what the divergence of the flow makes it (Liouville).",
      "Look for a motion of shorter period, or one that passes less near to a singularity; multipliers near the unit "
      "circle are not told from it here.");
}

}  // namespace maupertuis::orbits
