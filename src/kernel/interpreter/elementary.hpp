#pragma once
#include <maupertuis/expression.hpp>

#include <span>

namespace maupertuis::interpreter {

/// f(x) of an elementary function of one argument, or f(x, y) of atan2.
double elementary(Kind function, double x, double y = 0);

/// Any operation on constants: sums, products, powers, functions, comparisons (1 or 0), piecewise.
double constant_operation(Kind kind, std::span<const double> operands);

}  // namespace maupertuis::interpreter
