#include "simulation/hybrid_met.hpp"

#include <algorithm>

namespace maupertuis::hybrid {

const Zero* Met::zero_of(std::size_t event) const {
  const auto found = std::find_if(at_zero.begin(), at_zero.end(), [&](const Zero& z) { return z.event == event; });
  return found == at_zero.end() ? nullptr : &*found;
}

bool Met::ends(const Watch& watch) const {
  return std::any_of(left.begin(), left.end(), [&](const Watch& x) {
    return x.what == watch.what && x.index == watch.index && x.lower == watch.lower;
  });
}

bool Met::ends(Watch::What what, std::size_t index) const {
  return std::any_of(left.begin(), left.end(), [&](const Watch& x) { return x.what == what && x.index == index; });
}

bool sets_positions(const std::vector<const ModelEvent*>& events) {
  return std::any_of(events.begin(), events.end(), [](const ModelEvent* e) {
    return std::any_of(e->sets.begin(), e->sets.end(), [](const ModelEvent::Assignment& a) { return a.order == 0; });
  });
}

}  // namespace maupertuis::hybrid
