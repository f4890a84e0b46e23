#include "simulation/hybrid_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis::hybrid {
namespace {

/// "The event `a` follows itself", "The events `a` and `b` follow each other".
std::string names_of(const std::vector<ModelEvent>& events, std::vector<std::size_t> which) {
  std::sort(which.begin(), which.end());
  which.erase(std::unique(which.begin(), which.end()), which.end());
  std::string out;
  for (std::size_t k = 0; k < which.size(); ++k)
    out += fmt::format("{}`{}`", k == 0 ? "" : k + 1 < which.size() ? ", " : " and ", events[which[k]].name);
  return which.size() == 1 ? fmt::format("The event {} follows itself", out)
                           : fmt::format("The events {} follow each other", out);
}

constexpr double rounding_of_zeros = 64 * std::numeric_limits<double>::epsilon();

bool is_unmoved(const Zero* zero) { return zero && !zero->moved; }

}  // namespace

Events::Events(const Problem& problem, const State& here, const ModeMotions& motions, Journal& journal)
    : problem_(problem), here_(here), motions_(motions), journal_(journal) {
  for (const ModelEvent& e : problem_.model.experiment.events) {
    of_positions_.push_back(is_of_positions(e.function));
    reads_.push_back(state_read_by(e.function, problem_.system));
  }
}

void Events::mark_zeros(Met& met, const std::function<bool(const StateRead&)>& changes) const {
  for (Zero& zero : met.at_zero)
    if (const auto& reads = reads_[zero.event])
      zero.moved = zero.moved || std::any_of(reads->begin(), reads->end(), changes);
}

void Events::mark_zeros_that_are_set(Met& met) const {
  mark_zeros(met, [&](const StateRead& read) {
    return std::any_of(met.sets.begin(), met.sets.end(), [&](const ModelEvent* event) {
      return std::any_of(event->sets.begin(), event->sets.end(), [&](const ModelEvent::Assignment& a) {
        return a.coordinate == read.coordinate && a.order == read.order;
      });
    });
  });
}

void Events::mark_zeros_of_velocities(Met& met) const {
  mark_zeros(met, [](const StateRead& read) { return read.order == 1; });
}

bool Events::is_rounding(const Outlook& outlook, std::size_t watch) const {
  const double by_time = std::abs(here_.t) * std::abs(outlook.slopes[watch]);
  return std::abs(outlook.values[watch]) <= rounding_of_zeros * (outlook.reach[watch] + by_time);
}

void Events::start() {
  sets_that_follow_ = {};
  sets_end_.reset();
  sides_.assign(of_positions_.size(), 0);
  stays_.assign(of_positions_.size(), 0);
  without_value_.assign(of_positions_.size(), {});
}

std::size_t Events::number_of(const ModelEvent* event) const {
  return static_cast<std::size_t>(event - problem_.model.experiment.events.data());
}

void Events::meet(const ModelEvent& event, const EventRoot& root, Met& met, bool forwards) {
  const int way = root.direction;
  if (event.direction != 0 && way != event.direction * (forwards ? 1 : -1)) return;
  record(event.name, root, forwards);
  if (event.action == ModelEvent::Action::Stop) journal_.stop_by(event.name);
  if (event.action != ModelEvent::Action::Set) return;
  met.sets.push_back(&event), met.ways.push_back(way);
  met.hidden_sets = std::max(met.hidden_sets, root.hidden);
}

void Events::meet_with_sets(Met& met, double bound, bool forwards) {
  constexpr double one_instant = 4 * std::numeric_limits<double>::epsilon();
  if (met.sets.empty()) return;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const std::size_t number = watches[k].index;
    if (watches[k].what != Watch::What::Event || met.zero_of(number)) continue;
    if (stays_[number] > 0 && remains(k, stays_[number], 1, bound)) continue;
    const double value = outlook.values[k], rate = forwards ? outlook.slopes[k] : -outlook.slopes[k];
    if (!(std::abs(value) <= one_instant * (outlook.reach[k] + std::abs(here_.t * rate)) && value * rate < 0)) continue;
    met.at_zero.push_back({number, 1, !are_of_state(number)});
    pass(number, 0);
    meet(problem_.model.experiment.events[number], {k, rate > 0 ? 1 : -1, here_.t}, met, forwards);
  }
}

void Events::record(const std::string& name, const EventRoot& root, bool forwards) {
  // Rounding may lead beyond the step.
  const double t = forwards ? std::min(root.time, here_.t) : std::max(root.time, here_.t);
  Happening& told = journal_.add(Happening::Kind::Event, name);
  told.error = std::max(told.error, root.hidden);
  if (t == here_.t) return;
  told.t = t;
  if (!told.q.empty()) motions_.state(t, told.q, told.v);
  told.mode = mode_text(problem_.system, motions_.now().mode);
}

