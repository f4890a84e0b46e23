#pragma once
#include "kernel/program/program.hpp"

#include <vector>

namespace maupertuis {

/// The degree of what is no polynomial in t: its series has no end.
inline constexpr int not_polynomial = 1'000'000;

/// The degrees in t of all slots but those of observables where coordinates are polynomials of this degree. Bounds:
/// terms may cancel. A power with a constant exponent is not looked into. [slots]
std::vector<int> degrees_in_time(const Program& program, int of_coordinates);

/// Whether every motion is a polynomial of second degree under each choice of sides: along all of these the residual
/// does not change, and it vanishes as they begin. Forces and M that are constant, constraints that are linear with
/// constant coefficients.
bool moves_on_parabolas(const Program& program);

}  // namespace maupertuis
