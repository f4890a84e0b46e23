#pragma once
#include "kernel/extended/workspace.hpp"

#include <maupertuis/extended.hpp>

namespace maupertuis::extended {

/// Brings a start that is on the constraints to rounding of double onto them to rounding of T: what is fixed is kept,
/// the rest makes the smallest change, of positions in the metric of the diagonal of M, of velocities in that of M.
template <class T>
class Start {
 public:
  Start(Workspace<T>& work, const ExtendedProblem& problem)
      : work_(work), problem_(problem), n_(problem.kernel.freedoms()) {}

  void improve(const T& t, std::vector<T>& q, std::vector<T>& v) {
    for (const bool positions : {true, false})
      for (int turn = 0; turn < 12; ++turn) {
        work_.evaluate(t, q, v);
        std::vector<T>& x = positions ? q : v;
        const std::vector<T> step = least_step(positions);
        T change = T(0), size = T(0);
        for (std::size_t i = 0; i < n_; ++i) {
          if (!is_finite(step[i])) return;
          x[i] += step[i];
          change = std::max(change, T(abs(step[i]))), size = std::max(size, T(abs(x[i])));
        }
        if (change <= 4 * epsilon<T>() * size) break;
      }
  }

 private:
  struct Row {
    std::vector<T> a;
    T error;
  };

  std::vector<Row> rows(bool positions) const {
    std::vector<Row> out;
    for (std::size_t j = 0; j < problem_.kernel.constraints(); ++j) {
      if (positions && problem_.kernel.program().constraint_values[j] == no_slot) continue;
      Row row{std::vector<T>(n_), positions ? work_.constraint_value(j) : work_.constraint_rate(j)};
      for (std::size_t i = 0; i < n_; ++i) row.a[i] = work_.constraint_matrix(j, i);
      out.push_back(std::move(row));
    }
    for (std::size_t j = 0; j < problem_.conditions.size(); ++j) {
      if (problem_.conditions[j] != positions) continue;
      const std::size_t at = problem_.first_condition + j * (n_ + 1);
      Row row{std::vector<T>(n_), work_.observable(at)};
      for (std::size_t i = 0; i < n_; ++i) row.a[i] = work_.observable(at + 1 + i);
      out.push_back(std::move(row));
    }
    return out;
  }

  T metric(bool positions, std::size_t i, std::size_t j) const {
    if (!positions) return work_.mass(i, j);
    if (i != j) return T(0);
    return work_.mass(i, i) > 0 ? work_.mass(i, i) : T(1);
  }

  /// The smallest δ of the free unknowns with a δ = −error: [G aᵀ; a 0] (δ, μ) = (0, −error).
  std::vector<T> least_step(bool positions) {
    const std::vector<bool>& fixed = positions ? problem_.fixed_q : problem_.fixed_v;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n_; ++i)
      if (!fixed[i]) free.push_back(i);
    const std::vector<Row> all = rows(positions);
    const std::size_t f = free.size(), size = f + all.size();
    std::vector<T> matrix(size * size, T(0)), right(size, T(0));
    for (std::size_t i = 0; i < f; ++i)
      for (std::size_t j = 0; j < f; ++j) matrix[i * size + j] = metric(positions, free[i], free[j]);
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (std::size_t i = 0; i < f; ++i) matrix[(f + k) * size + i] = matrix[i * size + f + k] = all[k].a[free[i]];
      right[f + k] = -all[k].error;
    }
    LinearSolver<T> solver;
    solver.factor(matrix, size, epsilon_to<T>(0.3));
    solver.solve(right);
    std::vector<T> step(n_, T(0));
    for (std::size_t i = 0; i < f; ++i) step[free[i]] = right[i];
    return step;
  }

  Workspace<T>& work_;
  const ExtendedProblem& problem_;
  std::size_t n_;
};

}  // namespace maupertuis::extended
