#pragma once
#include <maupertuis/expression.hpp>

namespace maupertuis {

/// The sum of the absolute values of the terms, where products of sums are multiplied out: what a sum is rounded by.
Expr size_of_terms(Expr e);

}  // namespace maupertuis
