#include "integrator/taylor/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// The sides of switch functions, and where a step ends at a switch or an event.
namespace maupertuis {
namespace {

std::int8_t sign(double x) { return static_cast<std::int8_t>((x > 0) - (x < 0)); }

}  // namespace

using taylor::SideChooser;

void TaylorStepper::Impl::copy_sides(KernelWorkspace& w) const {
  std::vector<std::int8_t> sides;
  for (const taylor::Watched& s : switch_state) sides.push_back(s.side);
  w.set_branches(sides);
}

/// Signs of the switch functions at the start, zeros left open: enough for the values there. A function within another comes before it. Under
/// sides that are not those of the state forces may have no value (log|x|), but switch functions do.
void TaylorStepper::Impl::choose_first_sides() {
  bool changed = !switch_state.empty();
  for (std::size_t pass = 0; changed && pass <= switch_state.size(); ++pass) {
    set_sides(work);
    static_cast<void>(work.evaluate(t.hi, q_now, v_now));
    changed = false;
    for (std::size_t i = 0; i < switch_state.size(); ++i) {
      const std::int8_t side = sign(work.switch_function(i, 0));
      changed = changed || side != switch_state[i].side;
      switch_state[i].side = side;
    }
  }
  set_sides(probe);
}

/// The motion through the present state under the present sides; the length over which to judge it.
std::optional<double> TaylorStepper::Impl::trial(double bound) {
  set_sides(work);
  if (work.expand(t.hi, q_now, v_now) != KernelStatus::Ok) return std::nullopt;
  const double h = taylor::step_size(work, n, control, length);
  return std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound));
}

bool TaylorStepper::Impl::decide_sides(double bound, Step& result) {
  const double h = taylor::step_size(work, n, control, length);
  SideChooser chooser(work, switch_state, [&](const std::vector<std::int8_t>&) { return trial(bound); });
  switch (chooser.decide(std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound)))) {
    case SideChooser::Outcome::Decided: return true;
    case SideChooser::Outcome::Failed: return fail(result, KernelStatus::NonFinite);
    case SideChooser::Outcome::Sliding: break;
  }
  end(result, StepEnding::Sliding,
      "Both sides of a switch push the motion back to it, so that it would slide along the switch.");
  return false;
}

/// Roots that rounding does not tell apart are one crossing.
void TaylorStepper::Impl::note(Crossing& crossing, double x, std::size_t index, double together) const {
  if (crossing.found && x > crossing.x * (1 + together) + together) return;
  if (x < crossing.x * (1 - together) - together) crossing.roots.clear();
  crossing.x = std::min(crossing.x, x);
  crossing.found = true;
  crossing.roots.push_back(index);
}

/// The first roots of the step, and with which sides the functions leave it. Switches may change at jumps too, events not.
TaylorStepper::Impl::Crossing TaylorStepper::Impl::first_crossing(double h) {
  Crossing first_of_all;
  first_of_all.after = switch_state;
  first_of_all.after.insert(first_of_all.after.end(), event_state.begin(), event_state.end());
  roots->set_constants(work.constants(), work.constants());
  roots->begin({t.hi, t.lo}, h, [this](int k) { return work.coordinate(k); });
  const double together = std::max(4 * std::numeric_limits<double>::epsilon(), 4 * std::numeric_limits<double>::epsilon() * std::abs(t.hi / h));
  const std::size_t switches_here = switch_state.size();
  for (std::size_t i = 0; i < first_of_all.after.size(); ++i) {
    const bool is_switch = i < switches_here;
    taylor::Watched& watched = first_of_all.after[i];
    if (is_switch && watched.side == 0) continue;  // it vanishes along the motion
    if (!is_switch && begins_past_root(i - switches_here, h, watched)) note(first_of_all, 0, i, together);
    const double until = std::min(1.0, first_of_all.x * (1 + together) + together);
    const auto root = roots->first(is_switch ? work.program().switch_slots[i] : work.program().events[i - switches_here], watched, until, !is_switch, is_switch);
    if (root) note(first_of_all, root->x, i, together);
  }
  // A step of no length leaves the others where they were.
  for (std::size_t i = 0; i < switches_here && first_of_all.x == 0; ++i) first_of_all.after[i].at_zero = switch_state[i].at_zero;
  for (const std::size_t i : first_of_all.roots) {
    taylor::Watched& watched = first_of_all.after[i];
    watched = {i < switches_here ? static_cast<std::int8_t>(-watched.side) : std::int8_t{0}, true};
  }
  return first_of_all;
}

/// The side that an event function has as the step begins. True if it is not the one that it had as the last step ended: then a root lies
/// between them, within rounding.
bool TaylorStepper::Impl::begins_past_root(std::size_t index, double h, taylor::Watched& watched) const {
  const auto polynomial = taylor::judged(taylor::event_polynomial(work, index, h));
  const std::int8_t before = watched.side;
  watched.at_zero = watched.at_zero || polynomial.begins_at_zero();
  watched.side = watched.at_zero ? polynomial.direction() : sign(polynomial.p[0]);
  constexpr double close = 1e-6;  // beyond, the sign has changed by a jump
  return before != 0 && watched.side == -before && std::abs(polynomial.p[0]) <= close * polynomial.reach;
}

void TaylorStepper::Impl::mark_crossings(const Crossing& crossing, Step& result) {
  const std::size_t count = switch_state.size();
  for (std::size_t i = 0; i < crossing.after.size(); ++i) (i < count ? switch_state[i] : event_state[i - count]) = crossing.after[i];
  for (const std::size_t i : crossing.roots) {
    if (i < count) ++result.switches;
    else if (!result.event) result.event = i - count;
  }
  switches += static_cast<std::size_t>(result.switches);
}

}  // namespace maupertuis
