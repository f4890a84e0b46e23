#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// What the evaluation of a constraint leaves by rounding, relative to the sizes of its terms.
inline constexpr double rounding_of_constraints = 1e-14;

/// Sizes of a motion that are known from elsewhere, [n] each or empty.
struct UsualSizes {
  std::vector<double> q, v, a;  // of q, q̇, q̈
};

/// The largest of φ, and of dφ/dt or ψ, at the point of the workspace, each divided by the sizes of its terms and by
/// how far they change in a step of length h or in a motion of the usual sizes, so that a constraint such as y = 0 has
/// a measure too.
double constraint_error(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                        const UsualSizes& usual = {});

/// How far corrections of q and q̇ go, relative to q̇ and to what it moves in a step of length h, in the metric of the
/// diagonal of M.
double correction_size(const KernelWorkspace& work, std::size_t constraints, std::span<const double> dq,
                       std::span<const double> dv, double h, const UsualSizes& usual = {});

/// The same of a start, with coordinates that have no inertia beside those that have.
double start_shift(const KernelWorkspace& work, std::size_t constraints, std::span<const double> dq,
                   std::span<const double> dv, double h);

/// What the steps so far have shown of the constraints.
struct ConstraintRecord {
  ConstraintRecord(std::size_t freedoms, std::size_t constraints)
      : dq(freedoms), dv(freedoms), largest_row(constraints, 0.0) {}

  void start();
  /// Whether a row of A has gone to zero, in units of what it was: its multiplier has a pole there.
  bool has_vanishing_row(const KernelWorkspace& work);

  std::vector<double> dq, dv;   // [n] scratch: back to the constraints
  double residual = 0;          // the largest that a step has left
  double restraint = 1;         // of the lengths that the control chooses
  double best_pivot_ratio = 0;  // of the bordered matrix
  std::size_t most_in_force = 0;
  std::vector<double> largest_row;  // [constraints] of A
  UsualSizes usual;
  static constexpr double vanishing = 1e-6;
};

}  // namespace maupertuis::taylor
