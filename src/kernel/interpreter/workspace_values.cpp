#include "kernel/interpreter/workspace.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>

/// What is read of a workspace.
namespace maupertuis {

const double* KernelWorkspace::coordinate(int k) const { return impl_->memory.row(k); }
double KernelWorkspace::acceleration(std::size_t i) const { return 2 * impl_->memory.row(2)[i]; }
double KernelWorkspace::observable(std::size_t i) const { return impl_->memory.row(0)[impl_->program.observables[i]]; }
double KernelWorkspace::switch_function(std::size_t i, int k) const {
  return impl_->coefficient(impl_->program.switch_slots[i], k);
}
double KernelWorkspace::event(std::size_t i, int k) const { return impl_->coefficient(impl_->program.events[i], k); }
double KernelWorkspace::integrand(std::size_t i, int k) const {
  return impl_->coefficient(impl_->program.integrands[i], k);
}
double KernelWorkspace::switch_scale(std::size_t i) const {
  const Slot slot = impl_->program.switch_slots[i];
  return interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
double KernelWorkspace::event_scale(std::size_t i) const {
  const Slot slot = impl_->program.events[i];
  return interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
std::size_t KernelWorkspace::singular_coordinate() const { return impl_->singular; }
std::size_t KernelWorkspace::contradicting_constraint() const { return impl_->contradicting; }

// ---------------------------------------------------------------------------------------------------- constraints

double KernelWorkspace::multiplier(std::size_t i) const { return 2 * impl_->memory.row(2)[impl_->program.freedoms + i]; }
bool KernelWorkspace::multiplier_is_determined(std::size_t i) const {
  return impl_->by_lifting || !impl_->solver || impl_->solver->determines(i);
}

double KernelWorkspace::constraint_value(std::size_t i) const {
  const Slot slot = impl_->program.constraint_values[i];
  return slot == no_slot ? 0.0 : impl_->memory.row(0)[slot];
}
double KernelWorkspace::constraint_rate(std::size_t i) const {
  return impl_->memory.row(0)[impl_->program.constraint_rates[i]];
}
double KernelWorkspace::constraint_scale(std::size_t i) const {
  const Slot slot = impl_->program.constraint_values[i];
  return slot == no_slot ? 0.0 : interpreter::term_size(impl_->memory, impl_->producer[slot], slot);
}
double KernelWorkspace::constraint_rate_scale(std::size_t i) const {
  const Impl& s = *impl_;
  double size = interpreter::term_size(s.memory, s.producer[s.program.constraint_rates[i]], s.program.constraint_rates[i]);
  for (std::size_t k = 0; k < s.program.freedoms; ++k) size = std::max(size, std::abs(constraint_matrix(i, k) * s.memory.row(1)[k]));
  return size;
}

void KernelWorkspace::corrections(std::span<double> dq, std::span<double> dv) {
  Impl& s = *impl_;
  const std::size_t n = s.program.freedoms, m = s.unknowns - n;
  MAUP_REQUIRE(dq.size() == n && dv.size() == n);
  std::fill(dq.begin(), dq.end(), 0.0);
  std::fill(dv.begin(), dv.end(), 0.0);
  if (m == 0) return;
  const auto solve_for = [&](auto&& error, std::span<double> out) {
    std::fill_n(s.unknown.begin(), n, 0.0);
    for (std::size_t j = 0; j < m; ++j) s.unknown[n + j] = error(j);  // −A δ = error
    s.solve_factored();
    std::copy_n(s.unknown.begin(), n, out.begin());
  };
  solve_for([&](std::size_t j) { return constraint_value(j); }, dq);
  solve_for([&](std::size_t j) { return constraint_rate(j); }, dv);
}

std::size_t KernelWorkspace::constraints_in_force() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i + impl_->program.freedoms < impl_->unknowns; ++i) count += impl_->keeps(i);
  return count;
}
double KernelWorkspace::pivot_ratio() const {
  const Impl& s = *impl_;
  if (s.unknowns == s.program.freedoms) return 1;
  return s.by_lifting ? s.lifted->least_pivot() : s.solver ? s.solver->pivot_ratio() : 1;
}

double KernelWorkspace::mass(std::size_t i, std::size_t j) const {
  impl_->need_full();
  return impl_->bordered[i * impl_->unknowns + j];
}
double KernelWorkspace::constraint_matrix(std::size_t constraint, std::size_t coordinate) const {
  impl_->need_full();
  return -impl_->bordered[(impl_->program.freedoms + constraint) * impl_->unknowns + coordinate];
}

}  // namespace maupertuis
