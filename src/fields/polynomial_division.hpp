#pragma once
#include <maupertuis/expression.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// The coefficients of what `dividend` leaves as a polynomial in `x` when it is divided by `divisor`, times a power of
/// the leading coefficient of that: all vanish where every root of `divisor` is one of `dividend`. Nothing where one of
/// them is no polynomial in x of a degree up to 24, or `divisor` does not hold x.
std::optional<std::vector<Expr>> remainder_of_division(Expr dividend, Expr divisor, Expr x);

}  // namespace maupertuis
