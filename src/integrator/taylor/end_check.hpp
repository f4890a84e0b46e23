#pragma once
#include <maupertuis/disks.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Tolerance of SafeLength that belongs to a tolerance of steps. Cauchy's bound overestimates, by some four digits at rounding level.
double safe_tolerance(double tolerance);

/// The end of a step as a check: does the polynomial's q̈ there satisfy the equations? h |Δq̈_i| must be small against the velocities that the
/// coordinate has had, or not above what the rounding of q, q̇ and t changes of q̈.
class EndCheck {
 public:
  EndCheck(std::size_t freedoms, double tolerance);

  void forget();
  /// Velocities at a point, and h q̈, belong to what has been. h may be infinite.
  void note_rates(const KernelWorkspace& work, double h);
  /// [n] largest |q̇_i| and h |q̈_i| so far.
  std::span<const double> rates() const { return rates_; }
  /// Of [n] q̈ by the polynomial and by the equations. h: length of the step.
  bool agrees(std::span<const double> by_polynomial, const KernelWorkspace& by_equations, double h) const;
  /// The same where the first look failed. `roundings`: [n] what rounding makes of q̈.
  bool agrees_but_for_rounding(std::span<const double> by_polynomial, std::span<const double> by_equations, std::span<const double> roundings, double h) const;

 private:
  double allowed_;
  std::vector<double> rates_;
};

/// [n] What rounding of the values of the residual makes of q̈ at the point that the workspace and the disks hold; 0 where there are too many
/// unknowns to tell, or their matrix is singular. `length`: of the step. Cost: (n + m)³.
std::vector<double> acceleration_roundings(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, Disks& disks, double length);

}  // namespace maupertuis::taylor
