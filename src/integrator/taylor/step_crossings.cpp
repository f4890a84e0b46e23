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

/// Signs of the switch functions at the start, zeros left open: enough for the values there.
void TaylorStepper::Impl::choose_first_sides() {
  set_sides(work);
  if (!switch_state.empty() && work.evaluate(t.hi, q_now, v_now) == KernelStatus::Ok)
    for (std::size_t i = 0; i < switch_state.size(); ++i) switch_state[i].side = sign(work.switch_function(i, 0));
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

void TaylorStepper::Impl::note(Crossing& crossing, double x) const {
  // Roots that rounding does not tell apart are one crossing.
  if (x < crossing.x * (1 - 4 * std::numeric_limits<double>::epsilon())) {
    crossing.switches.clear();
    crossing.event.reset();
  }
  crossing.x = std::min(crossing.x, x);
  crossing.found = true;
}

/// The sign of an event function, or at a zero the sign that it takes from there.
std::int8_t TaylorStepper::Impl::event_side(std::size_t index, const taylor::ScaledPolynomial& polynomial) const {
  const bool at_zero = event_state[index].at_zero || polynomial.begins_at_zero();
  return at_zero ? polynomial.direction() : sign(polynomial.p[0]);
}

TaylorStepper::Impl::Crossing TaylorStepper::Impl::first_crossing(double h) const {
  Crossing first_of_all;
  const auto is_later = [&](double x) { return x > first_of_all.x * (1 + 4 * std::numeric_limits<double>::epsilon()); };
  for (std::size_t i = 0; i < switch_state.size(); ++i) {
    const auto x = taylor::crossing(taylor::switch_polynomial(work, i, h), switch_state[i]);
    if (!x || is_later(*x)) continue;
    note(first_of_all, *x);
    first_of_all.switches.push_back(i);
  }
  for (std::size_t i = 0; i < event_state.size(); ++i) {
    const auto polynomial = taylor::event_polynomial(work, i, h);
    const std::int8_t before = event_state[i].side, now = event_side(i, polynomial);
    // A step may have ended just past a root, within rounding: then the root is here.
    const bool passed = before != 0 && now == -before;
    const auto x = passed ? std::optional(0.0) : taylor::crossing(polynomial, {now, event_state[i].at_zero});
    if (!x || is_later(*x)) continue;
    note(first_of_all, *x);
    if (!first_of_all.event) first_of_all.event = i;
  }
  return first_of_all;
}

void TaylorStepper::Impl::mark_crossings(const Crossing& crossing, Step& result) {
  for (taylor::Watched& s : switch_state) s.at_zero = false;
  for (const std::size_t i : crossing.switches) {
    switch_state[i].at_zero = true;
    switch_state[i].side = static_cast<std::int8_t>(-switch_state[i].side);
  }
  switches += crossing.switches.size();
  result.switches = static_cast<int>(crossing.switches.size());
  result.event = crossing.event;
}

}  // namespace maupertuis
