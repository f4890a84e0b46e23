#include "verification/phrases.hpp"

#include <fmt/format.h>

namespace maupertuis::phrases {

std::string of_factor(const Rational& number) {
  if (number.is_zero()) return "is missing";
  if (number == Rational(-1)) return "has the wrong sign";
  const Rational inverse = Rational(1) / number;
  if (number.is_integer()) return fmt::format("has a factor {} too many", number.to_string());
  if (inverse.is_integer()) return fmt::format("lacks a factor {}", inverse.to_string());
  return fmt::format("is {} of what it should be", number.to_string());
}

std::string of_ratio_to_inertia(const Rational& number) {
  return fmt::format("what stands beside the inertia {}, or the inertia {}", of_factor(number),
                     of_factor(Rational(1) / number));
}

}  // namespace maupertuis::phrases
