#include "simulation/hybrid_journal.hpp"

#include "linear_algebra/independent_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::hybrid {
namespace {

constexpr std::size_t most_happenings = 1'000'000;
constexpr std::size_t first_look = 4'000;        // at their rate
constexpr std::size_t most_numbers = 2'000'000;  // of states that are kept with what happens

}  // namespace

void Journal::start() {
  record_ = {};
  left_out_remarks_ = 0;
  next_look_ = first_look;
  idle_.assign(problem_.system.contacts.size(), false);
}

Happening& Journal::add(Happening::Kind kind, const std::string& name, double impulse, double speed,
                        const std::string& text) {
  const bool keeps_state = record_.happenings.size() * here_.q.size() < most_numbers;
  record_.happenings.push_back({kind, here_.t, 0, name, impulse, speed, text, {}, {}, {}});
  Happening& out = record_.happenings.back();
  if (!keeps_state) return out;
  out.q = here_.q;
  out.v = here_.v;
  return out;
}

void Journal::remark(const std::string& sentence) {
  constexpr std::size_t most = 6;
  if (std::find(record_.remarks.begin(), record_.remarks.end(), sentence) != record_.remarks.end()) return;
  if (record_.remarks.size() < most)
    record_.remarks.push_back(sentence);
  else if (++left_out_remarks_; record_.remarks.size() == most)
    record_.remarks.push_back({});
  if (left_out_remarks_ > 0) record_.remarks.back() = fmt::format("and {} more of the like.", left_out_remarks_);
}

void Journal::stop_by(const std::string& event) {
  if (!record_.stopped_by) record_.stopped_by = event;
}

void Journal::note_errors(std::size_t first, double error) {
  for (std::size_t k = first; k < record_.happenings.size(); ++k)
    record_.happenings[k].error = std::max(record_.happenings[k].error, error);
}

/// Companions look for forces as the run itself does, so that their difference does not tell to what these were sought.
void Journal::note_end_of_rest(std::size_t first) {
  constexpr double in_plane = 4e-12, in_space = 1e-10;  // planes that touch a circular cone leave more of it open
  const double known = problem_.in_space ? in_space : in_plane;
  for (std::size_t k = first; k < record_.happenings.size(); ++k)
    record_.happenings[k].error = known * std::abs(here_.t);
  remark(
      fmt::format("A rest whose forces are not determined ends where none within their limits are found any "
                  "more: that time is known to some {:.0e} of itself.",
                  known));
}

void Journal::tell_limits(const ContactValues& values) {
  const std::size_t contacts = problem_.system.contacts.size();
  for (std::size_t i = 0; i < values.kinetic.size(); ++i)
    if (values.kinetic[i] < 0)
      remark(i < contacts
                 ? fmt::format("The coefficient of friction of the contact {} becomes negative: friction drives "
                               "the motion there, which none does.",
                               problem_.system.contact_label(i))
                 : fmt::format("The friction along {} has a limit or a coefficient that becomes negative: it "
                               "drives the motion there, which no friction does.",
                               problem_.system.frictions[i - contacts].name));
}

void Journal::end_at(double t, bool forwards) {
  std::erase_if(record_.happenings, [&](const Happening& h) { return forwards ? h.t > t : h.t < t; });
}

/// Contacts that are open in a mode whose others keep their gaps at 0: they touch without force.
std::vector<bool> Journal::idle_in(const ContactMode& before, const ContactMode& mode,
                                   std::span<const double> accelerations) const {
  constexpr double rounding = 1e-9;
  const ContactValues& values = here_.values();
  std::vector<bool> out(mode.closed.size(), false);
  std::optional<IndependentRows> carrying;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool touches = before.closed[i] || idle_[i] || std::abs(values.gap[i]) <= rest_unit * sizes_.widest(i);
    if (mode.closed[i] || !touches || std::abs(values.rate[i]) > sizes_.rest_speed(i, values)) continue;
    if (std::abs(sizes_.opening_rate(i, accelerations, here_)) > rounding) continue;
    if (!carrying) carrying = rows_that_carry(mode, values);
    IndependentRows with_this = *carrying;
    out[i] = !with_this.add(whole_row(values.normal[i], here_.q.size()));
  }
  return out;
}

/// ∂g/∂q of closed contacts, beside the rows of constraints and of friction that sticks.
IndependentRows Journal::rows_that_carry(const ContactMode& mode, const ContactValues& values) const {
  IndependentRows out;
  const std::size_t n = here_.q.size();
  for (const SparseRow& row : here_.constraint_rows()) static_cast<void>(out.add(whole_row(row, n)));
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool is_contact = i < mode.closed.size();
    if (is_contact && mode.closed[i]) static_cast<void>(out.add(whole_row(values.normal[i], n)));
    if (mode.friction[i] == FrictionState::Stick) static_cast<void>(out.add(whole_row(values.tangent[i], n)));
  }
  return out;
}

void Journal::begin_in(const ContactMode& before, const ContactMode& mode, std::span<const double> accelerations) {
  record_.first_mode = mode_text(problem_.system, mode);
  idle_ = idle_in(before, mode, accelerations);
  tell_mode(record_.first_mode, size());
}

