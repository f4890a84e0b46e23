#pragma once
#include "kernel/extended/linear_solver.hpp"
#include "kernel/extended/workspace.hpp"

#include <maupertuis/extended.hpp>

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::extended {

template <class T>
T along(std::span<const T> row, std::span<const T> x) {
  T sum = T(0);
  for (std::size_t i = 0; i < row.size(); ++i) sum += row[i] * x[i];
  return sum;
}

/// What contacts and frictions are at one point (ContactValues of simulation/contact, over T).
template <class T>
struct ContactPoint {
  /// `here`: the kernel of the problem, evaluated at the point.
  ContactPoint(const ExtendedProblem& problem, const Workspace<T>& here, std::span<const T> v) {
    const ExtendedContacts& all = problem.contacts;
    const std::size_t n = v.size();
    const auto row_at = [&](std::size_t first) {
      std::vector<T> row;
      for (std::size_t i = 0; i < n; ++i) row.push_back(here.observable(first + i));
      return row;
    };
    for (std::size_t c = 0; c < all.count; ++c) {
      const std::size_t at = all.first + c * (2 + n), event = problem.until + problem.events.size() + c;
      gap.push_back(here.event(event, 0));
      gap_scale.push_back(here.event_scale(event));
      drive.push_back(here.observable(at));
      restitution.push_back(here.observable(at + 1));
      normal.push_back(row_at(at + 2));
      rate.push_back(drive.back() + along<T>(normal.back(), v));
    }
    std::size_t second = all.first_second_slip;
    for (std::size_t f = 0; f < all.frictions.size(); ++f) {
      const std::size_t at = all.first_slip + f * (3 + n);
      slip.push_back(here.observable(at));
      friction.push_back(here.observable(at + 1));
      fixed.push_back(here.observable(at + 2));
      tangent.push_back(row_at(at + 3));
      slip_drive.push_back(slip.back() - along<T>(tangent.back(), v));
      second_slip.push_back(T(0)), second_drive.push_back(T(0));
      second_tangent.emplace_back();
      if (!all.frictions[f].in_space) continue;
      second_slip.back() = here.observable(second);
      second_tangent.back() = row_at(second + 1);
      second_drive.back() = second_slip.back() - along<T>(second_tangent.back(), v);
      second += 1 + n;
    }
  }

  T slip_speed(std::size_t f) const { return sqrt(T(slip[f] * slip[f] + second_slip[f] * second_slip[f])); }

  std::vector<T> gap, gap_scale, rate, drive, restitution;  // [contacts]
  std::vector<std::vector<T>> normal;                       // [contacts][n]
  std::vector<T> slip, slip_drive, friction, fixed;         // [contacts + frictions]
  std::vector<std::vector<T>> tangent;                      // [contacts + frictions][n]
  std::vector<T> second_slip, second_drive;                 // [contacts + frictions] in space
  std::vector<std::vector<T>> second_tangent;               // [contacts + frictions][n], empty in the plane
};

/// x of [M Aᵀ; A 0] (x, ·) = (row, 0): what an impulse along a row changes in q̇.
template <class T>
class Responses {
 public:
  explicit Responses(const Workspace<T>& here) : n_(here.program().freedoms), size_(here.program().unknowns) {
    std::vector<T> matrix(size_ * size_, T(0));
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) matrix[i * size_ + j] = here.mass(i, j);
      for (std::size_t k = 0; k < size_ - n_; ++k)
        matrix[i * size_ + n_ + k] = matrix[(n_ + k) * size_ + i] = here.constraint_matrix(k, i);
    }
    solver_.factor(matrix, size_, epsilon_to<T>(0.9));
  }
  std::vector<T> of(std::vector<T> row) const {
    row.resize(size_, T(0));
    solver_.solve(row);
    row.resize(n_);
    return row;
  }

 private:
  std::size_t n_, size_;
  LinearSolver<T> solver_;
};

}  // namespace maupertuis::extended
