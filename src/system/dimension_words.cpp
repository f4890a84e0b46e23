#include "system/value.hpp"

#include <fmt/format.h>

namespace maupertuis::elaboration {

Dimension without_angle(Dimension dimension) {
  const bool bare = dimension.is_one();
  const bool rate = (dimension / dimensions::time()).same_as(Dimension{}) ||
                    (dimension * dimensions::time()).same_as(Dimension{}) ||
                    (dimension * dimensions::time() * dimensions::time()).same_as(Dimension{});
  if (!bare && !rate) dimension.exponents[Dimension::Angle] = {};
  return dimension;
}

std::string describe(const Dimension& dimension) {
  const Dimension shown = physical_name(dimension).empty() ? without_angle(dimension) : dimension;
  if (shown == Dimension{}) return "a bare number";
  const std::string name = physical_name(shown), unit = to_string(shown);
  if (name.empty()) return fmt::format("a quantity in {}", unit);
  const bool vowel = std::string("aeiou").find(name.front()) != std::string::npos;
  return fmt::format("{} {} ({})", vowel ? "an" : "a", name, unit);
}

}  // namespace maupertuis::elaboration