bool Events::is_hidden(std::size_t event, const Outlook& outlook, std::size_t watch) const {
  constexpr double rounding = 1e-12;  // of its terms
  const std::int8_t before = sides_[event];
  return before != 0 && outlook.sides[watch] == -before &&
         std::abs(outlook.values[watch]) <= rounding * outlook.reach[watch];
}

/// A change of sign of even order is one at a switch, as of x |x|. On which side of it rounding has left the motion,
/// and so the sign, says nothing of where it goes.
static bool is_at_switch(const Met& met, std::size_t event) {
  const auto zero = met.zero_of(event);
  return zero && zero->order % 2 == 0;
}

const ModelEvent* Events::turned_unseen(const Met& met, double bound, bool forwards) const {
  if (met.sets.empty() || met.at_zero.empty()) return nullptr;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return nullptr;  // the next step says why it cannot be made
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    if (watches[k].what != Watch::What::Event || !is_unmoved(met.zero_of(watches[k].index))) continue;
    const ModelEvent* const event = &problem_.model.experiment.events[watches[k].index];
    const auto at = std::find(met.sets.begin(), met.sets.end(), event);
    if (at == met.sets.end()) continue;
    const int way = met.ways[static_cast<std::size_t>(at - met.sets.begin())];
    if (way != 0 && is_at_switch(met, watches[k].index)) continue;
    const bool turns = outlook.slopes[k] * (forwards ? way : -way) < 0;
    if (turns && outlook.sides[k] != -way) return event;
  }
  return nullptr;
}

void Events::measure_zeros(const Met& met, double bound) {
  left_.assign(of_positions_.size(), 0);
  if (met.sets.empty() || met.at_zero.empty()) return;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k)
    if (watches[k].what == Watch::What::Event && met.zero_of(watches[k].index))
      left_[watches[k].index] = rounding_of_zeros * (outlook.reach[k] + std::abs(here_.t * outlook.slopes[k]));
}

bool Events::remains(std::size_t watch, double left, std::uint8_t order, double bound) const {
  TaylorStepper& stepper = motions_.stepper();
  Outlook outlook = stepper.outlook(bound);
  if (outlook.ending != StepEnding::None || !(std::abs(outlook.values[watch]) <= left)) return false;
  stepper.put_at_zero({&watch, 1}, order);  // else the size of its terms is taken for what it comes to
  outlook = stepper.outlook(bound);
  return outlook.ending == StepEnding::None && outlook.reach[watch] <= left;
}

void Events::note_stays(const Met& met, double bound) {
  if (met.sets.empty() || met.at_zero.empty()) return;
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const std::size_t event = watches[k].index;
    if (watches[k].what != Watch::What::Event || !met.zero_of(event)) continue;
    const std::uint8_t order = met.zero_of(event)->order;
    stays_[event] = left_[event] > 0 && remains(k, left_[event], order, bound) ? left_[event] : 0;
  }
}

bool Events::stays_at_zero(const EventRoot& root, double length, double bound) {
  double& left = stays_[motions_.now().watches()[root.event].index];
  if (!(left > 0)) return false;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return false;
  const bool begins_to_leave = root.direction != 0 && std::abs(outlook.values[root.event]) <= left &&
                               std::abs(outlook.slopes[root.event] * length) <= left;
  if (!begins_to_leave && !remains(root.event, left, root.order, bound)) left = 0;
  return left > 0;
}

void Events::tell_at_start(double bound, bool forwards) {
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return;
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    if (watches[k].what != Watch::What::Event) continue;
    const ModelEvent& event = problem_.model.experiment.events[watches[k].index];
    if (!(std::abs(outlook.values[k]) <= rounding * outlook.reach[k]) || outlook.sides[k] == 0) continue;
    if (event.direction != 0 && outlook.sides[k] != event.direction * (forwards ? 1 : -1)) continue;
    journal_.add(Happening::Kind::Event, event.name).mode = journal_.record().first_mode;
    if (event.action != ModelEvent::Action::Record)
      journal_.remark(fmt::format("The motion begins at the event `{}`, which acts when it is met again.", event.name));
  }
}

