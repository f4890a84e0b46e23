#include "report/notation.hpp"

#include <fmt/format.h>

namespace maupertuis {

std::string short_number(double value, int digits) { return fmt::format("{:.{}g}", value == 0 ? 0 : value, digits); }

std::string quantity(double value, const std::string& unit, int digits) {
  return unit.empty() || unit == "1" ? short_number(value, digits) : short_number(value, digits) + " " + unit;
}

}  // namespace maupertuis
