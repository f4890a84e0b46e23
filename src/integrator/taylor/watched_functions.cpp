#include "integrator/taylor/watched_functions.hpp"

#include "disks/unread_switches.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

std::int8_t sign(double x) { return static_cast<std::int8_t>((x > 0) - (x < 0)); }

constexpr double unresolved = 1e-12;  // of the step

void forget_roots(Crossing& crossing) {
  crossing.roots.clear(), crossing.directions.clear(), crossing.jumps.clear();
  crossing.hidden.clear(), crossing.orders.clear();
}

void end_where_lost(double x, Crossing& crossing) {
  forget_roots(crossing);
  crossing.found = false;
  crossing.is_lost = true;
  crossing.x = x;
}

/// Roots that rounding does not tell apart are one crossing.
void note(Crossing& crossing, const RootOf<double>& root, std::size_t index, double together, int direction) {
  if (crossing.found && root.x > crossing.x * (1 + together) + together) return;
  if (root.x < crossing.x * (1 - together) - together) forget_roots(crossing);
  crossing.x = std::min(crossing.x, root.x);
  crossing.found = true;
  crossing.is_lost = false;
  crossing.roots.push_back(index);
  crossing.directions.push_back(direction);
  crossing.jumps.push_back(root.kind == RootKind::Jump);
  crossing.hidden.push_back(root.hidden);
  crossing.orders.push_back(root.order);
}

/// Switch functions, then events, as a workspace has them.
struct ExpansionOfWatched {
  const KernelWorkspace& work;
  std::size_t switches;

  double coefficient(std::size_t i, int k) const {
    return i < switches ? work.switch_function(i, k) : work.event(i - switches, k);
  }
  double scale(std::size_t i) const { return i < switches ? work.switch_scale(i) : work.event_scale(i - switches); }
  const double* rows() const { return work.coordinate(0); }
  std::size_t stride() const { return work.row_stride(); }
};

/// The side that an event function has as the step begins. True if it is not the one that it had as the last step
/// ended: then a root lies between them, within rounding.
bool begins_past_root(const KernelWorkspace& work, std::size_t index, double h, Watched& watched) {
  const std::int8_t before = watched.side;
  const double here = work.event(index, 0);
  watched.at_zero = watched.at_zero || watching::is_zero(here, work.event_scale(index));
  watched.side = sign(here);
  if (!watched.at_zero && (before == 0 || watched.side != -before)) return false;
  const auto polynomial = judged(event_polynomial(work, index, h));
  if (watched.at_zero) watched.side = polynomial.direction(watched.order);
  constexpr double close = 1e-6;  // beyond, the sign has changed by a jump
  return before != 0 && watched.side == -before && std::abs(polynomial.p[0]) <= close * polynomial.reach;
}

}  // namespace

WatchedFunctions::WatchedFunctions(const Kernel& kernel, const KernelWorkspace& work)
    : switches(kernel.switches().size()), events(kernel.events()) {
  if (empty()) return;
  std::vector<Slot> slots = work.program().switch_slots;
  slots.insert(slots.end(), work.program().events.begin(), work.program().events.end());
  is_unread_ = switches_of_events_alone(work.program());
  const std::vector<std::int8_t>& lags = work.program().lags;
  follow_places_ = std::all_of(work.program().switch_slots.begin(), work.program().switch_slots.end(),
                               [&](Slot slot) { return lags[slot] <= 0; });
  roots_.emplace(work.program(), work.order(), slots);
  std::vector<bool> is_rough = is_unread_;  // the step goes on there
  is_rough.resize(slots.size(), false);
  roots_->leave_rough(std::move(is_rough));
}

void WatchedFunctions::start() {
  for (Watched& w : switches) w = {w.side, false};  // a first guess: those of the motion before
  std::fill(events.begin(), events.end(), Watched{});
}

void WatchedFunctions::copy_sides(KernelWorkspace& work) const {
  sides_.clear();
  for (const Watched& s : switches) sides_.push_back(s.side);
  work.set_branches(sides_);
}

