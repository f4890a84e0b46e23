#pragma once
#include "kernel/lanes/lane_rules.hpp"
#include "kernel/reference/run_code.hpp"

/// The structured Taylor step of docs/design/kernel_program.md for W lanes: the stages of KernelWorkspace without
/// constraints, with instructions and tangents by the reference rules. Each file that includes this is compiled for one
/// instruction set (see vector.hpp for what that asks).
namespace maupertuis::lanes {
namespace {

using series::Divisor;
using series::Vec;

template <int W>
class Machine {
 public:
  using V = Vec<W>;

  Machine(const PlanView& plan, V* rows, const V* constants, V* scratch)
      : p_(plan), n_(plan.unknowns), rows_{plan.instructions, plan.terms, constants, rows, plan.stride} {
    const auto take = [&scratch](std::size_t count) {
      V* const from = scratch;
      scratch += count;
      return from;
    };
    factors_ = take(p_.factor_count);
    tangents_ = take(p_.tangent_count);
    matrix_ = take(n_ * n_);
    inverse_pivots_ = take(n_);
    accelerations_ = take(n_);
    direction_ = take(n_);
  }

  V run(int stages) {
    V quality(1), check(0);
    for (int stage = p_.first_stage; stage < stages; ++stage) {
      for (std::size_t i = 0; stage >= 0 && i < n_; ++i) row(stage + 2)[i] = V(0);
      for (std::size_t r = 0; r < p_.run_count; ++r)
        if (const int order = stage + 2 - p_.runs[r].lag; order >= 0)
          reference::RunAtOrder<V>(rows_, order)(p_.runs[r]);
      if (stage < 0) continue;
      if (stage == 0) quality = factor();
      check = check + solve(stage);
      correct(stage);
    }
    // Infinity and NaN times 0 are NaN, and a sum keeps it.
    return quality + check * 0.0;
  }

 private:
  V* row(int order) const { return rows_.first + static_cast<std::size_t>(order) * rows_.stride; }
  V& entry(std::size_t i, std::size_t j) const { return matrix_[i * n_ + j]; }

  void find_tangents() {
    for (std::size_t i = 0; i < p_.factor_count; ++i)
      factors_[i] = sparse::factor_at<V>(p_.factors[i], p_.terms, rows_.constants, row(0));
    tangents_[0] = V(1);
    for (std::size_t i = 0; i < p_.combination_count; ++i) {
      const Combination& c = p_.combinations[i];
      V sum(0);
      for (std::uint32_t k = c.first; k < c.last; ++k) {
        const V &factor = factors_[p_.pairs[k].factor], &operand = tangents_[p_.pairs[k].tangent];
        sum = c.chooses ? chosen(factor, operand, sum) : fma(factor, operand, sum);
      }
      tangents_[c.out] = sum;
    }
  }

  /// M₀ = L D Lᵀ: L in the lower triangle without its unit diagonal, 1/D beside it. Returns the quality.
  V factor() {
    find_tangents();
    for (std::size_t i = 0; i < n_ * n_; ++i) matrix_[i] = V(0);
    for (std::size_t i = 0; i < p_.mass_count; ++i)
      entry(p_.mass[i].row, p_.mass[i].column) = tangents_[p_.mass[i].tangent];
    const V symmetric = symmetry();
    V least(1), largest(0);
    for (std::size_t j = 0; j < n_; ++j) {
      const V ratio = eliminate(j);
      // A comparison with NaN is false: the smallest stays what it is not less than.
      least = select(least < ratio, least, ratio);
      largest = select(largest < ratio, ratio, largest);
    }
    return least / largest * symmetric;
  }

  /// 1 where M₀ is symmetric to rounding, as LinearSolver asks, else 0.
  V symmetry() const {
    constexpr double tolerance = 64 * 0x1p-52;
    V result(1);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const V below = entry(i, j), difference = below - entry(j, i);
        const V size = absolute(entry(i, i) * entry(j, j)) + below * below;
        result = select(size * (tolerance * tolerance) < difference * difference, V(0), result);
      }
    return result;
  }

  /// Column j of L. Returns its pivot in units of the diagonal element.
  V eliminate(std::size_t j) {
    const V diagonal = entry(j, j);
    V pivot = diagonal;
    // The row of D Lᵀ above the diagonal: what is left there of M₀ is not needed any more.
    for (std::size_t k = 0; k < j; ++k) pivot = fma(-entry(j, k), entry(k, j), pivot);
    inverse_pivots_[j] = V(1) / pivot;
    for (std::size_t i = j + 1; i < n_; ++i) {
      V sum = entry(i, j);
      for (std::size_t k = 0; k < j; ++k) sum = fma(-entry(i, k), entry(k, j), sum);
      entry(j, i) = sum;
      entry(i, j) = sum * inverse_pivots_[j];
    }
    return pivot / diagonal;
  }

  /// q̈_k = −M₀⁻¹ R_k. Returns a sum that is finite where they are.
  V solve(int stage) {
    V* const x = accelerations_;
    for (std::size_t i = 0; i < n_; ++i) {
      V sum = -row(stage)[p_.residual[i]];
      for (std::size_t k = 0; k < i; ++k) sum = fma(-entry(i, k), x[k], sum);
      x[i] = sum;
    }
    V check(0);
    for (std::size_t i = n_; i-- > 0;) {
      V sum = x[i] * inverse_pivots_[i];
      for (std::size_t k = i + 1; k < n_; ++k) sum = fma(-entry(k, i), x[k], sum);
      x[i] = sum;
      check = check + sum * 0.0;
    }
    return check;
  }

  /// Coefficient k + 2 − ℓ of a stored slot of lag ℓ follows q̈_k, divided by (k + 1)(k + 2), k + 1 or 1.
  void correct(int stage) {
    const Divisor by_both((stage + 1.0) * (stage + 2.0)), by_one(stage + 1.0);
    V* const position = row(stage + 2);
    for (std::size_t i = 0; i < n_; ++i) {
      position[i] = accelerations_[i] / by_both;
      direction_[i] = accelerations_[i] / by_one;
    }
    correct_lag(0, 0, position, position);
    correct_lag(1, p_.corrections_end[0], row(stage + 1), direction_);
    correct_lag(2, p_.corrections_end[1], row(stage), accelerations_);
  }

  void correct_lag(int lag, std::size_t first, V* to, const V* direction) {
    for (std::size_t i = first; i < p_.corrections_end[lag]; ++i) {
      const Correction& c = p_.corrections[i];
      V sum = to[c.slot];
      for (std::uint32_t t = c.first; t < c.last; ++t) {
        const CorrectionTerm& term = p_.correction_terms[t];
        sum = fma(tangents_[term.tangent], direction[term.direction], sum);
      }
      to[c.slot] = sum;
    }
  }

  const PlanView& p_;
  std::size_t n_;
  reference::Rows<V> rows_;
  V *factors_, *tangents_, *matrix_, *inverse_pivots_, *accelerations_, *direction_;
};

template <int W>
void expand(const PlanView& plan, double* rows, const double* constants, double* quality, double* scratch, int stages) {
  using V = Vec<W>;
  const auto vectors = [](double* numbers) { return reinterpret_cast<V*>(numbers); };
  Machine<W>(plan, vectors(rows), reinterpret_cast<const V*>(constants), vectors(scratch)).run(stages).store(quality);
}

inline Expanders expanders_of_this_file() { return {{expand<1>, expand<2>, expand<4>, expand<8>, expand<16>}}; }

}  // namespace
}  // namespace maupertuis::lanes
