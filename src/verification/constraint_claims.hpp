#pragma once
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// expect freedoms = 2: freedoms of configuration.
void decide_freedoms(double expected, const ConstraintAnalysis& found, ExpectationResult& result);

/// expect constraint roll is nonholonomic. One that is holonomic in disguise is holonomic, and integrable.
void decide_class(const expectation::ConstraintClass& e, const MechanicalSystem& system,
                  const ConstraintAnalysis& found, ExpectationResult& result);

}  // namespace maupertuis