void Events::tell_at_end(double length, bool forwards) {
  constexpr double at_end = 8 * std::numeric_limits<double>::epsilon();
  const std::size_t first = journal_.size();
  const auto is_told = [&](const std::string& name) {
    const std::vector<Happening>& told = journal_.record().happenings;
    constexpr double one_instant = 4 * std::numeric_limits<double>::epsilon();
    return std::any_of(told.begin(), told.begin() + static_cast<std::ptrdiff_t>(first), [&](const Happening& h) {
      return h.kind == Happening::Kind::Event && h.name == name &&
             std::abs(h.t - here_.t) <= one_instant * std::abs(here_.t);
    });
  };
  const Outlook outlook = motions_.stepper().outlook(here_.t + (forwards ? length : -length));
  if (outlook.ending != StepEnding::None) return;
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    if (watches[k].what != Watch::What::Event) continue;
    const ModelEvent& event = problem_.model.experiment.events[watches[k].index];
    const double rate = forwards ? outlook.slopes[k] : -outlook.slopes[k];
    const double rounding = at_end * (outlook.reach[k] + std::abs(here_.t * rate));
    const bool comes_to_zero = outlook.values[k] * rate <= 0 && rate != 0 && std::abs(outlook.values[k]) <= rounding;
    const bool stays = stays_[watches[k].index] > 0 && remains(k, stays_[watches[k].index], 1, here_.t + length);
    const int way = event.direction * (forwards ? 1 : -1);
    if (!comes_to_zero || stays || (way != 0 && way * rate < 0) || is_told(event.name)) continue;
    const double hidden =
        std::abs(outlook.values[k] / rate) + std::numeric_limits<double>::epsilon() * std::abs(here_.t);
    record(event.name, {k, rate > 0 ? 1 : -1, here_.t, hidden}, forwards);
    if (event.action != ModelEvent::Action::Record)
      journal_.remark(fmt::format(
          "The event `{}` is met as the run ends: the last state is the one before what it does.", event.name));
  }
}

void Events::look_for_values(double t) {
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    if (watches[k].what != Watch::What::Event) continue;
    HybridRecord::WithoutValue& out = without_value_[watches[k].index];
    ++out.of;
    if (!std::isnan(motions_.stepper().event_at_begin(k))) continue;
    if (out.times++ == 0) out.first = t;
  }
}

void Events::tell_without_value() {
  for (std::size_t event = 0; event < without_value_.size(); ++event) {
    if (without_value_[event].times == 0) continue;
    without_value_[event].event = event;
    journal_.note_without_value(without_value_[event]);
  }
}

Events::Unseen Events::meet_unseen(const Met& settled, double bound, bool forwards) {
  Unseen out;
  if (std::none_of(of_positions_.begin(), of_positions_.end(), [](bool x) { return x; })) return out;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return out;  // the next step says why it cannot be made
  const std::vector<Watch>& watches = motions_.now().watches();
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const std::size_t number = watches[k].index;
    if (watches[k].what != Watch::What::Event || !of_positions_[number]) continue;
    if (stays_[number] > 0 && remains(k, stays_[number], 1, bound)) continue;
    const bool is_beyond = is_hidden(number, outlook, k);
    const std::int8_t before = std::exchange(sides_[number], outlook.sides[k]);
    if (is_beyond && is_at_switch(settled, number)) sides_[number] = before;
    if (!is_beyond || is_at_switch(settled, number)) continue;
    const ModelEvent& event = problem_.model.experiment.events[number];
    if (std::find(settled.sets.begin(), settled.sets.end(), &event) != settled.sets.end()) {
      out.follows_itself = &event;
      return out;
    }
    sides_[number] = 0;
    out.met.at_zero.push_back({number, 1});
    meet(event, {k, -before, here_.t}, out.met, forwards);
  }
  return out;
}

void Events::note_sets(const Met& met, double bound, bool forwards) {
  if (met.sets.empty()) return;
  for (const ModelEvent* event : met.sets) sets_that_follow_.add(number_of(event), here_.t);
  const auto end = sets_that_follow_.end();  // none where they have become too short: the last one stands
  if (!end || (forwards ? end->t > bound : end->t < bound)) return;
  sets_end_ = end;
  journal_.end_by(problem_.model.experiment.events[end->kinds.front()].span);
}

std::string Events::too_short_to_tell(const ModelEvent& event) const {
  if (sets_end_) return sets_without_end();
  return fmt::format(
      "The event `{}` follows itself faster and faster: its returns accumulate here, and have become too short to be "
      "told apart.",
      event.name);
}

std::string Events::sets_without_end() const {
  return fmt::format(
      "{} faster and faster, infinitely often up to t = {:.12g}: `set` does not say what comes after it. A `contact` "
      "with `restitution` in place of such an event does: bounces on it end at rest.",
      names_of(problem_.model.experiment.events, sets_end_->kinds), sets_end_->t);
}

}  // namespace maupertuis::hybrid
