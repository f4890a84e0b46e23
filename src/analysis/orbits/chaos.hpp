#pragma once
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/orbits.hpp>

#include <eigen3/Eigen/Core>
#include <vector>

namespace maupertuis::orbits {

/// What is seen of a motion while its exponents are averaged.
class VisitedStates {
 public:
  /// `sizes` [2n] of the motion.
  VisitedStates(const MechanicalSystem& system, const Eigen::VectorXd& sizes) : system_(system), sizes_(sizes) {}

  void add(const MotionState& state);

  /// How many dimensions of the state space the motion fills, flat ones counted: to a millionth of its size.
  std::size_t dimensions() const;
  /// The logarithm of the factor by which the largest state of the second half exceeds that of the first; angles
  /// without bound are no large states.
  double growth_of_second_half() const;
  /// The most oscillations of a coordinate in this time: its way over twice the range that was seen, of angles a turn
  /// at most.
  double oscillations(double duration) const;
  /// Whether it goes to and fro, and on as fast as it began: it neither comes to rest nor creeps.
  bool keeps_moving(double duration) const;

 private:
  const MechanicalSystem& system_;
  Eigen::VectorXd sizes_, first_, ways_, lowest_, highest_;
  Eigen::MatrixXd moments_;      // Σ x xᵀ of the states seen from the first, in units of the sizes
  std::vector<double> largest_;  // [states] component of each
  std::vector<double> speeds_;   // [states] the largest velocity of each, in units of the sizes
};

/// Of the growth of the fastest neighbours, as logarithms.
struct GrowthOfNeighbours {
  double whole = 0, second_half = 0;  // over the run
  double log_of_time = 0;             // the logarithm of the growth of t over the run: a power p gives p times that
  double certain = 0;                 // what must be exceeded, by the errors of the exponent
};

/// What growth says where a state has d directions and t stands in the equations, or not. The neighbours of a regular
/// motion part like t^(d−1) at most. `flows`: no impact, event or friction sets the state, so that a plane of states
/// holds no chaos (Poincaré and Bendixson).
Chaos chaos_of(const GrowthOfNeighbours& growth, const VisitedStates& states, double duration, std::size_t d,
               bool driven, bool flows);

}  // namespace maupertuis::orbits
