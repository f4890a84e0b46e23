#pragma once
#include "integrator/point/point_solver.hpp"

#include <maupertuis/step.hpp>

namespace maupertuis {

/// Accelerations, multipliers and observables at (t, q, v) of a sample; NaN where they have no value.
void fill_sample(PointSolver& solver, FunctionWorkspace& observables, std::size_t count, Sample& sample);

}  // namespace maupertuis
