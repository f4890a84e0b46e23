#pragma once
#include "simulation/hybrid_joint_forces.hpp"
#include "simulation/hybrid_journal.hpp"
#include "simulation/hybrid_trials.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis::hybrid {

/// Modes that are tried at an instant.
inline constexpr std::size_t most_choices = 1024;

/// What is said where rigid contact has no motion, or several.
inline constexpr const char* beyond_painleve =
    "Textbooks go on by an impact without collision, an impulse of the contact that is not hit; none is made here: a "
    "stiff spring in place of the rigid contact says what happens, as `force on P = (-μ N P.x'/sqrt(P.x'^2 + v0^2), "
    "N)` with N = k max(-P.y, 0) on a floor.";

/// Which mode follows an instant.
class ModeChoice {
 public:
  ModeChoice(const Problem& problem, const State& here, UsualSizes& sizes, const SpaceSlips& slips,
             ModeMotions& motions, const Choices& choices, JointForces& forces, UndeterminedForces& undetermined,
             ModeTrials& trials, Journal& journal)
      : problem_(problem),
        here_(here),
        sizes_(sizes),
        slips_(slips),
        motions_(motions),
        choices_(choices),
        forces_(forces),
        undetermined_(undetermined),
        trials_(trials),
        journal_(journal) {}
  void start() { told_choice_ = false; }

  struct Chosen {
    std::optional<Found> found;  // its motion has begun
    std::string reason;          // why there is none
    bool is_interrupted = false;
  };
  Chosen choose(const Instant& at);
  /// Whether all that may rest does, with forces that are given.
  bool rests_undetermined(const Instant& at);

 private:
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

  void measure(const Instant& at, const ContactValues& values);
  std::vector<Choice> ordered_choices(const Instant& at, const ContactValues& values);
  void order_by_limits(std::vector<Choice>& list, const Instant& at);
  std::optional<Found> undetermined_rest(const std::vector<Choice>& list, const Instant& at);
  std::optional<Found> mode_that_goes_on(const Instant& at);
  void open_idle(ContactMode& mode) const;
  std::optional<Found> search(const std::vector<Choice>& list, const Instant& at, std::string& reason);
  std::optional<Found> found_in(ContactMode mode, const Instant& at, Leniency leniency);
  bool fits_by_given_forces(Found& found, const Instant& at);
  bool may_hold(const Choice& choice) const;
  bool gives_way_unforced(const std::vector<Choice>& list, const Found& found, const Instant& at);
  bool may_be_several(const ContactMode& mode, const ContactValues& values) const;
  Pairs exchangeable(const std::vector<Choice>& list, const ContactMode& mode, const Met& met) const;
  void tell_choice(const std::vector<Choice>& list, Found& found, const Instant& at);
  // Why no mode fits.
  std::string why_none_fits(const std::vector<Choice>& list, const Instant& at, bool were_many) const;
  std::optional<std::string> weaker_at_rest(const std::vector<Choice>& list, const ContactValues& values) const;
  bool is_shared(const std::vector<Choice>& list, const ContactValues& values) const;
  bool may_be_painleve(const std::vector<Choice>& list, const ContactValues& values) const;

  const Problem& problem_;
  const State& here_;
  UsualSizes& sizes_;
  const SpaceSlips& slips_;
  ModeMotions& motions_;
  const Choices& choices_;
  JointForces& forces_;
  UndeterminedForces& undetermined_;
  ModeTrials& trials_;
  Journal& journal_;
  bool told_choice_ = false;          // that static friction leaves one
  bool finds_no_directions_ = false;  // of slips that begin, in one of the modes that were tried
};

}  // namespace maupertuis::hybrid
