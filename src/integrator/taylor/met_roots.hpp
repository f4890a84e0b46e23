#pragma once
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches.hpp"

#include <maupertuis/integrator.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// A root at the end of a step.
template <class T>
struct MetRoot {
  std::size_t index;  // switches, then events
  int direction;      // 1: rising, −1: falling, 0: touching
  bool is_jump;       // a switch function jumps there: it has no zero
  T hidden;           // of the step: by how much rounding may have moved it
  std::uint8_t order;
};

/// Where a step ends at switches and events: at the first root, with those that rounding does not tell apart from it.
template <class T>
struct MetRoots {
  T x = T(1);  // fraction of the step; less than 1 without a root where the step is too long to be searched
  bool found = false;
  bool is_lost = false;  // from x on nothing is known of the roots of a function, and x is no root
  std::vector<MetRoot<T>> roots;
  std::vector<Watched> after;  // switches, then events, as the step leaves them

  /// together: of the step: what rounding does not tell apart.
  void note(const RootOf<T>& root, std::size_t index, const T& together, int direction);
  void forget(std::size_t index);
  void end_where_lost(const T& place);
  bool holds(std::size_t index) const;
};

/// Events that come to zero at a kink: where a switch changes that their formula reads, as |x| at x = 0.
///
/// The step ends at the switch, and the formula of the event is another one beyond:
///
///     |x|  ╲      ╱      the polynomial of this step goes on below zero, the one of the next step rises from it: only
///           ╲    ╱       both together tell that the event touches zero there
///            ╲  ╱
///     ────────╲╱────     so the zero is left open, and the next step says which way the event goes through it
template <class T>
class Kinks {
 public:
  Kinks(const Program& program, std::size_t switches, std::size_t events)
      : program_(&program), switches_(switches), reads_(events) {}

  /// How each event is treated; none: all of them end the step and tell touches.
  void treat(std::span<const TaylorStepper::EventTreatment> treatments) {
    treatments_.assign(treatments.begin(), treatments.end());
  }
  bool ends_step(std::size_t event) const { return treatments_.empty() || treatments_[event].ends_step; }
  bool tells_touches(std::size_t event) const { return treatments_.empty() || treatments_[event].touches; }
  /// Whether a root ends the step at which the event changes sign this way (1: it rises along the step, −1: it falls,
  /// 0: a touch). `forwards`: time grows along the step.
  bool ends_step(std::size_t event, int way, bool forwards) const {
    if (treatments_.empty()) return true;
    const TaylorStepper::EventTreatment& treatment = treatments_[event];
    return treatment.ends_step && (treatment.direction == 0 || way == (forwards ? 1 : -1) * treatment.direction);
  }

  /// Where the step comes to switches, and goes on beyond them: the events that read these have another formula there.
  bool ends_at_switch(const MetRoots<T>& met) const;
  bool has_kink(std::size_t event, const MetRoots<T>& met);
  /// Whether an event ends the step that is none at a kink. What it changes, an impact, decides where the motion goes
  /// from there: nothing is left open for the next step.
  bool ends_by_event(const MetRoots<T>& met);
  /// Whether the step begins at a zero of an event, and comes to a switch before rounding tells it from there, as where
  /// two formulas have a kink at one place: the next step begins at that zero as well. What was met at it is not met
  /// again, and what is open stays so.
  bool stays_at_zero(const Watched& event, const MetRoots<T>& met, const T& together) const {
    return comes_to_switch(met) && met.x <= together && event.at_zero;
  }
  /// What happens at the switch that ends a step of length h is taken out of `met` and left open where the next step
  /// has to tell it. before: the events as the step began.
  void leave_open(RootSearchOf<T>& search, std::span<const Watched> before, const T& h, const T& together,
                  MetRoots<T>& met);

 private:
  bool comes_to_switch(const MetRoots<T>& met) const;
  void stay_at_zeros(std::span<const Watched> before, const T& together, MetRoots<T>& met) const;

  const Program* program_;
  std::size_t switches_;
  std::vector<std::vector<bool>> reads_;  // [events][switches] that its formula depends on; empty: not asked for yet
  std::vector<TaylorStepper::EventTreatment> treatments_;  // [events], or none
};

/// An event that has come from `side` to this zero at a switch. One that was 0 all along leaves it there, unmet.
template <class T>
Watched left_open(std::int8_t side, const RootOf<T>& zero, const T& h);

/// How a function leaves a zero at x = 0 whose order was told on the other side of a kink, where its formula was
/// another one: (x + 1)² there may be x + 1 here. Nearer than ε^(1/order), where rounding may have left the zero,
/// powers below those of this formula are rounding; beyond, the power that outweighs the others is the first.
struct LeavesZero {
  std::int8_t side;
  std::uint8_t order;
};
template <class T>
LeavesZero leaves_zero(const ScaledPolynomialOf<T>& polynomial, std::uint8_t order);

/// The root that an event function has as the step begins: its direction; nothing where there is none. `watched`
/// becomes what it is there. A root lies there where its side is not the one that it had as the last step ended, within
/// rounding, or where its zero was left open.
template <class Work, class T = typename ScalarOf<Work>::Type>
std::optional<int> root_at_begin(const Work& work, std::size_t event, const std::type_identity_t<T>& h,
                                 Watched& watched);

}  // namespace maupertuis::taylor
