#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "kernel/extended/workspace.hpp"

#include <maupertuis/extended.hpp>

#include <optional>

namespace maupertuis::extended {

/// One impulse after the other without friction (sequential_impact of simulation/contact, over T): the contact whose
/// |ġ|/√(G M⁻¹ Gᵀ) is largest comes first, with ġ⁺ = −e ġ⁻, until none closes.
template <class T>
class Impact {
 public:
  struct Blow {
    std::size_t contact;
    T impulse, speed;  // Λ; −ġ before
  };

  /// `here`: evaluated at the state. `contacts`: those that touch.
  Impact(const ExtendedProblem& problem, const Workspace<T>& here, std::span<const std::size_t> contacts)
      : n_(problem.kernel.freedoms()), m_(problem.kernel.constraints()), contacts_(contacts.begin(), contacts.end()) {
    for (const std::size_t c : contacts_) {
      const std::size_t at = problem.first_contact + c * (2 + n_);
      Row row{here.observable(at), here.observable(at + 1), std::vector<T>(n_), {}};
      for (std::size_t i = 0; i < n_; ++i) row.normal[i] = here.observable(at + 2 + i);
      rows_.push_back(std::move(row));
    }
    find_responses(here);
  }

  T rate(std::size_t k, std::span<const T> v) const { return rows_[k].drive + along(rows_[k].normal, v); }
  /// Σ |terms of ġ|
  T scale(std::size_t k, std::span<const T> v) const {
    T out = abs(rows_[k].drive);
    for (std::size_t i = 0; i < n_; ++i) out += abs(rows_[k].normal[i] * v[i]);
    return out;
  }

  /// What it does to v; rates below `rest` [contacts] are 0. Nothing where the impulses do not come to an end.
  std::optional<std::vector<Blow>> carry_out(std::vector<T>& v, std::span<const T> rest) const {
    constexpr std::size_t most = 1000;  // a contact
    std::vector<Blow> out;
    for (;;) {
      std::optional<std::size_t> next;
      T fastest = T(0);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const T closing = -rate(k, v);
        if (!(closing > rest[k])) continue;
        const T speed = closing / sqrt(along(rows_[k].normal, rows_[k].response));
        if (!next || speed > fastest * (1 + T(1e-12))) next = k, fastest = speed;
      }
      if (!next) return out;
      if (out.size() >= most * rows_.size()) return std::nullopt;
      const Row& row = rows_[*next];
      const T closing = -rate(*next, v), impulse = (1 + row.restitution) * closing / along(row.normal, row.response);
      for (std::size_t i = 0; i < n_; ++i) v[i] += impulse * row.response[i];
      out.push_back({contacts_[*next], impulse, closing});
    }
  }

 private:
  struct Row {
    T drive, restitution;
    std::vector<T> normal, response;  // ∂g/∂q; what a unit of impulse changes in q̇
  };

  T along(std::span<const T> row, std::span<const T> x) const {
    T sum = T(0);
    for (std::size_t i = 0; i < n_; ++i) sum += row[i] * x[i];
    return sum;
  }

  /// [M Aᵀ; A 0] (x, ·) = (normal, 0)
  void find_responses(const Workspace<T>& here) {
    const std::size_t size = n_ + m_;
    std::vector<T> matrix(size * size, T(0));
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) matrix[i * size + j] = here.mass(i, j);
      for (std::size_t k = 0; k < m_; ++k)
        matrix[i * size + n_ + k] = matrix[(n_ + k) * size + i] = here.constraint_matrix(k, i);
    }
    LinearSolver<T> solver;
    solver.factor(matrix, size, epsilon_to<T>(0.9));
    for (Row& row : rows_) {
      row.response = row.normal;
      row.response.resize(size, T(0));
      solver.solve(row.response);
    }
  }

  std::size_t n_, m_;
  std::vector<std::size_t> contacts_;
  std::vector<Row> rows_;
};

}  // namespace maupertuis::extended
