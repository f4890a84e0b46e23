#pragma once
#include "integrator/extended/impact_code.hpp"
#include "integrator/extended/slip_directions.hpp"
#include "integrator/extended/stepper.hpp"
#include "linear_algebra/combinations.hpp"

#include <limits>
#include <map>
#include <memory>
#include <string>

namespace maupertuis::extended {

/// A motion through modes over T: the rules of simulation's HybridMotion (docs/theory/contacts.md), with the thresholds
/// of rounding in units of T. At an instant all modes that are possible with the contacts that touch are tried; one
/// that keeps its own conditions just after it goes on. A motion without contacts and friction is in its one mode
/// throughout.
template <class T>
class Modes {
 public:
  using What = ExtendedWatch::What;
  struct Zero {
    std::size_t event;
    std::uint8_t order;  // of the root
  };
  /// What a step has met.
  struct Met {
    std::vector<std::size_t> hit;     // contacts whose gap came to 0
    std::vector<ExtendedWatch> left;  // conditions of the mode that end here
    std::vector<std::size_t> sets;    // events
    std::vector<int> ways;            // [sets] in which their functions come to 0: 1 rising with time, −1 falling
    std::vector<Zero> zeros;          // events that are met here
    bool begins = false, forces_jump = false;
    bool slips_go_on = false;  // what held for their beginning does no more
    bool nothing() const {
      return hit.empty() && left.empty() && sets.empty() && !begins && !forces_jump && !slips_go_on;
    }
  };

  /// What happens is added to `out`, and why the motion cannot go on.
  Modes(const ExtendedProblem& problem, const ExtendedOptions& options, std::span<const T> parameters,
        double log2_tolerance, ExtendedMotion& out);

  void start(const T& t, std::vector<T> q, std::vector<T> v, const T& bound);
  /// In the mode that it is in.
  Stepper<T>& stepper() { return *now_->stepper; }
  const std::vector<ExtendedWatch>& watches() const { return now_->program.watches; }
  /// After a step: the state that it reached, and the sizes of the motion.
  void note_step();
  /// Carries out what was met: sets, impacts, the mode after them. Nothing more where out.ending says why.
  void settle(const Met& met);
  /// Adds what happened at a time.
  void add(ExtendedRoot root, const T& t);
  bool any() const { return !problem_.contacts.frictions.empty(); }
  bool has_forces() const;
  /// Where the present mode ends, if that is before the bound of the run.
  T end_of_mode() const;
  /// Whether directions of slips that begin hold no longer, or slips have left the speeds at which they were to stop
  /// far behind.
  bool slips_go_on() const;
  /// Whether the root of an event is made by what rounding leaves of a function that stays at 0 since it was set
  /// (Events::stays_at_zero of simulation).
  bool stays_at_zero(const ExtendedWatch& watch, const typename Stepper<T>::Root& root);
  /// Events whose functions come to 0 as the run ends, but for rounding, are met there.
  void tell_at_end(const T& begin);

  std::size_t steps() const { return steps_before_ + now_->stepper->steps(); }
  std::size_t switches() const { return switches_before_ + now_->stepper->switches(); }

 private:
  struct InMode {
    ExtendedMode mode;
    ExtendedProgram program;
    std::unique_ptr<Stepper<T>> stepper;  // none where slips begin along directions that are not found
    std::optional<T> end{};               // until when these directions hold
  };
  struct Option {
    bool closed = false;
    ExtendedMode::Friction friction = ExtendedMode::Friction::None;
    std::int8_t sign = 1;
    bool begins = false;  // a slip in space
  };
  struct Choice {
    std::size_t index;  // of the contact, or contacts + friction of a coordinate
    std::vector<Option> options;
  };
  using Slides = ExtendedMode::Friction;

