#pragma once
#include <maupertuis/rational.hpp>

#include <optional>

namespace maupertuis {

/// How many places a value has that is written as a decimal, as 981/100 is; nothing where it is written as a fraction:
/// 1/3, or 1/4096, whose decimal is longer. A denominator of more than ten digits is no easier to read: such a value is
/// a decimal up to 30 places.
std::optional<int> decimal_places(const Rational& value);

}  // namespace maupertuis
