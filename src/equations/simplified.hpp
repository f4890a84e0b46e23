#pragma once
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// e in its readable form, or as it is where that would need named intermediates.
inline Expr simplified(Expr e, const ReadingOrder& order = {}) {
  const ReadableForm form = readable(e, order);
  return form.intermediates.empty() ? form.value : expand_time_derivatives(e);
}

}  // namespace maupertuis