  InMode& in_mode(const ExtendedMode& mode);
  void begin_slips(InMode& made);
  ExtendedMode open_mode() const;
  bool evaluate();
  void note_point();
  void note_accelerations(const std::vector<T>& a);
  T size_along(const std::vector<T>& row, const std::vector<T>& sizes) const;
  std::vector<T> of_coordinates(const std::vector<T>& sizes) const;
  T size_of_gap(std::size_t contact) const;
  T size_of_force(std::size_t contact) const;
  T rest_rate(std::size_t contact) const;
  T rest_slip(std::size_t friction) const;
  std::vector<std::size_t> touching(const Met& met) const;
  bool carry_out_sets(const Met& met);
  bool returns_are_seen(const Met& met);
  void tell_events_at_start();
  T rounding_of_zero(const typename Stepper<T>::Outlook& outlook, std::size_t watch) const;
  void measure_zeros(const Met& met);
  void note_stays(const Met& met);
  bool hit(const std::vector<std::size_t>& touching, Met& met);
  bool rubs_in_space(std::size_t friction) const;
  T stop_speed(std::size_t contact) const;
  void note_slips();
  void come_to_rest(const std::vector<std::size_t>& touching, Met& met);
  void take_out_slips(const std::vector<std::size_t>& stopping, const std::vector<std::size_t>& touching);
  Choice choice_in_space(std::size_t contact) const;
  bool keeps_slip_in_space(const InMode& candidate, std::size_t contact, std::int8_t side) const;
  bool keeps_sticking(const std::vector<std::size_t>& touching, const Met& met);
  std::optional<T> end_of_bounces(std::size_t contact, const T& speed);
  class Rows;
  bool holds_undetermined(const ExtendedMode& mode) const;
  void note_indeterminate(const std::vector<std::size_t>& touching);
  std::vector<Choice> choices(const std::vector<std::size_t>& touching, const Met& met) const;
  Choice choice_of_contact(std::size_t contact, const Met& met) const;
  ExtendedMode mode_of(const std::vector<Choice>& list, const std::vector<std::size_t>& taken) const;
  bool begins_slowly(InMode& candidate, const typename Stepper<T>::Outlook& outlook, const Met& met);
  bool fits(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met, bool lenient,
            std::vector<T>* accelerations);
  /// An event whose function is 0 as the motion goes on: it was met here, and neither a set nor an impact has changed
  /// what the function depends on.
  const Zero* zero_that_stays(const Met& met, std::size_t event) const;
  /// Those that a set, an impact or a force may have changed, and that are 0 to rounding still, go on from there too.
  /// True where there are some.
  bool go_on_from_zero(InMode& candidate, const typename Stepper<T>::Outlook& outlook, const Met& met);
  void put_at_zero(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met);
  bool may_be_several(const ExtendedMode& mode) const;
  bool is_painleve(const std::vector<Choice>& list, Combinations& tries) const;
  bool may_hold(const Choice& choice) const;
  void order_by_limits(std::vector<Choice>& list, const std::vector<std::size_t>& touching, const Met& met);
  std::optional<std::vector<std::size_t>> beyond_limits(InMode& candidate, const std::vector<std::size_t>& touching,
                                                        const Met& met);
  bool gives_way_unforced(const std::vector<Choice>& list, const ExtendedMode& mode,
                          const std::vector<std::size_t>& touching, const Met& met);
  void note_choice(const std::vector<Choice>& list, const ExtendedMode& mode, const std::vector<std::size_t>& touching,
                   const Met& met);
  void measure_forces(const Met& met);
  bool choose(const std::vector<std::size_t>& touching, const Met& met);
  void record(ExtendedRoot::Kind kind, std::size_t index, const std::optional<T>& time = std::nullopt);
  void record_changes(const ExtendedMode& before, const ExtendedMode& after, bool begins);
  bool stop(StepEnding ending, std::optional<std::size_t> contact, std::string reason);

  const ExtendedProblem& problem_;
  const ExtendedOptions& options_;
  std::vector<T> parameters_;
  double log2_tolerance_;
  ExtendedMotion& out_;
  std::map<std::string, std::unique_ptr<InMode>> modes_;
  InMode* now_ = nullptr;
  Workspace<T> base_;               // the kernel of the problem, at points
  std::vector<T> times_;            // [out_.roots] at which they were located
  std::vector<std::int8_t> sides_;  // of its switches
  std::optional<ContactPoint<T>> point_;
  std::vector<T> compliance_;  // [contacts] what a force λ = 1 does to g̈, at this instant

  T t_ = T(0), bound_ = T(0);
  std::vector<T> q_, v_;
  std::size_t steps_before_ = 0, switches_before_ = 0;
  // The largest so far, of coordinates of one dimension together: what is much smaller is rounding.
  std::vector<T> place_, speed_, acceleration_;     // [kinds]
  std::size_t looks_at_forces_ = 0;                 // where friction gave way
  std::vector<T> widest_, fastest_, fastest_slip_;  // [contacts], [contacts], [contacts + frictions]
  std::vector<bool> released_;                      // [contacts] λ has fallen to 0 here
  std::vector<T> slip_in_space_;                    // [contacts] the fastest so far
  std::vector<bool> just_began_;                    // [contacts] slips in space that began before this instant
  struct Moment {                                   // passed by the end of a slip, with these accelerations
    T t;
    std::vector<T> q, v, a;
  };
  std::optional<Moment> moment_;
  std::vector<T> left_, stays_;  // [events] by rounding of zeros of this instant; of functions that stay at 0, else 0
  struct Bounce {
    T t, speed;
  };
  std::vector<std::vector<Bounce>> bounces_;  // [contacts] the last four
  std::vector<std::optional<T>> ended_;       // [contacts] when its bounces come to an end, told at this instant
  std::size_t same_time_ = 0;
  T last_time_ = T(0), last_impact_ = T(0);
  int short_flights_ = 0;
};

}  // namespace maupertuis::extended
