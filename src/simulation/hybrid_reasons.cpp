#include "simulation/hybrid_modes.hpp"

#include "linear_algebra/combinations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

/// Why no mode fits at an instant.
namespace maupertuis::hybrid {

/// A friction whose static limit has fallen below the kinetic one: what lets it go brakes it more than what held it.
std::optional<std::string> ModeChoice::weaker_at_rest(const std::vector<Choice>& list,
                                                      const ContactValues& values) const {
  constexpr double rounding = 1e-12;
  for (const Choice& c : list) {
    const std::size_t i = c.contact;
    if (c.options.size() < 3 || !(values.fixed[i] < (1 - rounding) * values.kinetic[i])) continue;
    return fmt::format(
        "Static friction of {} has fallen below kinetic friction here: once it slides it is held, and once it is held "
        "it "
        "slides.",
        problem_.label_of(i));
  }
  return std::nullopt;
}

/// Whether frictions at rest hold more than the rest needs.
bool ModeChoice::is_shared(const std::vector<Choice>& list, const ContactValues& values) const {
  const auto is_at_rest = [&](std::size_t i) {
    const bool in_space = friction_of(problem_.system, i).in_space();
    return in_space ? slip_speed(i, values) <= slips_.stop_speed(i)
                    : std::abs(values.slip[i]) <= sizes_.rest_slip(i, values);
  };
  ContactMode rest = choices_.mode_of(list, std::vector<std::size_t>(list.size(), 0));
  std::vector<std::size_t> resting;
  for (const Choice& c : list) {
    if (!friction_of(problem_.system, c.contact).present() || !is_at_rest(c.contact)) continue;
    resting.push_back(c.contact);
    rest.friction[c.contact] = FrictionState::Stick;
    if (c.contact < rest.closed.size()) rest.closed[c.contact] = true;
  }
  return std::any_of(resting.begin(), resting.end(),
                     [&](std::size_t i) { return undetermined_.is_held(i, rest, values); });
}

/// Whether in one of the modes that are possible more normal force makes a contact close faster.
bool ModeChoice::may_be_painleve(const std::vector<Choice>& list, const ContactValues& values) const {
  constexpr std::size_t most = 256;
  std::vector<std::size_t> counts;
  for (const Choice& c : list) counts.push_back(c.options.size());
  Combinations tries(std::move(counts), most);
  for (std::size_t turn = 0; turn < most; ++turn) {
    const std::vector<std::size_t>* taken = tries.number(turn);
    if (!taken) return false;
    if (may_be_several(choices_.mode_of(list, *taken), values)) return true;
  }
  return false;
}

/// One sentence.
std::string ModeChoice::why_none_fits(const std::vector<Choice>& list, const Instant& at, bool were_many) const {
  if (list.empty() && !trials_.no_motion().empty()) return trials_.no_motion();
  const ContactValues& values = here_.values();
  const bool rubs = std::any_of(list.begin(), list.end(), [](const Choice& c) { return c.options.size() > 2; }) ||
                    std::any_of(at.touching.begin(), at.touching.end(),
                                [&](std::size_t i) { return problem_.system.contacts[i].friction.present(); });
  if (!rubs)
    return were_many
               ? fmt::format("None of the {} modes that were tried fits the contacts that touch here.", most_choices)
               : "No forces keep all contacts that touch here from closing.";
  if (auto weak = weaker_at_rest(list, values)) return *std::move(weak);
  if (finds_no_directions_)
    return "Slips in space begin here, and no directions were found along which all of them grow, as where a body "
           "turns about a foot whose friction is just at its limit.";
  if (is_shared(list, values))
    return "Friction at several places holds more than the rest needs here, so that its forces are not determined "
           "(statically indeterminate), and none that keep the limits of friction were found.";
  return may_be_painleve(list, values)
             ? "Painlevé's paradox: no finite forces of contact and friction fit the motion here. " +
                   std::string(beyond_painleve)
             : "No mode of the contacts and frictions that touch here keeps its own conditions, to rounding.";
}

}  // namespace maupertuis::hybrid
