#pragma once
#include <maupertuis/print.hpp>

namespace maupertuis {

/// e in its readable form; as it is where that would need named intermediates, or, with flat sums, where it is written
/// shorter, as the derivative of a root may be: (x - a)/sqrt((x - a)^2 + y^2).
inline Expr simplified(Expr e, const ReadingOrder& order = {}) {
  const Expr plain = expand_time_derivatives(e);
  const ReadableForm form = readable(plain, order);
  if (!form.intermediates.empty()) return plain;
  const bool has_root = [&] {
    for (const Expr& node : topological_order({&plain, 1}))
      if (node.is(Kind::Power) && node[1].is_number() && !node[1].number().is_integer()) return true;
    return false;
  }();
  if (!has_root) return form.value;
  const Expr flat = with_flat_sums(plain);
  return to_plain(flat, order).size() < to_plain(form.value, order).size() ? flat : form.value;
}

}  // namespace maupertuis
