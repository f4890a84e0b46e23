#include "kernel/series/sine_cosine.hpp"

#include <cmath>

namespace maupertuis::series {

double standard_sine(double x) { return std::sin(x); }
double standard_cosine(double x) { return std::cos(x); }

}  // namespace maupertuis::series
