#pragma once
#include <maupertuis/fields.hpp>

namespace maupertuis {

/// E0641 where the growth of waves about φ = 0 rises with the wave number without bound, along a space variable or a
/// diagonal: no start determines what follows then.
void refuse_ill_posed(const FieldEquations& equations, Diagnostics& diagnostics);

/// The same about the start of a model whose equations are not linear: E0641, and true.
bool refuse_ill_posed_start(const FieldEquations& equations, Diagnostics& diagnostics);

}  // namespace maupertuis
