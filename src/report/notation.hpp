#pragma once
#include <maupertuis/transform.hpp>
#include <maupertuis/units.hpp>

#include <string>
#include <string_view>

namespace maupertuis {

/// MathML of the left side of a derivation step, from its plain text: `d/dt ∂L/∂θ1'`, `v_A^2`, `T(particle A)`, `A.x'`.
/// Derivatives by t are dots; by another variable, primes, as in the formulas beside it.
std::string left_side_mathml(std::string_view plain, bool primes = false);
/// Whether another variable than t stands in its place.
bool derivatives_are_primes(const ReadingOrder& order);

/// The SI value of one unit as a user writes it, `N s/m`, `kg m^2`, `J/(kg K)`; 0 where it cannot be read.
double unit_factor(std::string_view unit);

/// A number as a reader wants it: up to `digits`, "0.6", "3.2e-15".
std::string short_number(double value, int digits = 6);
/// With its unit, if it has one.
std::string quantity(double value, const std::string& unit, int digits = 6);

}  // namespace maupertuis
