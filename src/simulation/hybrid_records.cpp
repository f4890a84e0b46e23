#include "linear_algebra/independent_rows.hpp"
#include "simulation/hybrid_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// What is told of the modes that a motion goes through, and how much of it.
namespace maupertuis {
namespace {

constexpr std::size_t most_happenings = 10'000'000;
constexpr std::size_t many_happenings = 10'000;  // after which their rate is looked at again

}  // namespace

std::vector<double> whole_row(const SparseRow& row, std::size_t n) {
  std::vector<double> out(n, 0);
  for (const auto& [k, x] : row) out[k] = x;
  return out;
}

std::vector<std::string> HybridMotion::labels_of(std::vector<std::size_t> places) const {
  std::sort(places.begin(), places.end());
  std::vector<std::string> out;
  for (const std::size_t i : places) out.push_back(label_of(i));
  return out;
}

/// Of a rest whose forces were not determined, in what was recorded from `first` on: companions look for forces as the
/// run itself does, so that their difference does not tell to what these were sought.
void HybridMotion::note_end_of_rest(std::size_t first) {
  constexpr double in_plane = 4e-12, in_space = 1e-10;  // planes that touch a circular cone leave more of it open
  const double known = in_space_ ? in_space : in_plane;
  for (std::size_t k = first; k < record_.happenings.size(); ++k)
    record_.happenings[k].error = known * std::abs(here_.t);
  remark(
      fmt::format("A rest whose forces are not determined ends where none within their limits are found any "
                  "more: that time is known to some {:.0e} of itself.",
                  known));
}

/// Of a contact, or of the coordinate of a friction.
std::string HybridMotion::label_of(std::size_t i) const {
  const std::size_t contacts = system_.contacts.size();
  return i < contacts ? system_.contact_label(i) : system_.frictions[i - contacts].name;
}

/// Contacts that are open in a mode whose others keep their gaps at 0: they touch without force.
std::vector<bool> HybridMotion::idle_in(const ContactMode& before, const ContactMode& mode,
                                        std::span<const double> accelerations) {
  constexpr double rounding = 1e-9;
  const ContactValues& values = here_.values();
  std::vector<bool> out(mode.closed.size(), false);
  std::optional<IndependentRows> carrying;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool touches = before.closed[i] || idle_[i] || std::abs(values.gap[i]) <= rest_unit * sizes_.widest(i);
    if (mode.closed[i] || !touches || std::abs(values.rate[i]) > sizes_.rest_speed(i, values)) continue;
    if (std::abs(opening_rate(i, accelerations, values)) > rounding) continue;
    if (!carrying) carrying = rows_that_carry(mode, values);
    IndependentRows with_this = *carrying;
    out[i] = !with_this.add(whole_row(values.normal[i], here_.q.size()));
  }
  return out;
}

/// ∂g/∂q of closed contacts, beside the rows of constraints and of friction that sticks.
IndependentRows HybridMotion::rows_that_carry(const ContactMode& mode, const ContactValues& values) {
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

/// A contact that carries nothing any more while others keep it closed is not lost, and what it carries again later is
/// not made.
void HybridMotion::record_contact(std::size_t i, const ContactMode& before, const ContactMode& after,
                                  const std::vector<bool>& idle) {
  using Kind = Happening::Kind;
  const bool touched = before.closed[i] || idle_[i], touches = after.closed[i] || idle[i];
  const std::string label = system_.contact_label(i);
  if (touches && !touched) {
    add(Kind::Made, label, 0, 0, accumulated_.value_or(""));
    if (accumulated_) record_.happenings.back().t = accumulated_at_;
  } else if (touched && !touches) {
    add(Kind::Lost, label);
  } else if (touches && after.closed[i] != before.closed[i]) {
    add(after.closed[i] ? Kind::Loaded : Kind::Unloaded, label);
  }
}

void HybridMotion::record_changes(const ContactMode& before, const ContactMode& after,
                                  std::span<const double> accelerations) {
  const std::string text = mode_text(system_, after);
  const std::size_t begin = record_.happenings.size();
  const std::vector<bool> idle = idle_in(before, after, accelerations);
  if (!started_) {
    record_.first_mode = text;
  } else {
    for (std::size_t i = 0; i < after.closed.size(); ++i) record_contact(i, before, after, idle);
    for (std::size_t i = 0; i < after.friction.size(); ++i) {
      const FrictionState now = after.friction[i];
      if (now == before.friction[i] || now == FrictionState::None) continue;
      add(now == FrictionState::Stick ? Happening::Kind::Stick : Happening::Kind::Slip, label_of(i));
      const bool is_made_then = i < after.closed.size() && after.closed[i] && !before.closed[i];
      if (accumulated_ && is_made_then) record_.happenings.back().t = accumulated_at_;
    }
  }
  for (std::size_t k = record_.happenings.size(); k-- > 0;) {
    Happening& h = record_.happenings[k];
    if (k < begin && h.t != here_.t) break;
    h.mode = text;
  }
  idle_ = idle;
}

/// Events and changes that come at a steady rate, which meets more of them up to the end of the run than are followed,
/// end it when that is seen. A rate that grows may come to its end: those are counted.
std::optional<Step> HybridMotion::too_many(double bound) {
  constexpr double steady = 1.05;
  const std::size_t count = record_.happenings.size();
  if (count > most_happenings)
    return ended(StepEnding::Unending, fmt::format("More than {} events and changes of contact.", most_happenings));
  if (count < many_happenings * (counted_at_.size() + 1)) return std::nullopt;
  counted_at_.push_back(time());
  if (counted_at_.size() < 4) return std::nullopt;
  const auto last = [&](std::size_t k) {
    const std::size_t i = counted_at_.size() - k;
    return std::abs(counted_at_[i] - counted_at_[i - 1]);
  };
  const auto [shortest, longest] = std::minmax({last(1), last(2), last(3)});
  const double to_come = static_cast<double>(many_happenings) * std::abs(bound - time()) / longest;
  if (!(longest < steady * shortest) || !(to_come > static_cast<double>(most_happenings))) return std::nullopt;
  return ended(StepEnding::Unending,
               fmt::format("{} events and changes of contact follow each other in {:.3g} units of time, and as fast "
                           "before: {:.2g} of them would come up to the end of the run, and {} are followed at most.",
                           many_happenings, longest, to_come, most_happenings));
}

}  // namespace maupertuis
