#pragma once
#include <maupertuis/report.hpp>

namespace maupertuis {

/// The paths between the model's ends on which S is stationary, with their index, and pictures of them and of S next to
/// the first.
void add_action(ReportContent& content, const MechanicalSystem& system, const PathSearch& search);

}  // namespace maupertuis
