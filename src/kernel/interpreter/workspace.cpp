#include "kernel/interpreter/interpreter.hpp"
#include "kernel/jet/bordered_solver.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>

/// The structured Taylor step (docs/design/kernel_program.md). Stage k finds q_{k+2}: with it set to 0 the residual is
/// evaluated at order k, M₀ q̈_k = −R_k gives the acceleration, and every coefficient that later orders read is
/// corrected by its derivative in the direction of q̈_k, which is that of order 0 up to a factor.
namespace maupertuis {

using interpreter::Memory;

struct KernelWorkspace::Impl {
  Impl(const Kernel& k, int p)
      : kernel(k), program(k.program()), order(p), orders(p + 2 + (-2 - program.first_stage)), memory(program, orders),
        parameters(program.parameters, 0.0), sides(program.switches.size(), 1), unknowns(program.unknowns),
        solver(program.freedoms, unknowns - program.freedoms), bordered(unknowns * unknowns), unknown(unknowns),
        producer(program.slots, nullptr) {
    width = unknowns <= 1 ? 1 : unknowns <= 2 ? 2 : unknowns <= 4 ? 4 : 8;
    tangent.assign(program.slots * static_cast<std::size_t>(width), 0.0);
    if (unknowns > 8) direction.assign(program.slots, 0.0);
    moved = interpreter::moved_instructions(program);
    of_mass = unknowns > 8 ? interpreter::instructions_of_mass(program) : moved;
    for (const Instruction& i : program.instructions) producer[i.out] = &i;
  }

  KernelStatus run(double t, std::span<const double> q, std::span<const double> v, int stages);
  KernelStatus factor();
  bool solve(int stage);
  void correct(int stage);
  void correct_by_matrix(double* row, Slot first, Slot last, double factor);
  void sweep_block(std::size_t first);
  bool constraints_agree();
  double coefficient(Slot slot, int k) const;

