#pragma once
#include "linear_algebra/accumulation.hpp"
#include "simulation/hybrid_journal.hpp"
#include "simulation/hybrid_motions.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis::hybrid {

/// Events of the model: those that a step meets, those that rounding hides, and such as set the state faster and
/// faster.
class Events {
 public:
  Events(const Problem& problem, const State& here, const ModeMotions& motions, Journal& journal);
  void start();

  /// An event whose function comes to 0 this way: 1 rising along the run, −1 falling, 0 touching. It is recorded with
  /// the state that the motion has there.
  void meet(const ModelEvent& event, const EventRoot& root, Met& met, bool forwards);
  bool are_of_positions(std::size_t event) const { return of_positions_[event]; }
  /// Whether accelerations and forces do not stand in it.
  bool are_of_state(std::size_t event) const { return reads_[event].has_value(); }
  /// Events whose functions come to 0 at an instant at which others set the state, but for rounding, are met with them:
  /// what is set may throw the motion back from their zeros.
  void meet_with_sets(Met& met, double bound, bool forwards);
  /// Zeros of functions that depend on what sets of this instant assign, or on velocities that impacts change.
  void mark_zeros_that_are_set(Met& met) const;
  void mark_zeros_of_velocities(Met& met) const;
  /// The motion passes an event, on to this side; 0: the step ends at its zero.
  void pass(std::size_t event, std::int8_t side) { sides_[event] = are_of_positions(event) ? side : std::int8_t{0}; }
  /// Positions have been set.
  void forget_sides() { sides_.assign(sides_.size(), 0); }
  /// Whether the motion is beyond an event by no more than rounding, though no root was told. `watch`: of the outlook.
  bool is_hidden(std::size_t event, const Outlook& outlook, std::size_t watch) const;
  /// Whether a function is 0 by what rounding of the instant and of its own terms leaves of it.
  bool is_rounding(const Outlook& outlook, std::size_t watch) const;

  /// An event whose function turns round by what it sets, so slowly that the motion comes back to it before rounding
  /// tells that it has left: it would be passed, and the bounces before it, shorter and shorter, accumulate here.
  const ModelEvent* turned_unseen(const Met& met, double bound, bool forwards) const;
  /// What rounding leaves of the zeros at which the state is about to be set.
  void measure_zeros(const Met& met, double bound);
  /// After the sets: functions that stay at 0 to that have no root that rounding does not make, as long as they stay.
  void note_stays(const Met& met, double bound);
  /// Whether a root, met in a step of that length, is made by what rounding leaves of a function that stays at 0 since
  /// it was set: as long as it stays, and as it begins to leave. Any other is met as it is.
  bool stays_at_zero(const EventRoot& root, double length, double bound);

  /// Events that hold as the motion begins are told, but do not act: it leaves them.
  void tell_at_start(double bound, bool forwards);
  /// Events on positions whose sign has changed at the instant that was settled though no root was told: so near to it
  /// that rounding hides their own. The motion meets them here, to be settled next.
  struct Unseen {
    Met met;
    const ModelEvent* follows_itself = nullptr;  // it has just set the state, and is met again in no time
  };
  Unseen meet_unseen(const Met& settled, double bound, bool forwards);

  /// Events whose functions come to 0 as the run ends, but for rounding, are met there.
  void tell_at_end(double length, bool forwards);
  /// The functions where a step began, right after it: whether they are numbers.
  void look_for_values(double t);
  /// Events whose functions were none.
  void tell_without_value();

  /// Sets that follow each other in shorter and shorter cycles come to an end, beyond which no step goes.
  void note_sets(const Met& met, double bound, bool forwards);
  const std::optional<Accumulation<double>::End>& end_of_sets() const { return sets_end_; }
  /// One sentence on the end of sets that accumulate.
  std::string sets_without_end() const;
  /// One sentence on an event whose returns rounding hides.
  std::string too_short_to_tell(const ModelEvent& event) const;

 private:
  void record(const std::string& name, const EventRoot& root, bool forwards);
  std::size_t number_of(const ModelEvent* event) const;
  /// Whether a function is 0 here, with a zero of that order, and comes to no more than `left` over the next step.
  bool remains(std::size_t watch, double left, std::uint8_t order, double bound) const;
  void mark_zeros(Met& met, const std::function<bool(const StateRead&)>& changes) const;

  const Problem& problem_;
  const State& here_;
  const ModeMotions& motions_;
  Journal& journal_;
  std::vector<bool> of_positions_;                            // [events]
  std::vector<std::optional<std::vector<StateRead>>> reads_;  // [events]
  std::vector<HybridRecord::WithoutValue> without_value_;     // [events]
  std::vector<double> left_;                                  // [events] of zeros of this instant, by rounding
  std::vector<double> stays_;       // [events] the same of functions that stay at 0 since they were set; 0: of others
  std::vector<std::int8_t> sides_;  // [events] of positions: where the motion is; 0: not known
  Accumulation<double> sets_that_follow_;              // events that set the state
  std::optional<Accumulation<double>::End> sets_end_;  // where these accumulate within the run
};

}  // namespace maupertuis::hybrid
