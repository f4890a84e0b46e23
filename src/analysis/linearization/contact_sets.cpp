#include "analysis/linearization/contact_sets.hpp"

#include "analysis/linearization/lowest_place.hpp"
#include "analysis/linearization/mode_at_rest.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr std::size_t most_sets = 64;

/// The system with all contacts open and without friction.
ContactMode free_mode(const MechanicalSystem& system) {
  ContactMode mode = open_mode(system);
  std::fill(mode.friction.begin(), mode.friction.end(), FrictionState::None);
  return mode;
}

}  // namespace

ContactSets contact_sets(const MechanicalSystem& system, const MotionState& start) {
  const std::size_t contacts = system.contacts.size();
  ContactSets out{{}, std::ldexp(1.0, static_cast<int>(contacts))};
  const bool are_few = out.all <= static_cast<double>(most_sets);
  const auto add = [&](const std::vector<bool>& closed) {
    if (out.chosen.size() < most_sets && std::find(out.chosen.begin(), out.chosen.end(), closed) == out.chosen.end())
      out.chosen.push_back(closed);
  };
  if (!are_few) {
    const ModeAtRest free(system, free_mode(system));
    const OperatingPoint place = point_at_rest(free.points(), start);
    if (const auto touching = free.touching(place)) add(*touching);
    add(touching_at_lowest_place(*free.equations(), system, place));
    add(std::vector<bool>(contacts, true));
  }
  for (std::size_t size = 0; size <= contacts && out.chosen.size() < most_sets; ++size) {
    std::vector<bool> closed(contacts, false);
    std::fill_n(closed.begin(), size, true);
    do add(closed);
    while (out.chosen.size() < most_sets && std::prev_permutation(closed.begin(), closed.end()));
  }
  return out;
}

}  // namespace maupertuis