bool WatchedFunctions::know_sides() const {
  return follow_places_ &&
         std::all_of(switches.begin(), switches.end(), [](const Watched& w) { return w.side != 0 && !w.at_zero; });
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
  roots_->set_constants({work.constants(), work.program().constants.size()});
  roots_->begin(
      {t.hi, t.lo}, h, [&work](int k) { return work.coordinate(k); }, ExpansionOfWatched{work, switches.size()});
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  together_ = std::max(4 * epsilon, 4 * epsilon * std::abs(t.hi / h));
  search(work, h, 0, out);
  while (turns_unread(work, h, out)) {
  }
  std::stable_sort(out.passed.begin(), out.passed.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return out;
}

/// The first roots beyond `from`.
void WatchedFunctions::search(const KernelWorkspace& work, double h, double from, Crossing& out) {
  out.x = roots_->window();
  const std::size_t count = switches.size();
  for (std::size_t i = 0; i < out.after.size(); ++i) {
    const bool is_switch = i < count;
    Watched& watched = out.after[i];
    if (is_switch && watched.side == 0 && !std::isnan(work.switch_function(i, 0))) continue;  // it vanishes
    if (!is_switch && !ends_step(i - count)) continue;
    if (from == 0 && !is_switch && !roots_->is_clear(i) && begins_past_root(work, i - count, h, watched))
      note(out, {0.0, RootKind::Crossing}, i, together_, watched.side);
    // Events at one instant are all told: the search goes on beyond the first root by what a polynomial does not
    // resolve.
    const double beyond = is_switch ? together_ : std::max(together_, unresolved);
    const double until = std::min(roots_->window(), out.x * (1 + together_) + beyond);
    const bool touches = !is_switch && tells_touches(i - count);
    if (const auto root = roots_->first(i, watched, from, until, touches, is_switch)) {
      const bool jump = root->kind == RootKind::Jump;
      note(out, *root, i, together_, root->kind == RootKind::Touching ? 0 : -watched.side);
      if (jump) watched = {root->after, false};
    } else if (roots_->lost() && *roots_->lost() < out.x) {
      end_where_lost(*roots_->lost(), out);
    }
  }
  // A step of no length leaves the others where they were.
  for (std::size_t i = 0; i < count && out.x == 0; ++i) out.after[i].at_zero = switches[i].at_zero;
  for (std::size_t k = 0; k < out.roots.size(); ++k) {
    if (out.jumps[k]) continue;  // what lies beyond is known
    const std::size_t i = out.roots[k];
    Watched& watched = out.after[i];
    if (i < count)
      watched = {static_cast<std::int8_t>(-watched.side), true};
    else
      watched = {0, true, out.orders[k]};
  }
  pass(work, h, from, out);
}

/// A switch alone that nothing of the motion reads, within the step.
bool WatchedFunctions::is_unread(const Crossing& crossing) const {
  return crossing.roots.size() == 1 && crossing.roots[0] < switches.size() && is_unread_[crossing.roots[0]] &&
         !crossing.jumps[0] && crossing.x > 0 && crossing.x < 1;
}

/// Where a step comes to a switch that only what is watched depends on, the motion goes on as it is: the other side is
/// taken, and the search is continued there. False: the step ends where the search has come to. So it does where
/// another function does not go on from its side, clear of zero.
bool WatchedFunctions::turns_unread(const KernelWorkspace& work, double h, Crossing& out) {
  constexpr std::size_t most = 100;
  if (!is_unread(out) || out.turned.size() >= most) return false;
  sides_.clear();
  for (std::size_t i = 0; i < switches.size(); ++i) sides_.push_back(out.after[i].side);
  roots_->go_on(out.x, sides_);
  if (!roots_->keeps_sides(out.after, out.roots[0])) return false;
  const double from = out.x;
  out.turned.push_back(out.roots[0]);
  out.found = false;
  forget_roots(out);
  search(work, h, from, out);
  return true;
}

/// Roots of events that do not end the step, up to its end: each search goes on from the root before.
void WatchedFunctions::pass(const KernelWorkspace& work, double h, double begin, Crossing& out) {
  const std::size_t count = switches.size();
  const bool may_go_on = is_unread(out);
  // Those of its last instant are told with what ends it there.
  const double last = out.x * (1 + together_) + std::max(together_, unresolved);
  const double until = std::min(roots_->window(), out.found && !may_go_on ? last : out.x);
  for (std::size_t event = 0; event < events.size(); ++event) {
    if (ends_step(event)) continue;
    const std::size_t i = count + event;
    Watched& watched = out.after[i];
    const auto note_root = [&](double x, int direction, double hidden = 0, std::uint8_t order = 1) {
      out.passed.push_back({std::min(x, out.x), event, direction, hidden, order});
    };
    if (begin == 0 && !roots_->is_clear(i) && begins_past_root(work, event, h, watched)) note_root(0, watched.side);
    for (double from = begin; from < until;) {
      const auto root = roots_->first(i, watched, from, until, tells_touches(event), false);
      if (roots_->lost()) return end_where_lost(0, out);
      if (!root) break;
      const bool touch = root->kind == RootKind::Touching;
      note_root(root->x, touch ? 0 : -watched.side, root->hidden, root->order);
      const auto beyond = static_cast<std::int8_t>(touch ? watched.side : -watched.side);
      from = std::max(root->x, std::nextafter(from, 1.0));
      watched = {touch ? beyond : std::int8_t{0}, true, root->order};
      if (!(root->x + root->hidden < until)) continue;
      from = std::max(from, root->x + root->hidden);  // what lies between is not told from zero
      if (root->hidden > 0) watched = {beyond, false};
    }
  }
}

std::vector<WatchedFunctions::Side> WatchedFunctions::sides_of_events(const KernelWorkspace& work, double h) const {
  constexpr double clear = 1e-9;  // of the terms of the function: its own value decides
  std::vector<Side> out;
  out.reserve(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double here = work.event(i, 0);
    if (!events[i].at_zero && std::abs(here) > clear * work.event_scale(i)) {
      out.push_back({sign(here), work.event_scale(i)});
      continue;
    }
    const auto polynomial = judged(event_polynomial(work, i, h));
    const bool at_zero = events[i].at_zero || polynomial.begins_at_zero();
    out.push_back({at_zero ? polynomial.direction(events[i].order) : sign(polynomial.p[0]), polynomial.reach});
  }
  return out;
}

void WatchedFunctions::leave(const Crossing& crossing, double length, Step& result) {
  const std::size_t count = switches.size();
  for (std::size_t i = 0; i < crossing.after.size(); ++i)
    (i < count ? switches[i] : events[i - count]) = crossing.after[i];
  for (const PassedRoot& root : crossing.passed)
    result.events.push_back(
        {root.event, root.direction, result.begin + root.x * length, root.hidden * std::abs(length), root.order});
  for (std::size_t k = 0; k < crossing.roots.size(); ++k) {
    const std::size_t i = crossing.roots[k];
    if (i < count) {
      result.switches.push_back(i);
      continue;
    }
    if (!result.event) result.event = i - count;
    const double hidden = crossing.hidden[k] * std::abs(length);
    result.events.push_back({i - count, crossing.directions[k], result.end, hidden, crossing.orders[k]});
    result.hidden = std::max(result.hidden, hidden);
  }
}

}  // namespace maupertuis::taylor
