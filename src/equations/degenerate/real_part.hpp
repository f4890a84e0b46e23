#pragma once
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// The zeros of e as regular equations: factors that do not vanish (numbers, parameters, exponentials, denominators)
/// are left out, powers become their bases, and a sum of even powers with coefficients of one sign becomes one
/// equation for each of them. The gradient of z² vanishes where z = 0, that of z does not. Readable.
ExprVector real_parts(Expr e, const ReadingOrder& order, const ExprVector& states);

}  // namespace maupertuis
