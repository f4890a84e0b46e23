#pragma once
#include "kernel/straight_line/builder.hpp"

namespace maupertuis::straight {

/// a^p; by roots and products where p is half of a small odd number.
Value power(Builder& to, Value a, Value p);

}  // namespace maupertuis::straight