  Kernel kernel;
  const Program& program;
  int order, orders;
  Memory memory;
  std::vector<double> parameters;
  std::vector<std::int8_t> sides;
  bool stale = true;                 // constants to be computed
  std::size_t unknowns;              // n + m
  jet::BorderedSolver solver;
  std::vector<double> bordered;      // [(n + m) × (n + m)] ∂R/∂(q̈, λ) at order 0
  std::vector<double> unknown;       // [n + m] −R_k, then q̈_k and λ_k
  int width;                         // directions a tangent sweep carries
  std::vector<double> tangent;       // [slots × width]; with n + m ≤ 8 it holds ∂slot/∂q^(lag) [slots × (n + m)]
  std::vector<double> direction;     // [slots], n + m > 8: tangents in the direction of q̈_k
  std::vector<std::uint32_t> moved, of_mass;  // instructions that tangents go through: for corrections, for M₀
  std::vector<const Instruction*> producer;  // [slots]
  std::size_t singular = 0, contradicting = 0;
  int last_stage = 0;
};

namespace {

void sweep(int width, const Memory& memory, double* tangent, std::span<const std::uint32_t> instructions) {
  switch (width) {
    case 1: return interpreter::tangents<1>(memory, tangent, instructions);
    case 2: return interpreter::tangents<2>(memory, tangent, instructions);
    case 4: return interpreter::tangents<4>(memory, tangent, instructions);
    default: return interpreter::tangents<8>(memory, tangent, instructions);
  }
}

template <int Width>
void add_combination(double* row, const double* tangent, Slot first, Slot last, const double* direction) {
  for (Slot slot = first; slot < last; ++slot) {
    double sum = 0;
    for (int d = 0; d < Width; ++d) sum += tangent[static_cast<std::size_t>(slot) * Width + d] * direction[d];
    row[slot] += sum;
  }
}

}  // namespace

/// Tangents in the directions of q̈_first … q̈_{first + width − 1}.
void KernelWorkspace::Impl::sweep_block(std::size_t first) {
  const auto w = static_cast<std::size_t>(width);
  std::fill_n(tangent.begin(), unknowns * w, 0.0);
  for (std::size_t d = 0; d < w && first + d < unknowns; ++d) tangent[(first + d) * w + d] = 1;
  sweep(width, memory, tangent.data(), of_mass);
}

/// M₀ = ∂R/∂q̈ at order 0, bordered by the constraints, column by column, and its factors.
KernelStatus KernelWorkspace::Impl::factor() {
  const std::size_t n = unknowns;
  auto& matrix = bordered;
  const auto w = static_cast<std::size_t>(width);
  double check = 0;
  for (std::size_t first = 0; first < n; first += w) {
    sweep_block(first);
    for (std::size_t i = 0; i < n; ++i) {
      const Slot slot = program.residual[i];
      const bool holds_acceleration = program.tangent_lags[slot] == 2;
      for (std::size_t d = 0; d < w && first + d < n; ++d) {
        const double value = holds_acceleration ? tangent[slot * w + d] : 0.0;
        matrix[i * n + first + d] = value;
        check += value * 0;
      }
    }
  }
  if (check != 0) return KernelStatus::NonFinite;  // infinity and NaN times 0 are NaN
  std::copy(matrix.begin(), matrix.end(), solver.matrix().begin());
  if (const auto undetermined = solver.factor()) {
    singular = *undetermined;
    return KernelStatus::SingularMass;
  }
  return KernelStatus::Ok;
}

/// unknown = q̈_k; false if it is not finite.
bool KernelWorkspace::Impl::solve(int stage) {
  const double* const row = memory.row(stage);
  for (std::size_t i = 0; i < unknown.size(); ++i) unknown[i] = -row[program.residual[i]];
  solver.solve(unknown);
  double check = 0;
  for (const double a : unknown) check += a * 0;
  return check == 0;
}

/// Whether the rows of A that were dropped as dependent hold for the accelerations of the others.
bool KernelWorkspace::Impl::constraints_agree() {
  const std::size_t n = program.freedoms;
  for (std::size_t j = 0; n + j < unknowns; ++j) {
    if (solver.keeps(j)) continue;
    const Slot slot = program.residual[n + j];
    double rest = memory.row(0)[slot], size = interpreter::term_size(memory, producer[slot], slot);
    for (std::size_t i = 0; i < n; ++i) {
      const double term = bordered[(n + j) * unknowns + i] * unknown[i];
      rest += term;
      size += std::abs(term);
    }
    if (std::abs(rest) <= 1e-6 * size) continue;
    contradicting = j;
    return false;
  }
  return true;
}

void KernelWorkspace::Impl::correct_by_matrix(double* row, Slot first, Slot last, double factor) {
  double scaled[8] = {};
  for (std::size_t i = 0; i < unknown.size(); ++i) scaled[i] = unknown[i] * factor;
  switch (width) {
    case 1: return add_combination<1>(row, tangent.data(), first, last, scaled);
    case 2: return add_combination<2>(row, tangent.data(), first, last, scaled);
    case 4: return add_combination<4>(row, tangent.data(), first, last, scaled);
    default: return add_combination<8>(row, tangent.data(), first, last, scaled);
  }
}

/// Coefficient k + 2 − ℓ of a slot of lag ℓ follows q̈_k with its order-0 tangent times 1, 1/(k+1), 1/((k+1)(k+2)).
void KernelWorkspace::Impl::correct(int stage) {
  const std::size_t n = unknowns;
  const double lag1 = 1.0 / (stage + 1), lag0 = lag1 / (stage + 2);
  const double factors[3] = {lag0, lag1, 1};
  double* const next = memory.row(stage + 2);
  // A division: the error of a rounded reciprocal would be the same in every step and so add up.
  for (std::size_t i = 0; i < n; ++i) next[i] = unknown[i] / ((stage + 1.0) * (stage + 2.0));
  const bool by_matrix = n <= 8;
  if (!by_matrix) {
    std::copy(unknown.begin(), unknown.end(), direction.begin());
    interpreter::tangents<1>(memory, direction.data(), moved);
  }
  Slot first = static_cast<Slot>(n);
  for (int lag = 0; lag <= 2; ++lag) {
    const Slot last = program.stored_end[static_cast<std::size_t>(lag)];
    double* const row = memory.row(stage + 2 - lag);
    if (by_matrix) correct_by_matrix(row, first, last, factors[lag]);
    else for (Slot slot = first; slot < last; ++slot) row[slot] += factors[lag] * direction[slot];
    first = last;
  }
}

KernelStatus KernelWorkspace::Impl::run(double t, std::span<const double> q, std::span<const double> v, int stages) {
  MAUP_REQUIRE(q.size() == program.freedoms && v.size() == program.freedoms);
  if (stale) interpreter::compute_constants(memory, parameters, sides);
  stale = false;
  last_stage = stages - 1;
  interpreter::set_leaves(memory, t, orders);
  for (int k = 0; k < 2; ++k) std::fill_n(memory.row(k), unknowns, 0.0);
  std::copy(q.begin(), q.end(), memory.row(0));
  std::copy(v.begin(), v.end(), memory.row(1));
  for (int stage = program.first_stage; stage < stages; ++stage) {
    if (stage >= 0) std::fill_n(memory.row(stage + 2), unknowns, 0.0);
    interpreter::run_section(memory, Dynamics, stage);
    if (stage == 0)
      if (const auto status = factor(); status != KernelStatus::Ok) return status;
    if (stage >= 0) {
      if (!solve(stage)) return KernelStatus::NonFinite;
      if (stage == 0 && !constraints_agree()) return KernelStatus::Contradiction;
      correct(stage);
    }
    interpreter::run_section(memory, Along, stage);
    if (stage <= 0) interpreter::run_section(memory, AtPoint, stage);
  }
  return KernelStatus::Ok;
}

double KernelWorkspace::Impl::coefficient(Slot slot, int k) const {
  return k <= last_stage + 2 - program.lags[slot] && k < orders ? memory.row(k)[slot] : 0.0;
}

KernelWorkspace::KernelWorkspace(const Kernel& kernel, int order) : impl_(std::make_unique<Impl>(kernel, order)) {
  MAUP_REQUIRE(order >= 1);
}
KernelWorkspace::~KernelWorkspace() = default;
KernelWorkspace::KernelWorkspace(KernelWorkspace&&) noexcept = default;

int KernelWorkspace::order() const { return impl_->order; }

void KernelWorkspace::set_parameters(std::span<const double> values) {
  MAUP_REQUIRE(values.size() == impl_->parameters.size());
  impl_->parameters.assign(values.begin(), values.end());
  impl_->stale = true;
}

void KernelWorkspace::set_branches(std::span<const std::int8_t> sides) {
  MAUP_REQUIRE(sides.size() == impl_->sides.size());
  impl_->stale = impl_->stale || !std::equal(sides.begin(), sides.end(), impl_->sides.begin());
  impl_->sides.assign(sides.begin(), sides.end());
}

KernelStatus KernelWorkspace::expand(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, impl_->order);
}
KernelStatus KernelWorkspace::evaluate(double t, std::span<const double> q, std::span<const double> v) {
  return impl_->run(t, q, v, 1);
}

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
bool KernelWorkspace::multiplier_is_determined(std::size_t i) const { return impl_->solver.determines(i); }

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
  const auto solve_for = [&](auto&& error, std::span<double> out) {
    std::fill_n(s.unknown.begin(), n, 0.0);
    for (std::size_t j = 0; j < m; ++j) s.unknown[n + j] = error(j);  // −A δ = error
    s.solver.solve(s.unknown);
    std::copy_n(s.unknown.begin(), n, out.begin());
  };
  solve_for([&](std::size_t j) { return constraint_value(j); }, dq);
  solve_for([&](std::size_t j) { return constraint_rate(j); }, dv);
}

std::size_t KernelWorkspace::constraints_in_force() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i + impl_->program.freedoms < impl_->unknowns; ++i) count += impl_->solver.keeps(i);
  return count;
}
double KernelWorkspace::pivot_ratio() const { return impl_->solver.pivot_ratio(); }

double KernelWorkspace::mass(std::size_t i, std::size_t j) const { return impl_->bordered[i * impl_->unknowns + j]; }
double KernelWorkspace::constraint_matrix(std::size_t constraint, std::size_t coordinate) const {
  return -impl_->bordered[(impl_->program.freedoms + constraint) * impl_->unknowns + coordinate];
}

}  // namespace maupertuis
