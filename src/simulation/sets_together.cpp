#include "simulation/sets_together.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace maupertuis {

std::string set_more_than_once(const MechanicalSystem& system, const std::vector<const ModelEvent*>& events, double t) {
  std::map<std::pair<std::size_t, int>, const ModelEvent*> set_by;
  for (const ModelEvent* event : events)
    for (const ModelEvent::Assignment& a : event->sets) {
      const auto [earlier, is_first] = set_by.insert({{a.coordinate, a.order}, event});
      if (is_first || earlier->second == event) continue;
      return fmt::format(
          "The events `{}` and `{}` both set {}{} at t = {:.9g}, from the state before them: the later one in the text "
          "counts.",
          earlier->second->name, event->name, system.coordinates[a.coordinate].name, a.order == 0 ? "" : "'", t);
    }
  return {};
}

}  // namespace maupertuis
