#include "integrator/taylor/last_step.hpp"

#include <limits>

namespace maupertuis::taylor {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Where a list has its length already nothing is called.
void fit(std::vector<double>& list, std::size_t length) {
  if (list.size() != length) list.resize(length);
}

void multipliers_of(const KernelWorkspace& work, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = work.multiplier_is_determined(i) ? work.multiplier(i) : nothing;
}

}  // namespace

LastStep::LastStep(const Kernel& kernel, int order)
    : turns(kernel), multipliers_(kernel.constraints()), observables_(kernel.observables()), degree_(order + 1) {
  dense.resize(kernel.freedoms(), kernel.integrands(), degree_);
}

void LastStep::start(const MotionState& state) {
  dense.resize(state.q.size(), state.integrals.size(), degree_);
  turns.forget();
  begin = state.t;
  dense.q = state.q;
  dense.v = state.v;
}

void LastStep::keep(const KernelWorkspace& work, const MotionState& state) {
  keep_state(state);
  dense.refer_to(work.coordinate(0), work.row_stride(), work.polynomials());
  for (std::size_t i = 0; i < state.integrals.size(); ++i)
    for (int k = 0; k <= degree_; ++k) dense.integrand(k)[i] = work.integrand(i, k);
}

void LastStep::keep_state(const MotionState& state) {
  begin = state.t;
  if (turns.changes() != state.turns.changes()) turns = state.turns;
  std::copy(state.q.begin(), state.q.end(), dense.q.begin());
  std::copy(state.v.begin(), state.v.end(), dense.v.begin());
  std::copy(state.integrals.begin(), state.integrals.end(), dense.integrals.begin());
}

void LastStep::record_start(const KernelWorkspace& work, bool observe) {
  Sample& out = start_sample;
  const std::size_t n = dense.q.size();
  out.t = begin.hi;
  fit(out.q, n), fit(out.v, n), fit(out.a, n);
  for (std::size_t i = 0; i < n; ++i) {
    out.q[i] = turns.unwound(i, dense.q[i]), out.v[i] = dense.v[i].hi;
    out.a[i] = work.acceleration(i);
  }
  fit(out.observables, observe ? observables_ : 0);
  for (std::size_t i = 0; i < out.observables.size(); ++i) out.observables[i] = work.observable(i);
  if (observe) turns.add_to(out.observables);
  fit(out.multipliers, multipliers_);
  multipliers_of(work, out.multipliers);
  fit(out.integrals, dense.integrals.size());
  for (std::size_t i = 0; i < out.integrals.size(); ++i) out.integrals[i] = dense.integrals[i].hi;
}

Sample LastStep::sample(double time, KernelWorkspace& point) const {
  const std::size_t n = dense.q.size();
  std::vector<Compensated> position(n), velocity(n), integral(dense.integrals.size());
  dense.advance(tau_of(time), position, velocity, integral);
  Sample result;
  result.t = time;
  for (auto* list : {&result.q, &result.v, &result.a}) list->reserve(n);
  result.integrals.reserve(integral.size());
  result.observables.reserve(observables_);
  for (std::size_t i = 0; i < n; ++i) {
    result.q.push_back(position[i].hi);
    result.v.push_back(velocity[i].hi);
  }
  for (const Compensated& x : integral) result.integrals.push_back(x.hi);
  const bool ok = point.evaluate(time, result.q, result.v) == KernelStatus::Ok;
  for (std::size_t i = 0; i < n; ++i) result.a.push_back(ok ? point.acceleration(i) : nothing);
  result.multipliers.assign(multipliers_, nothing);
  if (ok)
    multipliers_of(point, result.multipliers);
  else
    point.observe_without_solution();  // a place has its value where a force along it has none
  for (std::size_t i = 0; i < observables_; ++i) result.observables.push_back(point.observable(i));
  turns.add_to(result.observables);
  for (std::size_t i = 0; i < n; ++i) result.q[i] = turns.unwound(i, position[i]);
  return result;
}

std::span<const double> LastStep::accelerations(double time) const { return dense.accelerations(tau_of(time)); }

void LastStep::state(double time, std::span<double> q, std::span<double> v) const {
  std::vector<Compensated> position(dense.q.size()), velocity(dense.q.size()), integral(dense.integrals.size());
  dense.advance(tau_of(time), position, velocity, integral);
  for (std::size_t i = 0; i < position.size(); ++i) q[i] = turns.unwound(i, position[i]), v[i] = velocity[i].hi;
}

}  // namespace maupertuis::taylor
