#pragma once
#include <maupertuis/diagram.hpp>
#include <maupertuis/locus.hpp>

#include <optional>

namespace maupertuis {

/// Each coordinate that is no translation against the parameter: drawn through where the equilibrium is stable, dashed
/// where it is unstable, dotted where the linearization does not decide; the changes are marked. One diagram a
/// coordinate (at most `most`).
std::vector<Diagram> bifurcation_diagrams(const MechanicalSystem& system, const Locus& locus, std::size_t most = 4);

/// All eigenvalues in the complex plane, a colour for each branch.
Diagram root_locus(const MechanicalSystem& system, const Locus& locus);

/// The parts of a mode shape, a line from zero for each coordinate: for systems that have no drawing.
Diagram shape_diagram(const MechanicalSystem& system, const Mode& mode);

}  // namespace maupertuis
