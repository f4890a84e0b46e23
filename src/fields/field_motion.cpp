#include "fields/field_motion.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {

double FieldMotion::value_of(Expr e, const Bindings& extra) const {
  Bindings all = values_;
  all.insert(extra.begin(), extra.end());
  return evaluate(s_.expanded(e), all);
}

std::size_t FieldMotion::varied(std::size_t field) const {
  std::size_t a = 0;
  while (a < equations_.varied.size() && equations_.varied[a] != field) ++a;
  return a;
}

double FieldMotion::answer_at_places(Expr value, double shift) const {
  Bindings extra{{s_.context->time(), t_}};
  for (const PlaceValue& place : equations_.model->places) {
    const FieldJet jet = *s_.jet_of(place.jet);
    const std::size_t a = varied(jet.field);
    if (a == equations_.varied.size()) {
      extra[place.symbol] = std::nan("");
      continue;
    }
    const double x = value_of(place.place[0], {}), right = value_of(s_.space.front().to, {});
    const double moved = shift == 0 ? x : std::min(std::max(x + shift, left_), right);
    extra[place.symbol] = field_at(a, jet.time, jet.space[0], moved);
  }
  return value_of(value, extra);
}

}  // namespace maupertuis
