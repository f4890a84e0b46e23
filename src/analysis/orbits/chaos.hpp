#pragma once
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/orbits.hpp>

#include <eigen3/Eigen/Core>
#include <vector>

namespace maupertuis::orbits {

/// The linear span of states, each less the first.
class StateSpan {
 public:
  void add(const Eigen::VectorXd& x);
  /// Root mean squares along the principal directions, each component in units of its rounding.
  Eigen::VectorXd in_roundings() const;

 private:
  Eigen::VectorXd first_, magnitudes_;  // the largest of each component
  Eigen::MatrixXd rows_;                // of the first `filled_` the singular values are those of all states
  Eigen::Index filled_ = 0;
  std::size_t states_ = 0;
};

/// What is seen of a motion while its exponents are averaged.
class VisitedStates {
 public:
  /// `sizes` [2n] of the motion.
  VisitedStates(const MechanicalSystem& system, const Eigen::VectorXd& sizes) : system_(system), sizes_(sizes) {}

  /// `growth`: the logarithm of the factor by which neighbours, and rounding with them, have grown so far.
  void add(const MotionState& state, double growth);
  /// A state before the average begins.
  void add_of_transient(const MotionState& state, double growth);

  /// How many dimensions of the state space the motion fills at most, flat ones counted: those along which the states
  /// differ by more than the rounding of each component. None where it rests.
  std::size_t most_dimensions() const;
  /// How many it fills for certain, three that is enough: along these states differed by more than rounding can have
  /// grown to.
  std::size_t certain_dimensions() const;
  /// The logarithm of the factor by which the largest state of the second half exceeds that of the first; angles
  /// without bound are no large states.
  double growth_of_second_half() const;
  /// The most oscillations of a coordinate in this time: its way over twice the range that was seen, of angles a turn
  /// at most.
  double oscillations(double duration) const;
  /// Which part of a unit vector in units of the sizes [2n] lies along coordinates that have not moved, or gone one way
  /// and at most once back, with their velocities.
  double share_without_return(const Eigen::VectorXd& direction) const;
  /// Whether it goes to and fro, and on as fast as it began: it neither comes to rest nor creeps.
  bool keeps_moving(double duration) const;

 private:
  std::size_t certain_now() const;
  bool comes_back(Eigen::Index component) const;

  const MechanicalSystem& system_;
  Eigen::VectorXd sizes_, first_, last_, ways_, lowest_, highest_;
  Eigen::VectorXd slowest_, fastest_;  // [n] velocities
  Eigen::VectorXd variation_;          // [2n] Σ |change| from state to state
  StateSpan averaged_, whole_;         // whole_: with the transient, before rounding has grown
  double growth_ = 0;                  // the largest so far
  std::size_t certain_ = 0, seen_ = 0;
  std::vector<double> largest_;  // [states] component of each
  std::vector<double> speeds_;   // [states] the largest velocity of each, in units of the sizes
};

/// Of the growth of the fastest neighbours, as logarithms.
struct GrowthOfNeighbours {
  double whole = 0, second_half = 0;  // over the run
  double log_of_time = 0;             // the logarithm of the growth of t over the run: a power p gives p times that
  double certain = 0;                 // what must be exceeded, by the errors of the exponent
  double share_without_return = 0;    // of their direction, along coordinates that do not come back
};

/// What growth says where a state has d directions and t stands in the equations, or not. The neighbours of a regular
/// motion part like t^(d−1) at most. `flows`: no impact, event or friction sets the state, so that a plane of states
/// holds no chaos (Poincaré and Bendixson).
Chaos chaos_of(const GrowthOfNeighbours& growth, const VisitedStates& states, double duration, std::size_t d,
               bool driven, bool flows);

}  // namespace maupertuis::orbits
