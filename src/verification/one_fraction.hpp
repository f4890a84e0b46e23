#pragma once
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// a/b with nothing divided in a or in b, as far as denominators are powers with integer exponents.
struct OneFraction {
  Expr above, below;
  Expr value() const { return above / below; }
};

/// A formula over its common denominator, factors that both hold taken out where they show themselves as such:
/// 1/(1 − m c²/(M + m)) is (M + m)/(M + m − m c²). Precondition: it is short enough to be read.
OneFraction as_one_fraction(Expr e, const ReadingOrder& order);

/// In the form that reads best, nothing named.
Expr written_out(Expr e, const ReadingOrder& order);

}  // namespace maupertuis
