#include "integrator/taylor/stepper.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <limits>

/// What a step gives: its polynomial, and samples of it.
namespace maupertuis {
namespace {

void multipliers_of(const KernelWorkspace& work, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = work.multiplier_is_determined(i) ? work.multiplier(i) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

/// The polynomial of the step where it was expanded; what is compiled adds it up there.
void TaylorStepper::Impl::keep_polynomial() {
  begin = t;
  if (dense_turns.changes() != turns.changes()) dense_turns = turns;
  set_sides(probe);
  dense.refer_to(work.coordinate(0), work.row_stride(), work.increments());
  for (std::size_t i = 0; i < integrals.size(); ++i)
    for (int k = 0; k <= control.order + 1; ++k) dense.integrand(k)[i] = work.integrand(i, k);
  std::copy(q.begin(), q.end(), dense.q.begin());
  std::copy(v.begin(), v.end(), dense.v.begin());
  std::copy(integrals.begin(), integrals.end(), dense.integrals.begin());
}

void TaylorStepper::Impl::record_start() {
  start_sample.t = begin.hi;
  start_sample.q.resize(n), start_sample.v.resize(n), start_sample.a.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    start_sample.q[i] = dense_turns.unwound(i, dense.q[i]), start_sample.v[i] = dense.v[i].hi;
    start_sample.a[i] = work.acceleration(i);
  }
  start_sample.observables.resize(kernel.observables());
  for (std::size_t i = 0; i < kernel.observables(); ++i) start_sample.observables[i] = work.observable(i);
  dense_turns.add_to(start_sample.observables);
  start_sample.multipliers.resize(m);
  multipliers_of(work, start_sample.multipliers);
  start_sample.integrals.resize(integrals.size());
  for (std::size_t i = 0; i < integrals.size(); ++i) start_sample.integrals[i] = dense.integrals[i].hi;
}

Sample TaylorStepper::Impl::sample(double time) const {
  std::vector<Compensated> position(n), velocity(n), integral(integrals.size());
  dense.advance(tau_of(time), position, velocity, integral);
  Sample result;
  result.t = time;
  for (std::size_t i = 0; i < n; ++i) {
    result.q.push_back(position[i].hi);
    result.v.push_back(velocity[i].hi);
  }
  for (const Compensated& x : integral) result.integrals.push_back(x.hi);
  const bool ok = probe.evaluate(time, result.q, result.v) == KernelStatus::Ok;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < n; ++i) result.a.push_back(ok ? probe.acceleration(i) : nothing);
  result.multipliers.assign(m, nothing);
  if (ok) multipliers_of(probe, result.multipliers);
  for (std::size_t i = 0; i < kernel.observables(); ++i)
    result.observables.push_back(ok ? probe.observable(i) : nothing);
  dense_turns.add_to(result.observables);
  for (std::size_t i = 0; i < n; ++i) result.q[i] = dense_turns.unwound(i, position[i]);
  return result;
}

void TaylorStepper::state(double t, std::span<double> q, std::span<double> v) const {
  MAUP_REQUIRE(covers(t));
  const Impl& s = *impl_;
  std::vector<Compensated> position(s.n), velocity(s.n), integral(s.integrals.size());
  s.dense.advance(s.tau_of(t), position, velocity, integral);
  for (std::size_t i = 0; i < s.n; ++i) q[i] = s.dense_turns.unwound(i, position[i]), v[i] = velocity[i].hi;
}

}  // namespace maupertuis
