#pragma once
#include <maupertuis/print.hpp>

namespace maupertuis {

/// e in its readable form; as it is where that would need named intermediates, or where it is written shorter, as the
/// derivative of a root may be: (x - a)/sqrt((x - a)^2 + y^2).
inline Expr simplified(Expr e, const ReadingOrder& order = {}) {
  const Expr plain = expand_time_derivatives(e);
  const ReadableForm form = readable(plain, order);
  if (!form.intermediates.empty()) return plain;
  const bool has_root = [&] {
    for (const Expr& node : topological_order({&plain, 1}))
      if (node.is(Kind::Power) && node[1].is_number() && !node[1].number().is_integer()) return true;
    return false;
  }();
  return has_root && to_plain(plain, order).size() < to_plain(form.value, order).size() ? plain : form.value;
}

}  // namespace maupertuis
