#include "section_budget.hpp"

#include "interrupt.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::app {

using Clock = std::chrono::steady_clock;

const std::vector<std::string>& SectionBudget::names() {
  static const std::vector<std::string> all{"equations", "motion",      "modes",      "orbits",      "paths",
                                            "conserved", "phase-space", "derivation", "expectations"};
  return all;
}

SectionBudget::SectionBudget(std::optional<double> seconds, std::vector<std::string> chosen, const Console& console)
    : end_(Clock::time_point::max()), seconds_(seconds), chosen_(std::move(chosen)), console_(console) {
  if (seconds)
    end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*seconds));
}

bool SectionBudget::wanted(std::string_view section) const {
  return chosen_.empty() || std::find(chosen_.begin(), chosen_.end(), section) != chosen_.end();
}

/// The share of the section that begins, in seconds; nothing without a budget.
std::optional<double> SectionBudget::begin(std::string_view section) {
  Interrupt(&interrupt_flag()).throw_if_asked();
  const double left = seconds_ ? std::max(0.0, std::chrono::duration<double>(end_ - Clock::now()).count()) : 0;
  if (ProgressLine* const line = console_.progress())
    line->tell_now(seconds_ ? fmt::format("{} ({:.0f} s of {:.0f} s left)", section, left, *seconds_)
                            : std::string(section));
  return seconds_ ? std::optional(left / 2) : std::nullopt;
}

/// A section may have several parts; it came if all of them did.
void SectionBudget::note(std::string_view section, bool came) {
  const auto is_it = [&](const std::string& name) { return name == section; };
  const bool missed = std::any_of(left_out_.begin(), left_out_.end(), is_it);
  written_.erase(std::remove_if(written_.begin(), written_.end(), is_it), written_.end());
  if (came && !missed) written_.emplace_back(section);
  if (!came && !missed) left_out_.emplace_back(section);
}

bool SectionBudget::carry_out(std::string_view section, Context& context,
                              const std::function<void(const Interrupt&)>& work) {
  return wanted(section) && attempt(section, context, work);
}

bool SectionBudget::attempt(std::string_view section, Context& context,
                            const std::function<void(const Interrupt&)>& work) {
  const Deadline deadline(begin(section));
  const Interrupt interrupt = &deadline.flag();
  bool came = false;
  try {
    const InterruptScope scope(context, interrupt);
    work(interrupt);
    came = !interrupt.asked();
  } catch (const Interrupted&) {
  }
  Interrupt(&interrupt_flag()).throw_if_asked();
  note(section, came);
  return came;
}

void SectionBudget::carry_out_in_part(std::string_view section, const std::function<void(const Interrupt&)>& work) {
  if (!wanted(section)) return;
  const Deadline deadline(begin(section));
  work(&deadline.flag());
  Interrupt(&interrupt_flag()).throw_if_asked();
  note(section, true);
}

void SectionBudget::leave_out(std::string_view section) {
  if (wanted(section)) note(section, false);
}

Diagnostics SectionBudget::warnings() const {
  Diagnostics out;
  const double seconds = seconds_.value_or(0);
  for (const std::string& section : left_out_) {
    const bool named = std::find(names().begin(), names().end(), section) != names().end();
    out.warning(
        "W0813", {}, fmt::format("the section `{}` is left out", section),
        fmt::format(
            "It did not come in its share of the budget of {} s: no section takes more than half of what is left.",
            brief(seconds)),
        fmt::format("Give it more time, --budget {}s{}.", brief(10 * seconds),
                    named ? fmt::format(", or ask for it alone: --sections {}", section) : ""));
  }
  return out;
}

}  // namespace maupertuis::app
