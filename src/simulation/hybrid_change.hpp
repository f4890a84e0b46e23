#pragma once
#include "simulation/hybrid_impacts.hpp"
#include "simulation/hybrid_modes.hpp"
#include "simulation/hybrid_neighbours.hpp"
#include "simulation/hybrid_space.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// Why a motion cannot go on.
struct Trouble {
  StepEnding ending = StepEnding::None;
  std::string reason;
};

/// What happens at an instant, and the mode after it: what events set, impacts, slips that come to rest or begin, and
/// the mode that fits.
class ModeChange {
 public:
  ModeChange(const Problem& problem, State& here, UsualSizes& sizes, SpaceSlips& slips, ModeMotions& motions,
             Events& events, StateFunctions& functions, Carried& carried, Journal& journal, Neighbours& neighbours);
  void start();

  /// Settles what a step has met: the motion goes on in the mode after it. Nothing where all is well.
  std::optional<Trouble> settle(Met& met, double bound, bool forwards);

  bool has_started() const { return has_started_; }
  bool is_just_released(std::size_t contact) const { return trials_.is_just_released(contact); }
  bool has_bounced(std::size_t contact) const { return impacts_.has_bounced(contact); }
  double cone_residual() const { return space_.cone_residual(); }

 private:
  // Why the motion cannot go on, where that is so.
  std::optional<std::string> trouble_of_sets(Met& met);
  std::optional<std::string> trouble_of_hits(Met& met, std::vector<std::size_t>& touching, double bound);
  std::optional<std::string> trouble_of_hit(Met& met, std::vector<std::size_t>& touching);
  std::optional<std::string> trouble_of_sticking(const Met& met, const std::vector<std::size_t>& touching) const;
  std::optional<std::string> trouble_of_mode(Met& met, std::vector<std::size_t>& touching, double bound);
  void go_on_in(const Found& found, const Met& met);

  const Problem& problem_;
  State& here_;
  UsualSizes& sizes_;
  SpaceSlips& slips_;
  ModeMotions& motions_;
  Events& events_;
  StateFunctions& functions_;
  Carried& carried_;
  Journal& journal_;
  Neighbours& neighbours_;
  Choices choices_;
  ContactCones cones_;
  SpaceFriction space_;
  UndeterminedForces undetermined_;
  JointForces forces_;
  ModeTrials trials_;
  ModeChoice choice_;
  Impacts impacts_;
  bool has_started_ = false;
};

}  // namespace maupertuis::hybrid
