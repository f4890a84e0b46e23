#pragma once
#include "kernel/extended/workspace.hpp"
#include "kernel/reference/memory_code.hpp"
#include "kernel/reference/run_code.hpp"
#include "kernel/reference/tangents_code.hpp"
#include "kernel/series/elementary_code.hpp"

namespace maupertuis::extended {

/// A pivot below this power of the rounding unit is rounding; a dependence between rows is seen well above it.
inline constexpr double rank_power = 0.7;
/// What the rows that were left out may miss, and the smallest part that counts in a dependence.
inline constexpr double share_power = 0.4;

template <class T>
Workspace<T>::Workspace(const Kernel& kernel, int order)
    : kernel_(kernel),
      program_(kernel.program()),
      order_(order),
      orders_(order + 2 + (-2 - program_.first_stage)),
      memory_(program_, orders_, program_.slots),
      parameters_(program_.parameters, T(0)),
      sides_(program_.switches.size(), 1),
      unknowns_(program_.unknowns),
      bordered_(unknowns_ * unknowns_),
      unknown_(unknowns_),
      direction_(program_.slots, T(0)),
      determined_(unknowns_ - program_.freedoms, true),
      edges_(sparse::tangent_edges(program_)),
      of_mass_(sparse::edges_of_mass(program_)),
      producer_(program_.slots, nullptr) {
  MAUP_REQUIRE(order >= 1);
  for (const Instruction& i : program_.instructions) producer_[i.out] = &i;
}

template <class T>
void Workspace<T>::set_parameters(std::span<const T> values) {
  MAUP_REQUIRE(values.size() == parameters_.size());
  parameters_.assign(values.begin(), values.end());
  stale_ = true;
}

template <class T>
void Workspace<T>::set_branches(std::span<const std::int8_t> sides) {
  MAUP_REQUIRE(sides.size() == sides_.size());
  stale_ = stale_ || !std::equal(sides.begin(), sides.end(), sides_.begin());
  sides_.assign(sides.begin(), sides.end());
}

/// ∂R/∂(q̈, λ), column by column. False if it is not finite.
template <class T>
bool Workspace<T>::border() {
  bool finite = true;
  for (std::size_t d = 0; d < unknowns_; ++d) {
    std::fill_n(direction_.begin(), unknowns_, T(0));
    direction_[d] = T(1);
    reference::tangents<1>(memory_, direction_.data(), of_mass_);
    for (std::size_t i = 0; i < unknowns_; ++i) {
      const Slot slot = program_.residual[i];
      bordered_[i * unknowns_ + d] = program_.tangent_lags[slot] == 2 ? direction_[slot] : T(0);
      finite = finite && is_finite(bordered_[i * unknowns_ + d]);
    }
  }
  return finite;
}

/// A direction that the matrix does not see may be one of multipliers alone: then the constraints depend on each other,
/// and the motion is determined all the same.
template <class T>
KernelStatus Workspace<T>::factor() {
  if (!border()) return KernelStatus::NonFinite;
  solver_.factor(bordered_, unknowns_, epsilon_to<T>(rank_power));
  std::fill(determined_.begin(), determined_.end(), true);
  const std::size_t n = program_.freedoms;
  const T least = epsilon_to<T>(share_power);
  for (const std::vector<T>& null : solver_.null_vectors()) {
    const auto larger = [](const T& x, const T& y) { return abs(x) < abs(y); };
    const auto whole = abs(*std::max_element(null.begin(), null.end(), larger));
    const auto worst = std::max_element(null.begin(), null.begin() + static_cast<std::ptrdiff_t>(n), larger);
    if (n > 0 && abs(*worst) > least * whole) {
      singular_ = static_cast<std::size_t>(worst - null.begin());
      return KernelStatus::SingularMass;
    }
    for (std::size_t j = 0; n + j < unknowns_; ++j)
      if (abs(null[n + j]) > least * whole) determined_[j] = false;
  }
  return KernelStatus::Ok;
}

/// unknown = q̈_k, λ_k; false if it is not finite.
template <class T>
bool Workspace<T>::solve(int stage) {
  const T* const row = memory_.row(stage);
  for (std::size_t i = 0; i < unknowns_; ++i) unknown_[i] = -row[program_.residual[i]];
  solver_.solve(unknown_);
  return std::all_of(unknown_.begin(), unknown_.end(), [](const T& x) { return is_finite(x); });
}

/// As StageSolver::acceleration_of_terms.
template <class T>
T Workspace<T>::acceleration_of_terms(std::size_t i) const {
  const T own = abs(mass(i, i));
  T force = size_of(program_.residual[i]);
  for (std::size_t k = 0; program_.freedoms + k < unknowns_; ++k)
    force += abs(constraint_matrix(k, i) * unknown_[program_.freedoms + k]);
  const T usual = usual_accelerations_.empty() ? T(0) : usual_accelerations_[i];
  if (!(own > 0)) return usual;
  return force / own > usual ? T(force / own) : usual;
}

/// Whether the rows that were left out as dependent hold for the solution of the others.
template <class T>
bool Workspace<T>::constraints_agree() {
  if (solver_.rank() == unknowns_) return true;
  for (std::size_t j = 0; program_.freedoms + j < unknowns_; ++j) {
    const Slot slot = program_.residual[program_.freedoms + j];
    T rest = memory_.row(0)[slot], size = size_of(slot), left = T(0);
    for (std::size_t i = 0; i < program_.freedoms; ++i) {
      const T term = constraint_matrix(j, i) * unknown_[i];
      rest -= term;
      size += abs(term);
      if (constraint_matrix(j, i) != 0) left += abs(constraint_matrix(j, i)) * acceleration_of_terms(i);
    }
    if (abs(rest) <= epsilon_to<T>(share_power) * size + epsilon_to<T>(0.77) * left) continue;
    contradicting_ = j;
    return false;
  }
  return true;
}

/// Coefficient k + 2 − ℓ of a slot of lag ℓ follows q̈_k with its order-0 tangent times 1, 1/(k+1), 1/((k+1)(k+2)).
template <class T>
void Workspace<T>::correct(int stage) {
  const T divisors[3] = {T(stage + 1) * T(stage + 2), T(stage + 1), T(1)};
  T* const next = memory_.row(stage + 2);
  for (std::size_t i = 0; i < unknowns_; ++i) next[i] = unknown_[i] / divisors[0];
  std::copy(unknown_.begin(), unknown_.end(), direction_.begin());
  reference::tangents<1>(memory_, direction_.data(), edges_);
  auto first = static_cast<Slot>(unknowns_);
  for (int lag = 0; lag <= 2; ++lag) {
    const Slot last = program_.stored_end[static_cast<std::size_t>(lag)];
    T* const row = memory_.row(stage + 2 - lag);
    for (Slot slot = first; slot < last; ++slot) row[slot] += direction_[slot] / divisors[lag];
    first = last;
  }
}

template <class T>
KernelStatus Workspace<T>::stages(int count) {
  for (int stage = program_.first_stage; stage < count; ++stage) {
    if (stage >= 0) std::fill_n(memory_.row(stage + 2), unknowns_, T(0));
    reference::run_section(memory_, Dynamics, stage);
    if (stage == 0)
      if (const KernelStatus status = factor(); status != KernelStatus::Ok) return status;
    if (stage >= 0) {
      if (!solve(stage)) return KernelStatus::NonFinite;
      if (stage == 0 && !constraints_agree()) return KernelStatus::Contradiction;
      correct(stage);
    }
    reference::run_section(memory_, Along, stage);
    if (stage <= 0) reference::run_section(memory_, AtPoint, stage);
  }
  return KernelStatus::Ok;
}

template <class T>
KernelStatus Workspace<T>::run(const T& t, std::span<const T> q, std::span<const T> v, int count) {
  MAUP_REQUIRE(q.size() == program_.freedoms && v.size() == program_.freedoms);
  // Some functions of the number type throw where they have no value, others give NaN.
  try {
    if (stale_) reference::compute_constants<T>(memory_, parameters_, sides_);
    stale_ = false;
    last_stage_ = count - 1;
    reference::set_leaves(memory_, t, orders_);
    for (int k = 0; k < 2; ++k) std::fill_n(memory_.row(k), unknowns_, T(0));
    std::copy(q.begin(), q.end(), memory_.row(0));
    std::copy(v.begin(), v.end(), memory_.row(1));
    const KernelStatus status = stages(count);
    return status == KernelStatus::Ok ? status : without_solution(status);
  } catch (const std::domain_error&) {
    return without_solution(KernelStatus::NonFinite);
  } catch (const std::runtime_error&) {
    return without_solution(KernelStatus::NonFinite);
  }
}

/// Switch functions have values where forces have none: as of KernelWorkspace.
template <class T>
KernelStatus Workspace<T>::without_solution(KernelStatus status) try {
  reference::run_section(memory_, Along, 0);
  return status;
} catch (const std::exception&) {
  return status;
}

template <class T>
T Workspace<T>::coefficient(Slot slot, int k) const {
  return k <= last_stage_ + 2 - program_.lags[slot] && k < orders_ ? memory_.row(k)[slot] : T(0);
}

template <class T>
T Workspace<T>::constraint_value(std::size_t i) const {
  const Slot slot = program_.constraint_values[i];
  return slot == no_slot ? T(0) : memory_.row(0)[slot];
}

template <class T>
T Workspace<T>::constraint_scale(std::size_t i) const {
  const Slot slot = program_.constraint_values[i];
  return slot == no_slot ? T(0) : size_of(slot);
}

template <class T>
T Workspace<T>::constraint_rate_scale(std::size_t i) const {
  T size = size_of(program_.constraint_rates[i]);
  for (std::size_t k = 0; k < program_.freedoms; ++k) {
    const T part = abs(constraint_matrix(i, k) * memory_.row(1)[k]);
    size = std::max(size, part);
  }
  return size;
}

/// −A δ = error
template <class T>
void Workspace<T>::solve_for(std::span<T> out, std::span<const T> error) {
  std::fill(unknown_.begin(), unknown_.end(), T(0));
  std::copy(error.begin(), error.end(), unknown_.begin() + static_cast<std::ptrdiff_t>(program_.freedoms));
  solver_.solve(unknown_);
  std::copy_n(unknown_.begin(), program_.freedoms, out.begin());
}

template <class T>
void Workspace<T>::corrections(std::span<T> dq, std::span<T> dv) {
  std::vector<T> values, rates;
  for (std::size_t j = 0; program_.freedoms + j < unknowns_; ++j) {
    values.push_back(constraint_value(j));
    rates.push_back(constraint_rate(j));
  }
  solve_for(dq, values);
  solve_for(dv, rates);
}

}  // namespace maupertuis::extended
