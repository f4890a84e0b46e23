#include "integrator/point/sample.hpp"

#include <limits>

namespace maupertuis {

void fill_sample(PointSolver& solver, FunctionWorkspace& observables, std::size_t count, Sample& sample) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const bool ok = solver.solve(sample.t, sample.q, sample.v) == PointStatus::Ok;
  sample.a.assign(solver.a().begin(), solver.a().end());
  sample.multipliers.assign(solver.lambda().begin(), solver.lambda().end());
  for (double& a : sample.a)
    if (!ok) a = nan;
  for (std::size_t k = 0; k < sample.multipliers.size(); ++k)
    if (!ok || !solver.determined(k)) sample.multipliers[k] = nan;
  sample.observables.resize(count);
  observables.evaluate(solver.point(), sample.observables);
}

}  // namespace maupertuis
