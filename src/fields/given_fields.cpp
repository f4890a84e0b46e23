#include "fields/given_fields.hpp"

namespace maupertuis {

Expr with_given_fields(const FieldSystem& s, Expr e) {
  e = s.expanded(e);
  ExprMap map;
  for (const Expr& symbol : s.jets_in(e)) {
    const FieldJet jet = *s.jet_of(symbol);
    Expr value = s.fields[jet.field].formula;
    if (!s.fields[jet.field].given || !value) continue;
    for (std::size_t x = 0; x < s.space.size(); ++x)
      for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s.space[x].symbol);
    for (int k = 0; k < jet.time; ++k) value = differentiate(value, s.context->time());
    map[symbol] = value;
  }
  return s.expanded(substitute(e, map));
}

}  // namespace maupertuis
