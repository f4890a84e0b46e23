#pragma once
#include "simulation/hybrid_events.hpp"
#include "simulation/hybrid_found.hpp"
#include "simulation/hybrid_undetermined.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// Whether the motion in a mode keeps its conditions: gaps that do not close, forces that press, friction that holds or
/// opposes.
class ModeTrials {
 public:
  ModeTrials(const Problem& problem, const State& here, UsualSizes& sizes, const SpaceSlips& slips,
             ModeMotions& motions, const UndeterminedForces& undetermined, const Events& events)
      : problem_(problem),
        here_(here),
        sizes_(sizes),
        slips_(slips),
        motions_(motions),
        undetermined_(undetermined),
        events_(events) {}
  void start();
  /// Contacts whose force comes to 0 at this instant are released.
  void begin_instant(const Met& met);
  void end_instant(const ContactMode& mode);

  /// Whether a mode fits, with its accelerations.
  bool fits(Found& found, const Instant& at, Leniency leniency);
  /// After others were tried: the motion of this mode begins here again.
  void begin_again(Found& found, const Instant& at) { static_cast<void>(fits(found, at, Leniency::Gaps)); }
  /// Frictions that the mode holds beyond their limits; nothing where it has no motion.
  std::optional<std::vector<std::size_t>> beyond_limits(Found& found, const Instant& at);
  /// What acts without contacts and friction is a measure of forces, where all is at rest the only one: what rounding
  /// of forces that balance makes of slips is to be told from motion.
  void measure_forces(const Instant& at);
  /// Whether a mode has the forces of the one before at this instant: frictions that have come to their limit, with
  /// μ_s = μ, give way against their force, contacts open whose force has come to 0, and all else stays.
  ///
  ///     λ_t = −μ_s N: it slides forwards        λ_t = μ_s N: it slides backwards
  bool changes_no_force(const ContactMode& mode, const Met& met, const ContactValues& values) const;
  /// Whether these accelerations are those of the mode before, to what a located instant leaves of them.
  bool accelerations_go_on(std::span<const double> accelerations, const Met& met) const;

  /// A contact that the constraints of the mode that was tried last move through zero.
  const std::optional<std::size_t>& moved_through_zero() const { return moved_through_zero_; }
  void forget_moved() { moved_through_zero_.reset(); }
  /// Why the mode that was tried last has none, if that is so.
  const std::string& no_motion() const { return no_motion_; }
  const std::vector<bool>& released() const { return released_; }
  void set_released(std::vector<bool> released) { released_ = std::move(released); }
  /// Where a contact opens since λ falls through 0 its gap begins as the third power of time: what rounding makes of
  /// its first two is no hit.
  bool is_just_released(std::size_t contact) const;

 private:
  struct Trial;
  bool vanishes(const Watch& watch, double size, const ContactValues& values) const;
  bool presses_again(std::size_t contact, std::span<const double> accelerations, double digits) const;
  bool begins_slowly(const Watch& slip, const ContactMode& mode, const Met& met, const ContactValues& values) const;

  const Problem& problem_;
  const State& here_;
  UsualSizes& sizes_;
  const SpaceSlips& slips_;
  ModeMotions& motions_;
  const UndeterminedForces& undetermined_;
  const Events& events_;
  std::vector<bool> released_;       // [contacts] λ is 0 to rounding at this instant, and falls
  std::vector<double> released_at_;  // [contacts] when that was last; not a number before
  std::optional<std::size_t> moved_through_zero_;
  std::string no_motion_;
  std::size_t looks_at_forces_ = 0;  // where friction gave way
};

}  // namespace maupertuis::hybrid
