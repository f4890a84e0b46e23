#include "integrator/taylor/watched_functions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

std::int8_t sign(double x) { return static_cast<std::int8_t>((x > 0) - (x < 0)); }

/// Roots that rounding does not tell apart are one crossing.
void note(Crossing& crossing, double x, std::size_t index, double together, int direction) {
  if (crossing.found && x > crossing.x * (1 + together) + together) return;
  if (x < crossing.x * (1 - together) - together) crossing.roots.clear(), crossing.directions.clear();
  crossing.x = std::min(crossing.x, x);
  crossing.found = true;
  crossing.roots.push_back(index);
  crossing.directions.push_back(direction);
}

/// The side that an event function has as the step begins. True if it is not the one that it had as the last step
/// ended: then a root lies between them, within rounding.
bool begins_past_root(const KernelWorkspace& work, std::size_t index, double h, Watched& watched) {
  const auto polynomial = judged(event_polynomial(work, index, h));
  const std::int8_t before = watched.side;
  watched.at_zero = watched.at_zero || polynomial.begins_at_zero();
  watched.side = watched.at_zero ? polynomial.direction(watched.order) : sign(polynomial.p[0]);
  constexpr double close = 1e-6;  // beyond, the sign has changed by a jump
  return before != 0 && watched.side == -before && std::abs(polynomial.p[0]) <= close * polynomial.reach;
}

}  // namespace

WatchedFunctions::WatchedFunctions(const Kernel& kernel, const KernelWorkspace& work)
    : switches(kernel.switches().size()), events(kernel.events()) {
  if (empty()) return;
  std::vector<Slot> slots = work.program().switch_slots;
  slots.insert(slots.end(), work.program().events.begin(), work.program().events.end());
  roots_.emplace(work.program(), work.order(), slots);
}

void WatchedFunctions::start() {
  std::fill(switches.begin(), switches.end(), Watched{});
  std::fill(events.begin(), events.end(), Watched{});
}

void WatchedFunctions::copy_sides(KernelWorkspace& work) const {
  std::vector<std::int8_t> sides;
  for (const Watched& s : switches) sides.push_back(s.side);
  work.set_branches(sides);
}

void WatchedFunctions::choose_first_sides(KernelWorkspace& work, const MotionState& state) {
  bool changed = !switches.empty();
  for (std::size_t pass = 0; changed && pass <= switches.size(); ++pass) {
    set_sides(work);
    static_cast<void>(work.evaluate(state.t.hi, state.q_now, state.v_now));
    changed = false;
    for (std::size_t i = 0; i < switches.size(); ++i) {
      const std::int8_t side = sign(work.switch_function(i, 0));
      changed = changed || side != switches[i].side;
      switches[i].side = side;
    }
  }
}

Crossing WatchedFunctions::first_crossing(const KernelWorkspace& work, const Compensated& t, double h) {
  Crossing out;
  out.after = switches;
  out.after.insert(out.after.end(), events.begin(), events.end());
  roots_->set_constants(work.constants(), work.constants());
  roots_->begin({t.hi, t.lo}, h, [&work](int k) { return work.coordinate(k); });
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double together = std::max(4 * epsilon, 4 * epsilon * std::abs(t.hi / h));
  constexpr double unresolved = 1e-12;  // of the step
  const std::size_t count = switches.size();
  for (std::size_t i = 0; i < out.after.size(); ++i) {
    const bool is_switch = i < count;
    Watched& watched = out.after[i];
    if (is_switch && watched.side == 0) continue;  // it vanishes along the motion
    if (!is_switch && begins_past_root(work, i - count, h, watched)) note(out, 0, i, together, watched.side);
    // Events at one instant are all told: the search goes on beyond the first root by what a polynomial does not resolve.
    const double beyond = is_switch ? together : std::max(together, unresolved);
    const double until = std::min(1.0, out.x * (1 + together) + beyond);
    const Slot slot = is_switch ? work.program().switch_slots[i] : work.program().events[i - count];
    if (const auto root = roots_->first(slot, watched, until, !is_switch, is_switch))
      note(out, root->x, i, together, root->kind == RootKind::Touching ? 0 : -watched.side);
  }
  // A step of no length leaves the others where they were.
  for (std::size_t i = 0; i < count && out.x == 0; ++i) out.after[i].at_zero = switches[i].at_zero;
  for (const std::size_t i : out.roots) {
    Watched& watched = out.after[i];
    watched = {i < count ? static_cast<std::int8_t>(-watched.side) : std::int8_t{0}, true};
  }
  return out;
}

std::vector<WatchedFunctions::Side> WatchedFunctions::sides_of_events(const KernelWorkspace& work, double h) const {
  std::vector<Side> out;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto polynomial = judged(event_polynomial(work, i, h));
    const bool at_zero = events[i].at_zero || polynomial.begins_at_zero();
    out.push_back({at_zero ? polynomial.direction(events[i].order) : sign(polynomial.p[0]), polynomial.reach});
  }
  return out;
}

void WatchedFunctions::leave(const Crossing& crossing, Step& result) {
  const std::size_t count = switches.size();
  for (std::size_t i = 0; i < crossing.after.size(); ++i)
    (i < count ? switches[i] : events[i - count]) = crossing.after[i];
  for (std::size_t k = 0; k < crossing.roots.size(); ++k) {
    const std::size_t i = crossing.roots[k];
    if (i < count) {
      ++result.switches;
      continue;
    }
    if (!result.event) result.event = i - count;
    result.events.push_back({i - count, crossing.directions[k]});
  }
}

}  // namespace maupertuis::taylor
