#pragma once
#include "simulation/hybrid_impacts.hpp"

#include <maupertuis/motion_through_modes.hpp>

#include <memory>
#include <optional>
#include <string>

namespace maupertuis {

class ImpactDerivative;

}  // namespace maupertuis

namespace maupertuis::hybrid {

/// What neighbours of a motion need of its instants: the functions whose roots they are, and the derivatives of what
/// happens there.
class Neighbours {
 public:
  Neighbours(const Problem& problem, const State& here, const UsualSizes& sizes, const ModeMotions& motions);
  ~Neighbours();
  void start();

  /// From here on each instant is kept.
  void keep();
  bool are_kept() const { return derivative_ != nullptr; }
  /// The one at the beginning of the last step.
  const ModeInstant* instant() const { return instant_ ? &*instant_ : nullptr; }
  void begin_step() { instant_.reset(); }

  /// Before anything is settled. The mode before is asked once more, for the rates of what ends it.
  void note_before(const Met& met, double bound);
  void note_impact(Impact impact);
  /// Once the mode after it is known.
  void note_after(double bound);

 private:
  struct Settled;
  struct Ended;
  Ended ended_by(Watch::What what, std::size_t index, const Outlook& outlook) const;
  Expr function_of(const Watch& watch, bool second) const;
  bool changes_in_space() const;
  void add_jumps();
  void add_set_jump();
  void add_impact_jumps();
  void add_impulses_in_order(const ImpactResult& ordered);
  void add_impulses_at_once();
  void add_change_of_forces();
  std::string at_once_sentence() const;
  std::string touch_sentence(std::size_t contact) const;

  const Problem& problem_;
  const State& here_;
  const UsualSizes& sizes_;
  const ModeMotions& motions_;
  std::unique_ptr<ImpactDerivative> derivative_;  // where instants are kept
  std::unique_ptr<Settled> settled_;              // the instant that is being settled
  std::optional<ModeInstant> instant_;
};

}  // namespace maupertuis::hybrid
