#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "kernel/reference/reference.hpp"

#include <maupertuis/kernel.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

namespace maupertuis::extended {

/// KernelWorkspace over T: the interpreter's rules on the program of a kernel, with its literals taken exactly. The
/// functions mean what they mean there. The structured Taylor step is that of docs/design/kernel_program.md; at this
/// cost of an operation there is nothing to gain by blocking, so that each stage corrects by one sweep of tangents.
template <class T>
class Workspace {
 public:
  using Scalar = T;

  Workspace(const Kernel& kernel, int order);

  int order() const { return order_; }
  void set_parameters(std::span<const T> values);
  void set_branches(std::span<const std::int8_t> sides);
  /// [n] The sizes of q̈ in the motion so far: where forces balance, what rounding leaves of them contradicts nothing.
  void set_usual_accelerations(std::span<const T> a) { usual_accelerations_.assign(a.begin(), a.end()); }

  KernelStatus expand(const T& t, std::span<const T> q, std::span<const T> v) { return run(t, q, v, order_); }
  /// Coefficients up to `order` alone.
  KernelStatus expand_to(int order, const T& t, std::span<const T> q, std::span<const T> v) {
    return run(t, q, v, order);
  }
  KernelStatus evaluate(const T& t, std::span<const T> q, std::span<const T> v) { return run(t, q, v, 1); }

  const Program& program() const { return program_; }
  const T* constants() const { return memory_.constants.data(); }
  std::size_t row_stride() const { return memory_.stride; }
  /// Coefficient k of slot s at [s].
  const T* coordinate(int k) const { return memory_.row(k); }
  T acceleration(std::size_t i) const { return 2 * memory_.row(2)[i]; }
  T multiplier(std::size_t i) const { return 2 * memory_.row(2)[program_.freedoms + i]; }
  bool multiplier_is_determined(std::size_t i) const { return determined_[i]; }
  const T& observable(std::size_t i) const { return memory_.row(0)[program_.observables[i]]; }
  T integrand(std::size_t i, int k) const { return coefficient(program_.integrands[i], k); }
  T event(std::size_t i, int k) const { return coefficient(program_.events[i], k); }
  T switch_function(std::size_t i, int k) const { return coefficient(program_.switch_slots[i], k); }
  T event_scale(std::size_t i) const { return size_of(program_.events[i]); }
  T switch_scale(std::size_t i) const { return size_of(program_.switch_slots[i]); }

  T constraint_value(std::size_t i) const;
  const T& constraint_rate(std::size_t i) const { return memory_.row(0)[program_.constraint_rates[i]]; }
  T constraint_scale(std::size_t i) const;
  T constraint_rate_scale(std::size_t i) const;
  const T& mass(std::size_t i, std::size_t j) const { return bordered_[i * unknowns_ + j]; }
  T constraint_matrix(std::size_t i, std::size_t j) const {
    return -bordered_[(program_.freedoms + i) * unknowns_ + j];
  }
  void corrections(std::span<T> dq, std::span<T> dv);
  double pivot_ratio() const { return solver_.pivot_ratio(); }

  std::size_t singular_coordinate() const { return singular_; }
  std::size_t contradicting_constraint() const { return contradicting_; }

 private:
  KernelStatus run(const T& t, std::span<const T> q, std::span<const T> v, int stages);
  KernelStatus stages(int count);
  KernelStatus without_solution(KernelStatus status);
  bool border();
  KernelStatus factor();
  bool solve(int stage);
  T acceleration_of_terms(std::size_t i) const;
  bool constraints_agree();
  void correct(int stage);
  T coefficient(Slot slot, int k) const;
  T size_of(Slot slot) const { return reference::term_size(memory_, producer_[slot], slot); }
  void solve_for(std::span<T> out, std::span<const T> error);

  Kernel kernel_;
  const Program& program_;
  int order_, orders_;
  reference::MemoryOf<T> memory_;
  std::vector<T> parameters_;
  std::vector<std::int8_t> sides_;
  bool stale_ = true;         // constants to be computed
  std::size_t unknowns_;      // n + m
  std::vector<T> bordered_;   // [(n + m) × (n + m)] ∂R/∂(q̈, λ) at order 0
  std::vector<T> unknown_;    // [n + m]
  std::vector<T> direction_;  // [slots] tangents
  LinearSolver<T> solver_;
  std::vector<bool> determined_;               // [m]
  std::vector<T> usual_accelerations_;         // [n] or empty
  std::vector<sparse::Edge> edges_, of_mass_;  // that tangents go through: for corrections, for M₀
  std::vector<const Instruction*> producer_;   // [slots]
  std::size_t singular_ = 0, contradicting_ = 0;
  int last_stage_ = 0;
};

}  // namespace maupertuis::extended
