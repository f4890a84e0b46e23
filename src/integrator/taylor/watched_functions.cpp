#include "integrator/taylor/watched_functions.hpp"

#include "disks/unread_switches.hpp"
#include "integrator/taylor/met_roots_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

std::int8_t sign(double x) { return static_cast<std::int8_t>((x > 0) - (x < 0)); }

constexpr double unresolved = 1e-12;  // of the step

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

/// Beyond a root of an event that the step goes on from: the place from where its search goes on, up to `until`.
double go_beyond(const RootOf<double>& root, double from, double until, Watched& watched) {
  const bool touch = root.kind == RootKind::Touching;
  const auto beyond = static_cast<std::int8_t>(touch ? watched.side : -watched.side);
  const double past = std::max(root.x, std::nextafter(from, 1.0)), hidden_until = root.x + root.hidden;
  watched = {touch ? beyond : std::int8_t{0}, true, root.order};
  if (!(hidden_until < until)) return past;
  if (root.hidden > 0) watched = {beyond, false};
  return std::max(past, hidden_until);  // what lies between is not told from zero
}

}  // namespace

WatchedFunctions::WatchedFunctions(const Kernel& kernel, const KernelWorkspace& work)
    : switches(kernel.switches().size()),
      events(kernel.events()),
      kinks_(work.program(), kernel.switches().size(), kernel.events()) {
  if (empty()) return;
  std::vector<Slot> slots = work.program().switch_slots;
  slots.insert(slots.end(), work.program().events.begin(), work.program().events.end());
  is_unread_ = switches_of_events_alone(work.program());
  const std::vector<std::int8_t>& lags = work.program().lags;
  follow_places_ = std::all_of(work.program().switch_slots.begin(), work.program().switch_slots.end(),
                               [&](Slot slot) { return lags[slot] <= 0; });
  constexpr std::size_t most_pieces = 10'000;  // a tenth of a second
  roots_.emplace(work.program(), work.order(), slots);
  roots_->allow(most_pieces);
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

std::optional<RootOf<double>> WatchedFunctions::first_root(std::size_t index, Watched& watched, double from,
                                                           double until, bool wants_touching, bool wants_jumps,
                                                           Crossing& out) {
  const auto root = roots_->first(index, watched, from, until, wants_touching, wants_jumps);
  if (roots_->exhausted()) out.followed = std::min(out.followed, *roots_->exhausted());
  return root;
}

/// The first root in (from, limit] at which this event ends the step. Roots before it that do not end the step are told
/// by `pass`, when it is known where the step ends.
void WatchedFunctions::note_first(const KernelWorkspace& work, std::size_t event, double h, double from, double limit,
                                  Crossing& out) {
  const std::size_t i = switches.size() + event;
  Watched& watched = searched_[event];
  const auto ends = [&](int way) {
    const bool yes = kinks_.ends_step(event, way, h > 0);
    if (!yes) passes_[event] = true;
    return yes;
  };
  if (from == 0 && !roots_->is_clear(i)) {
    const double hidden = watched.hidden / std::abs(h);
    const auto way = root_at_begin(work, event, h, watched);
    if (way && ends(*way)) out.note({0.0, RootKind::Crossing, 0, watched.order, hidden}, i, together_, *way);
  }
  // Events at one instant are all told: the search goes on beyond the first root by what a polynomial does not resolve.
  for (;;) {
    const double beyond = std::max(together_, unresolved);
    const double until = std::min({roots_->window(), limit, out.x * (1 + together_) + beyond});
    if (!(from < until)) return;
    const auto root = first_root(i, watched, from, until, tells_touches(event), false, out);
    if (!root) {
      if (roots_->lost() && *roots_->lost() < out.x) out.end_where_lost(*roots_->lost());
      return;
    }
    const int way = root->kind == RootKind::Touching ? 0 : -watched.side;
    if (ends(way)) return out.note(*root, i, together_, way);
    from = go_beyond(*root, from, until, watched);
  }
}

/// The first roots in (from, limit].
void WatchedFunctions::search_part(const KernelWorkspace& work, double h, double from, double limit, Crossing& out) {
  for (std::size_t i = 0; i < switches.size(); ++i) {
    Watched& watched = out.after[i];
    if (watched.side == 0 && !std::isnan(work.switch_function(i, 0))) continue;  // it vanishes
    const double until = std::min({roots_->window(), limit, out.x * (1 + together_) + together_});
    if (const auto root = first_root(i, watched, from, until, false, true, out)) {
      out.note(*root, i, together_, root->kind == RootKind::Touching ? 0 : -watched.side);
      if (root->kind == RootKind::Jump) watched = {root->after, false};
    } else if (roots_->lost() && *roots_->lost() < out.x) {
      out.end_where_lost(*roots_->lost());
    }
  }
  for (std::size_t event = 0; event < events.size(); ++event)
    if (ends_step(event)) note_first(work, event, h, from, limit, out);
}

/// The first roots beyond `from`. Where those of the step before came early in a step as long as this one, part by
/// part: else each function would be followed to the end of a rest as long as the run, for a root at its beginning. A
/// part is not so short that a function which begins at its zero is not told from zero at its end.
void WatchedFunctions::search(const KernelWorkspace& work, double h, double from, Crossing& out) {
  constexpr double grows = 4, early = 1.0 / 16, shortest = 1e-6;
  out.x = roots_->window();
  const std::size_t count = switches.size();
  const std::vector<Watched> begins(out.after.begin() + static_cast<std::ptrdiff_t>(count), out.after.end());
  searched_ = begins;
  passes_.assign(events.size(), false);
  double part = grows * last_found_ / std::abs(h);
  if (!(part > shortest && part < early)) part = 1;
  for (double begin = from, limit = from + part;; begin = limit, part *= grows, limit += part) {
    search_part(work, h, begin, limit, out);
    if (out.found || out.is_lost || !(limit < roots_->window())) break;
  }
  last_found_ = out.found ? (out.x - from) * std::abs(h) : 0;
  for (std::size_t event = 0; event < events.size(); ++event)
    if (ends_step(event) && !passes_[event]) out.after[count + event] = searched_[event];
  kinks_.leave_open(*roots_, events, h, together_, out);
  // A step of no length leaves the others where they were.
  for (std::size_t i = 0; i < count && out.x == 0; ++i) out.after[i].at_zero = switches[i].at_zero;
  for (const MetRoot<double>& root : out.roots) {
    if (root.is_jump) continue;  // what lies beyond is known
    Watched& watched = out.after[root.index];
    if (root.index < count)
      watched = {static_cast<std::int8_t>(-watched.side), true};
    else
      watched = {0, true, root.order};
  }
  pass(work, h, from, begins, out);
}

/// A switch alone that nothing of the motion reads, within the step.
bool WatchedFunctions::is_unread(const Crossing& crossing) const {
  return crossing.roots.size() == 1 && crossing.roots[0].index < switches.size() &&
         is_unread_[crossing.roots[0].index] && !crossing.roots[0].is_jump && crossing.x > 0 && crossing.x < 1;
}

/// Where a step comes to a switch that only what is watched depends on, the motion goes on as it is: the other side is
/// taken, and the search is continued there. False: the step ends where the search has come to. So it does where
/// another function does not go on from its side, clear of zero.
bool WatchedFunctions::turns_unread(const KernelWorkspace& work, double h, Crossing& out) {
  constexpr std::size_t most = 100;
  if (!is_unread(out) || out.turned.size() >= most) return false;
  if (std::any_of(out.after.begin(), out.after.end(), [](const Watched& w) { return w.is_open; })) return false;
  sides_.clear();
  for (std::size_t i = 0; i < switches.size(); ++i) sides_.push_back(out.after[i].side);
  roots_->go_on(out.x, sides_);
  if (!roots_->keeps_sides(out.after, out.roots[0].index)) return false;
  const double from = out.x;
  out.turned.push_back(out.roots[0].index);
  out.found = false;
  out.roots.clear();
  search(work, h, from, out);
  return true;
}

/// Roots that do not end the step, up to its end: each search goes on from the root before. One at a switch, at which
/// nothing else ends the step, is left open. begins: the events as the search began.
void WatchedFunctions::pass(const KernelWorkspace& work, double h, double begin, std::span<const Watched> begins,
                            Crossing& out) {
  const std::size_t count = switches.size();
  const bool may_go_on = is_unread(out), at_switch = kinks_.ends_at_switch(out);
  const bool leaves_open = at_switch && !kinks_.ends_by_event(out);
  // Those of its last instant are told with what ends it there.
  const double last = out.x * (1 + together_) + std::max(together_, unresolved);
  const double until = std::min(roots_->window(), out.found && !may_go_on ? last : out.x);
  std::vector<bool> vanishes;  // as the step ends
  for (std::size_t event = 0; event < events.size(); ++event) {
    const std::size_t i = count + event;
    const bool is_told = ends_step(event) && out.holds(i);  // as what ends the step
    if ((ends_step(event) && !passes_[event]) || kinks_.stays_at_zero(events[event], out, together_)) continue;
    Watched watched = begins[event];
    const auto is_at_end = [&](double x, double hidden) { return x + hidden >= out.x * (1 - together_) - together_; };
    bool is_told_at_end = false;
    const auto note_root = [&](double x, int direction, double hidden = 0, std::uint8_t order = 1) {
      out.passed.push_back({std::min(x, out.x), event, direction, hidden, order});
      is_told_at_end = is_at_end(x, hidden);
    };
    if (begin == 0 && !roots_->is_clear(i)) {
      const double hidden = watched.hidden / std::abs(h);
      const auto way = root_at_begin(work, event, h, watched);
      if (way && is_told && kinks_.ends_step(event, *way, h > 0)) continue;
      if (way && (*way != 0 || tells_touches(event))) note_root(0, *way, hidden, watched.order);
    }
    for (double from = begin; from < until;) {
      const auto root = first_root(i, watched, from, until, tells_touches(event), false, out);
      if (roots_->lost()) return out.end_where_lost(0);
      if (!root) break;
      if (leaves_open && is_at_end(root->x, root->hidden)) {
        watched = left_open(watched.side, *root, h);
        break;
      }
      const int way = root->kind == RootKind::Touching ? 0 : -watched.side;
      if (is_told && kinks_.ends_step(event, way, h > 0)) break;
      note_root(root->x, way, root->hidden, root->order);
      from = go_beyond(*root, from, until, watched);
    }
    if (is_told) continue;
    out.after[i] = watched;
    if (!at_switch || is_told_at_end || watched.is_open || watched.at_zero || roots_->is_clear(i)) continue;
    if (vanishes.empty()) vanishes = roots_->vanishing_at(out.x);
    if (!vanishes[i]) continue;
    const RootOf<double> zero = roots_->zero_at(i, out.x);
    if (leaves_open)
      out.after[i] = left_open(watched.side, zero, h);
    else
      note_root(out.x, zero.kind == RootKind::Crossing ? -watched.side : 0, zero.hidden, zero.order);
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
    if (events[i].is_open) {  // it is on its way
      out.push_back({events[i].side, work.event_scale(i)});
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
  for (const MetRoot<double>& root : crossing.roots) {
    if (root.index < count) {
      result.switches.push_back(root.index);
      continue;
    }
    const std::size_t event = root.index - count;
    if (!result.event) result.event = event;
    const double hidden = root.hidden * std::abs(length);
    result.events.push_back({event, root.direction, result.end, hidden, root.order});
    result.hidden = std::max(result.hidden, hidden);
  }
}

}  // namespace maupertuis::taylor
