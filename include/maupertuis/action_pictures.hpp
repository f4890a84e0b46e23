#pragma once
#include <maupertuis/action.hpp>
#include <maupertuis/diagram.hpp>

namespace maupertuis {

/// S on neighbours q + ε ξ against ε, a curve for each family: parabolas without a slope where the path is stationary.
Diagram neighbours_diagram(const MechanicalSystem& system, const std::vector<TestVariation>& variations);

/// The paths, a colour each: the one coordinate against the independent variable, or the second coordinate against the
/// first where both are lengths; conjugate points are marked.
Diagram paths_diagram(const MechanicalSystem& system, const std::vector<const StationaryPath*>& paths);

}  // namespace maupertuis
