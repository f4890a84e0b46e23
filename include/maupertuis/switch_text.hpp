#pragma once
#include <maupertuis/transform.hpp>

#include <string>

namespace maupertuis {

/// Where a switch is, as a reader would write it: x - a → "x = a", 4 - 2 x → "2 x = 4". What changes stands on the
/// left, parameters and numbers on the right. Empty where that is longer than a line.
std::string switch_text(Expr difference, const ReadingOrder& order);

/// Which side is meant by g > 0: "x > a" of x - a, "x < a" of a - x. Empty as above.
std::string side_text(Expr difference, bool above, const ReadingOrder& order);

}  // namespace maupertuis
