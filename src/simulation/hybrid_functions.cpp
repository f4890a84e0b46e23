#include "simulation/hybrid_functions.hpp"

#include "simulation/hybrid_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::hybrid {
namespace {

/// At a point, with the parameters of the run; the workspace is made at the first call.
std::vector<double> values_at(const FunctionKernel& kernel, std::optional<FunctionWorkspace>& work,
                              std::span<const double> parameters, double t, std::span<const double> q,
                              std::span<const double> v) {
  if (!work) {
    work.emplace(kernel);
    work->set_parameters(parameters);
  }
  std::vector<double> point(q.begin(), q.end()), out(kernel.outputs());
  point.insert(point.end(), v.begin(), v.end());
  point.push_back(t);
  work->evaluate(point, out);
  return out;
}

}  // namespace

std::optional<std::size_t> StateFunctions::violated_constraint(const MotionState& state, double digits,
                                                               const UsualSizes& sizes) {
  const MechanicalSystem& system = problem_.system;
  if (!system.constrained()) return std::nullopt;
  const std::vector<double> found =
      values_at(problem_.library->constraints(), constraints_, problem_.parameters, state.t, state.q, state.v);
  const std::size_t n = state.q.size(), m = system.constraints.size();
  const double *const a = found.data(), *const values = a + m * n, *const rates = values + m;
  for (std::size_t k = 0; k < m; ++k) {
    double place = 0, speed = 0;
    for (std::size_t i = 0; i < n; ++i) {
      place += std::abs(a[k * n + i]) * std::max(sizes.place(i), std::abs(state.q[i]));
      speed += std::abs(a[k * n + i]) * std::max(sizes.speed(i), std::abs(state.v[i]));
    }
    const bool position = system.constraints[k].level == Constraint::Level::Position;
    if ((position && std::abs(values[k]) > digits * place) || std::abs(rates[k]) > digits * speed) return k;
  }
  return std::nullopt;
}

std::vector<double> StateFunctions::energy_and_sets(double t, std::span<const double> q, std::span<const double> v) {
  return values_at(problem_.library->sets(), sets_, problem_.parameters, t, q, v);
}

}  // namespace maupertuis::hybrid
