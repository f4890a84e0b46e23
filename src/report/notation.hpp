#pragma once
#include <string>

namespace maupertuis {

/// A number as a reader wants it: up to `digits`, "0.6", "3.2e-15".
std::string short_number(double value, int digits = 6);
/// With its unit, if it has one.
std::string quantity(double value, const std::string& unit, int digits = 6);

}  // namespace maupertuis
