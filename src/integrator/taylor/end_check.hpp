#pragma once
#include <maupertuis/disks.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Tolerance of SafeLength that belongs to a tolerance of steps. Cauchy's bound overestimates, by some four digits at
/// rounding level.
double safe_tolerance(double tolerance);

/// The end of a step as a check: does the polynomial's q̈ there satisfy the equations? h |Δq̈_i| must be small against
/// the velocities that the coordinate has had, or not above what the rounding of q, q̇ and t changes of q̈.
class EndCheck {
 public:
  EndCheck(std::size_t freedoms, double tolerance);

  void forget();
  /// Velocities at a point, and h q̈, belong to what has been: [n] each, `step` apart, q̈/2 as coefficients of order 2
  /// are. h may be infinite.
  void note_rates(const double* v, const double* half_a, std::size_t step, double h);
  /// [n] largest |q̇_i| and h |q̈_i| so far.
  std::span<const double> rates() const { return rates_; }
  /// Of [n] q̈ by the polynomial and by the equations. h: length of the step.
  bool agrees(std::span<const double> by_polynomial, const double* half_by_equations, std::size_t step, double h) const;
  /// The same against the fastest coordinate: for a step that halving did not mend.
  bool agrees_on_the_whole(std::span<const double> by_polynomial, const double* half_by_equations, double h) const;
  /// The same where the first look failed. `roundings`: [n] what rounding makes of q̈.
  bool agrees_but_for_rounding(std::span<const double> by_polynomial, std::span<const double> by_equations,
                               std::span<const double> roundings, double h) const;

  /// Of many unknowns the slow look below costs more than a step. What rounding made of q̈ there, in units of the
  /// largest, counts at the next few ends too. Of n accelerations by the equations.
  void note_roundings(std::span<const double> roundings, std::span<const double> by_equations);
  bool agrees_as_noted(std::span<const double> by_polynomial, std::span<const double> by_equations, double h);

 private:
  double allowed_;
  std::vector<double> rates_;
  std::vector<double> noted_;  // [n], or none
  std::size_t ends_left_ = 0;  // at which they count
};

/// The inverse of the bordered matrix costs the third power of its unknowns: of many it is not asked for.
inline bool has_bordered_matrix(std::size_t freedoms, std::size_t constraints) { return freedoms + constraints <= 64; }

/// B = ∂R/∂(q̈, λ) at the point that a workspace holds, [(n + m)²]; empty where it is not asked for.
template <class Work>
std::vector<double> bordered_matrix(const Work& work, std::size_t freedoms, std::size_t constraints) {
  const std::size_t n = freedoms, unknowns = freedoms + constraints;
  if (!has_bordered_matrix(n, constraints)) return {};
  std::vector<double> b(unknowns * unknowns, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) b[i * unknowns + j] = static_cast<double>(work.mass(i, j));
  for (std::size_t j = 0; j < constraints; ++j)
    for (std::size_t i = 0; i < n; ++i)
      b[(n + j) * unknowns + i] = b[i * unknowns + n + j] = static_cast<double>(work.constraint_matrix(j, i));
  return b;
}

/// [n] Σ_j |B⁻¹_ij| e_j, at least e_k/√(M_ii M_kk) of all k that a constraint ties to i: what rounding of the residual
/// makes of q̈ at the centre of the disks; 0 where B is empty or singular. `unit`: the rounding of 1; `length`: of a
/// step.
std::vector<double> acceleration_roundings(std::vector<double> bordered, std::size_t freedoms, std::size_t constraints,
                                           Disks& disks, double length, double unit);

/// The slow look at the end of a step of length h, where the quick one failed. `point` has the parameters and sides of
/// the step; `disks` are of its program, and have its constants afterwards. half_by_equations: ½ q̈_i at [i · step]; it
/// may be that of `point`, which is evaluated anew.
bool agrees_but_for_rounding(EndCheck& check, std::span<const double> by_polynomial, const double* half_by_equations,
                             std::size_t step, KernelWorkspace& point, double t, std::span<const double> q,
                             std::span<const double> v, double h, Disks& disks);

}  // namespace maupertuis::taylor
