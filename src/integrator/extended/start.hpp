#pragma once
#include "kernel/extended/workspace.hpp"

#include <maupertuis/extended.hpp>

namespace maupertuis::extended {

/// Brings a start that is on the constraints to rounding of double onto them to rounding of T: what is fixed is kept,
/// the rest makes the smallest change, of positions in the metric of the diagonal of M, of velocities in that of M;
/// where a degenerate Lagrangian relates them, of both together.
template <class T>
class Start {
 public:
  Start(Workspace<T>& work, const ExtendedProblem& problem)
      : work_(work), problem_(problem), n_(problem.kernel.freedoms()) {}

  void improve(const T& t, std::vector<T>& q, std::vector<T>& v) {
    if (problem_.relations > 0) return improve_together(t, q, v);
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

  /// A relation of a degenerate Lagrangian may tie a coordinate to velocities.
  void improve_together(const T& t, std::vector<T>& q, std::vector<T>& v) {
    std::vector<bool> fixed = problem_.fixed_q;
    fixed.insert(fixed.end(), problem_.fixed_v.begin(), problem_.fixed_v.end());
    const auto plain = [](std::size_t i, std::size_t j) { return T(i == j); };
    for (int turn = 0; turn < 12; ++turn) {
      work_.evaluate(t, q, v);
      std::vector<Row> relations;
      for (std::size_t k = 0; k < problem_.relations; ++k)
        relations.push_back(row_at(problem_.first_relation + k * (2 * n_ + 1), 2 * n_));
      const std::vector<T> step = least_step(relations, fixed, plain);
      T change = T(0), size = T(0);
      for (std::size_t i = 0; i < 2 * n_; ++i) {
        if (!is_finite(step[i])) return;
        T& x = i < n_ ? q[i] : v[i - n_];
        x += step[i];
        change = std::max(change, T(abs(step[i]))), size = std::max(size, T(abs(x)));
      }
      if (change <= 4 * epsilon<T>() * size) break;
    }
  }

  /// An observable and, after it, its derivatives.
  Row row_at(std::size_t observable, std::size_t unknowns) const {
    Row row{std::vector<T>(unknowns), work_.observable(observable)};
    for (std::size_t i = 0; i < unknowns; ++i) row.a[i] = work_.observable(observable + 1 + i);
    return row;
  }

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
      out.push_back(row_at(problem_.first_condition + j * (n_ + 1), n_));
    }
    return out;
  }

  T metric(bool positions, std::size_t i, std::size_t j) const {
    if (!positions) return work_.mass(i, j);
    if (i != j) return T(0);
    return work_.mass(i, i) > 0 ? work_.mass(i, i) : T(1);
  }

  std::vector<T> least_step(bool positions) const {
    return least_step(rows(positions), positions ? problem_.fixed_q : problem_.fixed_v,
                      [&](std::size_t i, std::size_t j) { return metric(positions, i, j); });
  }

  /// The smallest δ of the free unknowns with a δ = −error: [G aᵀ; a 0] (δ, μ) = (0, −error).
  template <class Metric>
  static std::vector<T> least_step(const std::vector<Row>& all, const std::vector<bool>& fixed, const Metric& metric) {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (!fixed[i]) free.push_back(i);
    const std::size_t f = free.size(), size = f + all.size();
    std::vector<T> matrix(size * size, T(0)), right(size, T(0));
    for (std::size_t i = 0; i < f; ++i)
      for (std::size_t j = 0; j < f; ++j) matrix[i * size + j] = metric(free[i], free[j]);
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (std::size_t i = 0; i < f; ++i) matrix[(f + k) * size + i] = matrix[i * size + f + k] = all[k].a[free[i]];
      right[f + k] = -all[k].error;
    }
    LinearSolver<T> solver;
    solver.factor(matrix, size, epsilon_to<T>(0.3));
    solver.solve(right);
    std::vector<T> step(fixed.size(), T(0));
    for (std::size_t i = 0; i < f; ++i) step[free[i]] = right[i];
    return step;
  }

  Workspace<T>& work_;
  const ExtendedProblem& problem_;
  std::size_t n_;
};

}  // namespace maupertuis::extended
