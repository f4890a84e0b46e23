#include "kernel/workspace/workspace.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>

/// What is read of a workspace.
namespace maupertuis {

int KernelWorkspace::order() const { return impl_->expansion.order; }
std::size_t KernelWorkspace::row_stride() const { return impl_->expansion.memory.stride; }
const Program& KernelWorkspace::program() const { return impl_->expansion.program; }
const double* KernelWorkspace::constants() const { return impl_->expansion.memory.constants.data(); }

const double* KernelWorkspace::coordinate(int k) const { return impl_->expansion.memory.row(k); }
double KernelWorkspace::acceleration(std::size_t i) const { return 2 * coordinate(2)[i]; }
double KernelWorkspace::observable(std::size_t i) const {
  impl_->observe();
  return coordinate(0)[program().observables[i]];
}
double KernelWorkspace::switch_function(std::size_t i, int k) const {
  return impl_->expansion.coefficient(program().switch_slots[i], k);
}
double KernelWorkspace::event(std::size_t i, int k) const {
  workspace::Expansion& x = impl_->expansion;
  impl_->along.need_point(x.memory);
  if (k > 2 - program().lags[program().events[i]]) impl_->along.need_event(x.memory, i, x.last_stage);
  return x.coefficient(program().events[i], k);
}
double KernelWorkspace::integrand(std::size_t i, int k) const {
  return impl_->expansion.coefficient(program().integrands[i], k);
}
double KernelWorkspace::switch_scale(std::size_t i) const { return impl_->expansion.scale(program().switch_slots[i]); }
double KernelWorkspace::event_scale(std::size_t i) const {
  impl_->along.need_point(impl_->expansion.memory);
  return impl_->expansion.scale(program().events[i]);
}
std::size_t KernelWorkspace::singular_coordinate() const { return impl_->solver.factors().singular(); }
std::size_t KernelWorkspace::contradicting_constraint() const { return impl_->solver.contradicting(); }

// -------------------------------------------------------------------------------------------------------- polynomials

double KernelWorkspace::radius(double h) const {
  const workspace::Expansion& x = impl_->expansion;
  if (impl_->in_code.code.radius) return impl_->in_code.code.radius(x.memory.rows.data(), h);
  return x.engine.radius(x.memory.row(0), x.memory.stride, x.program.freedoms, x.order, h);
}

Polynomials KernelWorkspace::polynomials() const {
  const workspace::ExpansionCode& code = impl_->in_code.code;
  return code.increments ? Polynomials{code.increments, code.accelerations, code.sizes} : Polynomials{};
}

void polynomial_increments(const double* first, std::size_t stride, std::size_t columns, int degree, double tau,
                           double* dq, double* dv) {
  packed::engine().increments(first, stride, columns, degree, tau, dq, dv);
}
void polynomial_accelerations(const double* first, std::size_t stride, std::size_t columns, int degree, double tau,
                              double* a) {
  packed::engine().accelerations(first, stride, columns, degree, tau, a);
}
void polynomial_sizes(const double* first, std::size_t stride, std::size_t columns, int degree, const double* weights,
                      double* sizes) {
  packed::engine().sizes(first, stride, columns, degree, weights, sizes);
}
void add_increments(std::size_t count, double tau, const double* dq, const double* dv, const double* q, const double* v,
                    double* q_out, double* v_out) {
  packed::engine().add_increments(count, tau, dq, dv, q, v, q_out, v_out);
}

// -------------------------------------------------------------------------------------------------------- constraints

double KernelWorkspace::multiplier(std::size_t i) const { return 2 * coordinate(2)[program().freedoms + i]; }
bool KernelWorkspace::multiplier_is_determined(std::size_t i) const { return impl_->solver.factors().determines(i); }

double KernelWorkspace::constraint_value(std::size_t i) const {
  const Slot slot = program().constraint_values[i];
  return slot == no_slot ? 0.0 : coordinate(0)[slot];
}
double KernelWorkspace::constraint_rate(std::size_t i) const { return coordinate(0)[program().constraint_rates[i]]; }
double KernelWorkspace::constraint_scale(std::size_t i) const {
  const Slot slot = program().constraint_values[i];
  return slot == no_slot ? 0.0 : impl_->expansion.scale(slot);
}
double KernelWorkspace::constraint_rate_scale(std::size_t i) const {
  double size = impl_->expansion.scale(program().constraint_rates[i]);
  for (std::size_t k = 0; k < program().freedoms; ++k)
    size = std::max(size, std::abs(constraint_matrix(i, k) * coordinate(1)[k]));
  return size;
}

void KernelWorkspace::corrections(std::span<double> dq, std::span<double> dv) {
  const std::size_t n = program().freedoms, m = program().unknowns - n;
  MAUP_REQUIRE(dq.size() == n && dv.size() == n);
  std::fill(dq.begin(), dq.end(), 0.0);
  std::fill(dv.begin(), dv.end(), 0.0);
  if (m == 0) return;
  std::vector<double> error(m);
  for (std::size_t j = 0; j < m; ++j) error[j] = constraint_value(j);
  impl_->solver.solve_for(error, dq);
  for (std::size_t j = 0; j < m; ++j) error[j] = constraint_rate(j);
  impl_->solver.solve_for(error, dv);
}

std::size_t KernelWorkspace::constraints_in_force() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i + program().freedoms < program().unknowns; ++i) count += impl_->solver.factors().keeps(i);
  return count;
}
double KernelWorkspace::pivot_ratio() const {
  return program().unknowns == program().freedoms ? 1 : impl_->solver.factors().pivot_ratio();
}

double KernelWorkspace::mass(std::size_t i, std::size_t j) const { return impl_->solver.matrix().at(i, j); }
double KernelWorkspace::constraint_matrix(std::size_t constraint, std::size_t coordinate) const {
  return -impl_->solver.matrix().at(program().freedoms + constraint, coordinate);
}

}  // namespace maupertuis
