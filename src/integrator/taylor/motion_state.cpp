#include "integrator/taylor/motion_state.hpp"

#include <algorithm>

namespace maupertuis::taylor {

MotionState::MotionState(const Kernel& kernel)
    : q(kernel.freedoms()),
      v(q.size()),
      integrals(kernel.integrands()),
      q_now(q.size()),
      v_now(q.size()),
      turns(kernel) {}

void MotionState::start(double time, std::span<const double> position, std::span<const double> velocity) {
  t = {time, 0};
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = {position[i], 0}, v[i] = {velocity[i], 0};
  std::fill(integrals.begin(), integrals.end(), Compensated{});
  turns.forget();
  renew_leading_parts();
}

void MotionState::wind() {
  if (turns.wind(q)) renew_leading_parts();
}

void MotionState::move(const DenseOutput& step, const Compensated& from, double tau) {
  step.advance(tau, q, v, integrals);
  t = from;
  t.add(tau);
  renew_leading_parts();
}

void MotionState::take_back(const DenseOutput& step, const Compensated& from, const Turns& turns_then) {
  t = from;
  turns = turns_then;
  q = step.q, v = step.v, integrals = step.integrals;
  renew_leading_parts();
}

void MotionState::add(std::span<const double> dq, std::span<const double> dv) {
  for (std::size_t i = 0; i < q.size(); ++i) q[i].add(dq[i]), v[i].add(dv[i]);
  renew_leading_parts();
}

void MotionState::renew_leading_parts() {
  for (std::size_t i = 0; i < q.size(); ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
}

}  // namespace maupertuis::taylor
