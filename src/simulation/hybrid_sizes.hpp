#pragma once
#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/integrator.hpp>

#include <limits>
#include <span>
#include <vector>

namespace maupertuis::hybrid {

class State;

/// Of the sizes of terms: below, a gap or a speed is 0.
inline constexpr double rest_unit = 64 * std::numeric_limits<double>::epsilon();

/// What is rounding in a motion: measured by the largest that coordinates of one unit have done so far. Motions of one
/// kind of coordinates have one size: a pendulum that hangs still among others that swing is at rest to rounding of
/// their motion, not of its own.
class UsualSizes {
 public:
  explicit UsualSizes(const MechanicalSystem& system);
  /// Sizes that q and q̇ have elsewhere in the motion [n]: of later starts, what is much smaller is rounding.
  void set_elsewhere(std::span<const double> q, std::span<const double> v);
  void start();

  /// ġ below this counts as 0, and v_t.
  double rest_speed(std::size_t contact, const ContactValues& values) const;
  double rest_slip(std::size_t friction, const ContactValues& values) const;
  /// Of the terms of g so far, and of what rounding of its coordinates may make of it.
  double gap(std::size_t contact, const ContactValues& values) const;
  double fastest(std::size_t contact) const { return fastest_[contact]; }
  double fastest_slip(std::size_t friction) const { return fastest_slip_[friction]; }
  double widest(std::size_t contact) const { return widest_[contact]; }
  double hardest(std::size_t contact) const { return hardest_[contact]; }
  double slip_in_space(std::size_t contact) const { return slip_scale_[contact]; }
  double slip_rate(std::size_t contact) const { return slip_rate_[contact]; }
  double place(std::size_t coordinate) const { return place_[kind_[coordinate]]; }
  double speed(std::size_t coordinate) const { return speed_[kind_[coordinate]]; }
  double acceleration(std::size_t coordinate) const { return acceleration_[kind_[coordinate]]; }
  double acceleration_along(const SparseRow& row) const;
  /// g̈ of a contact with these accelerations, in units of the sizes of its terms.
  double opening_rate(std::size_t contact, std::span<const double> accelerations, const State& here) const;
  std::vector<double> accelerations() const;  // [n]
  void tell(TaylorStepper& stepper) const;

  void note(const State& here, const ContactValues& values);
  /// Gaps of one dimension have one size too.
  void note_gaps(const ContactValues& values);
  /// Of a start whose coordinates have had other sizes elsewhere: what gaps are made of then.
  void note_gaps_elsewhere(const ContactValues& values);
  void note_accelerations(std::span<const double> a, const ContactValues& values);
  void note_acceleration(std::size_t coordinate, double size);
  void note_slip_in_space(std::size_t contact, double size);
  /// Not while a mode is sought: the speed at which a slip stops depends on it, and with it the motion of a mode.
  void note_slip_rates(const ContactValues& values);
  /// |g̈| of contacts by a force λ = 1 of their own.
  void note_compliances(const std::vector<std::size_t>& contacts, const std::vector<SparseRow>& normals,
                        const Eigen::MatrixXd& response);
  /// Of all that touch at this instant. An impact asks for the same: M does not depend on the velocities.
  bool knows_compliances() const { return knows_compliances_; }
  void set_knows_compliances(bool knows) { knows_compliances_ = knows; }
  /// Forces of closed contacts and of static friction that grow while all rests: what they balance is a measure of
  /// forces too, of each coordinate that one of them would move alone. `multipliers`: those of contacts and frictions
  /// of the mode. Whether there were such.
  bool note_holding_forces(const ContactMode& mode, std::span<const double> multipliers, const State& here);
  bool knows_holding_forces(const ContactMode& mode) const;

 private:
  double left_by_time(const SparseRow& row, double t) const;

  const MechanicalSystem& system_;
  std::vector<std::size_t> kind_;                     // [n] coordinates of one dimension share a number
  std::vector<std::size_t> gap_kind_;                 // [contacts] so do gaps
  std::vector<double> place_, speed_, acceleration_;  // [kinds] |q|, |q̇|, |q̈|
  std::vector<double> fastest_, fastest_slip_;  // [contacts], [contacts + frictions] sizes of the terms of ġ and of v_t
  std::vector<double> widest_, hardest_;        // [contacts] sizes of the terms of g; of λ
  std::vector<double> compliance_;              // [contacts] what a force λ = 1 does to g̈, where it was needed
  bool knows_compliances_ = false;
  std::vector<double> holding_;                 // [2 contacts + frictions] normal and static forces that were measured
  std::vector<double> slip_scale_, slip_rate_;  // [contacts] of friction in space, and how fast they change
  std::vector<double> elsewhere_q_, elsewhere_v_;  // [n] or empty
};

}  // namespace maupertuis::hybrid
