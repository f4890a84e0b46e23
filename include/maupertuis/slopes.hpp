#pragma once
#include <maupertuis/expression.hpp>

namespace maupertuis {

/// The largest |f′| of an elementary function of one argument on the complex disk of radius d > 0 about the real number
/// w; infinite where the disk meets a singularity. low: a lower bound of |w| on it. Not for sin, cos, sinh and cosh,
/// whose bounds are sharper without it: std::logic_error for these and for what is no such function.
double largest_slope(Kind function, double w, double d, double low);

}  // namespace maupertuis
