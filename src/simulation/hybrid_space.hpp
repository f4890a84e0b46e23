#pragma once
#include "simulation/hybrid_carried.hpp"
#include "simulation/hybrid_cones.hpp"
#include "simulation/hybrid_functions.hpp"
#include "simulation/hybrid_motions.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// Friction in the planes of contacts in space: slow slips are brought to rest, and which contacts stick, and which way
/// others begin to slide, is read off their cones.
class SpaceFriction {
 public:
  SpaceFriction(const Problem& problem, State& here, UsualSizes& sizes, SpaceSlips& slips, ModeMotions& motions,
                const Choices& choices, const ContactCones& cones, StateFunctions& functions, Carried& carried)
      : problem_(problem),
        here_(here),
        sizes_(sizes),
        slips_(slips),
        motions_(motions),
        choices_(choices),
        cones_(cones),
        functions_(functions),
        carried_(carried) {}
  void start() { cone_residual_ = -1; }

  /// A slip that is slow and falls comes to rest after v_t²/(−v_t·v̇_t): the motion moves on to there, where both
  /// components are 0. One that grows has just begun.
  void come_to_rest(const std::vector<std::size_t>& touching, double bound, bool forwards);
  /// What the moment leaves of slips that stop: the least change of velocities that ends them and opens no contact.
  /// Friction alone takes part in it, whose impulse is what ends a slip, however its direction turned meanwhile and
  /// whenever in the moment it ended.
  void take_out_slips(const std::vector<std::size_t>& stopping, const std::vector<std::size_t>& touching);
  /// Where contacts in space rest on friction: each sticks, or begins to slide against the force that the cones give.
  /// `all_give_way`: no forces hold the rest any more. False where the cones have no solution that is found.
  bool choose_slips(const std::vector<std::size_t>& touching, const Met& met, double bound, bool all_give_way);

  /// How far from the conditions of their cones forces were, of the largest; negative where none were sought.
  double cone_residual() const { return cone_residual_; }

 private:
  struct Slowing;
  struct Stopping;
  bool is_slow(std::size_t contact, const ContactValues& values) const;
  std::optional<Slowing> slowing(const std::vector<std::size_t>& touching, const ContactValues& values, double bound);
  Stopping stopping_with(double by, const Slowing& slowing, const std::vector<std::size_t>& touching,
                         const ContactValues& values) const;
  bool all_stop(const std::vector<std::size_t>& slow, const std::vector<std::size_t>& touching,
                const ContactValues& values, std::span<const double> accelerations, double within) const;
  void move_on(double by, const Eigen::VectorXd& accelerations);
  bool may_begin(std::size_t contact, const ContactValues& values) const;

  const Problem& problem_;
  State& here_;
  UsualSizes& sizes_;
  SpaceSlips& slips_;
  ModeMotions& motions_;
  const Choices& choices_;
  const ContactCones& cones_;
  StateFunctions& functions_;
  Carried& carried_;
  double cone_residual_ = -1;  // the largest so far
};

}  // namespace maupertuis::hybrid
