#pragma once
#include <maupertuis/invariants.hpp>

namespace maupertuis::invariants {

/// Runs the experiment of the model and fills ConservedFunction::drift: the largest change over 200 times, divided by
/// the largest root of the sum of the squares of its terms. W1004 where the run fails; nothing happens where the model
/// has no run.
void measure_drift(Invariants& result, const Model& model, const EquationsOfMotion& equations,
                   Diagnostics& diagnostics);

}  // namespace maupertuis::invariants