void Journal::change_mode(const ContactMode& before, const ContactMode& after, std::span<const double> accelerations,
                          const std::optional<EndOfBounces>& end) {
  const std::size_t first = size();
  const std::vector<bool> idle = idle_in(before, after, accelerations);
  for (std::size_t i = 0; i < after.closed.size(); ++i) change_contact(i, before, after, idle, end);
  for (std::size_t i = 0; i < after.friction.size(); ++i) {
    const FrictionState now = after.friction[i];
    if (now == before.friction[i] || now == FrictionState::None) continue;
    const bool closes = i < after.closed.size() && after.closed[i] && !before.closed[i];
    if (closes && now != FrictionState::Stick) continue;  // it was not held: that it slides is told where it closes
    Happening& told =
        add(now == FrictionState::Stick ? Happening::Kind::Stick : Happening::Kind::Slip, problem_.label_of(i));
    if (end && closes) told.t = end->t;
  }
  tell_mode(mode_text(problem_.system, after), first);
  idle_ = idle;
}

/// A contact that carries nothing any more while others keep it closed is not lost, and what it carries again later is
/// not made.
void Journal::change_contact(std::size_t i, const ContactMode& before, const ContactMode& after,
                             const std::vector<bool>& idle, const std::optional<EndOfBounces>& end) {
  using Kind = Happening::Kind;
  const bool touched = before.closed[i] || idle_[i], touches = after.closed[i] || idle[i];
  const std::string label = problem_.system.contact_label(i);
  if (touches && !touched) {
    Happening& told = add(Kind::Made, label);
    if (!end) return;
    told.t = end->t;
    told.remark = fmt::format("the end of infinitely many bounces at t = {:.12g}", end->t);
  } else if (touched && !touches) {
    add(Kind::Lost, label);
  } else if (touches && after.closed[i] != before.closed[i]) {
    add(after.closed[i] ? Kind::Loaded : Kind::Unloaded, label);
  }
}

/// Of what was told from `first` on, and of what was told before of this instant, the mode after it.
void Journal::tell_mode(const std::string& mode, std::size_t first) {
  for (std::size_t k = record_.happenings.size(); k-- > 0;) {
    Happening& h = record_.happenings[k];
    if (k < first && h.t != here_.t) break;
    h.mode = mode;
  }
}

/// Whether something may end the run before its time.
bool Journal::may_stop() const {
  const Experiment& experiment = problem_.model.experiment;
  return experiment.until || std::any_of(experiment.events.begin(), experiment.events.end(),
                                         [](const ModelEvent& e) { return e.action == ModelEvent::Action::Stop; });
}

/// The last three quarters of what happened, in three parts of as many each. Parts of one length go on so. Where events
/// of the model alone become ever denser they go on no slower, by what is known, which ten times as many have to show;
/// impacts that become denser come to an end.
std::optional<Journal::Rate> Journal::rate_so_far(double bound, double t) const {
  constexpr double steady = 1.05, sure = 10;
  const std::size_t last = size() - 1, part = size() / 4;
  const auto time = [&](std::size_t parts) { return record_.happenings[last - parts * part].t; };
  const double length[] = {std::abs(time(0) - time(1)), std::abs(time(1) - time(2)), std::abs(time(2) - time(3))};
  const auto [shortest, longest] = std::minmax({length[0], length[1], length[2]});
  const double left = static_cast<double>(part) * std::abs(bound - t);
  if (longest < steady * shortest) return Rate{part, length[0], left / longest};
  const auto begin = record_.happenings.end() - static_cast<std::ptrdiff_t>(3 * part);
  const bool are_events =
      std::all_of(begin, record_.happenings.end(), [](const Happening& h) { return h.kind == Happening::Kind::Event; });
  if (!are_events || !(length[0] < length[1] && length[1] < length[2])) return std::nullopt;
  return Rate{part, length[0], left / length[0] / sure};
}

std::optional<std::string> Journal::too_many(double t, double bound) {
  constexpr double looks_again = 1.1, well_known = 25e3;  // of so many happenings the rate is that of the run
  const std::size_t count = size();
  if (count > most_happenings)
    return fmt::format("More than {} events and changes of contact: no more are followed.", most_happenings);
  if (count < next_look_) return std::nullopt;
  next_look_ = static_cast<std::size_t>(looks_again * static_cast<double>(count));
  if (may_stop()) return std::nullopt;
  const auto rate = rate_so_far(bound, t);
  const double margin = std::max(1.0, well_known / static_cast<double>(count));
  if (!rate || !(rate->to_come > margin * static_cast<double>(most_happenings))) return std::nullopt;
  return fmt::format(
      "The last {} of {} events and changes of contact followed each other in {:.3g} units of time, and no faster "
      "before: {:.2g} of them or more would come up to the end of the run, and {} are followed at most.",
      rate->count, count, rate->length, rate->to_come, most_happenings);
}

}  // namespace maupertuis::hybrid
