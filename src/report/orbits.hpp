#pragma once
#include <maupertuis/report.hpp>

namespace maupertuis {

/// Periodic motion, section and exponents of `parts`, as facts and pictures.
void add_orbits(ReportContent& content, const MechanicalSystem& system, const ReportParts& parts);

}  // namespace maupertuis
