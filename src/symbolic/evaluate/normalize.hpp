#pragma once
#include <maupertuis/expression.hpp>

#include <span>
#include <vector>

namespace maupertuis::evaluation {

/// Flattens the arguments of sin, cos, tan, exp and the hyperbolic functions, and symbolic exponents, to sums of
/// rational multiples of basis elements: sin(ω (t − t0)) → sin(ω t − ω t0). This is the common ℚ-basis of the zero
/// test: two arguments with a rational relation share their basis elements. Nothing else is rewritten.
std::vector<Expr> flatten_arguments(std::span<const Expr> roots);

}  // namespace maupertuis::evaluation
