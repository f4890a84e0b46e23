#include <maupertuis/uncertainty.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace maupertuis {
namespace {

/// A value as text whose last digit stands at a decimal place, and the power of ten behind it.
struct Cut {
  std::string digits;
  int exponent = 0;  // 0: none is written
};

int exponent_of(const std::string& scientific) { return std::atoi(scientific.c_str() + scientific.find('e') + 1); }
/// Of the leading digit of x > 0, as printing finds it: a logarithm may round to the wrong side.
int leading_exponent(double x) { return exponent_of(fmt::format("{:.16e}", x)); }

Cut in_fixed_notation(double value, int place) {
  std::string text = fmt::format("{:.{}f}", value, -place);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text[0] == '-') text.erase(0, 1);
  return {text, 0};
}

Cut in_powers_of_ten(double value, int leading, int place) {
  if (leading < place) return {"0", place};
  const std::string text = fmt::format("{:.{}e}", value, leading - place);
  std::string digits = text.substr(0, text.find('e'));
  // 9.96 became 1.0 times 10: the last digit has moved up by one place.
  if (exponent_of(text) > leading) digits += leading == place ? ".0" : "0";
  return {digits, exponent_of(text)};
}

Cut cut(double value, int place) {
  constexpr int smallest = -5, largest = 15;  // beyond, a power of ten reads better
  const int leading = value == 0 ? place - 1 : leading_exponent(std::abs(value));
  const int first = std::max(place, leading);
  return place <= 0 && first >= smallest && first <= largest ? in_fixed_notation(value, place)
                                                             : in_powers_of_ten(value, leading, place);
}

double read(const std::string& digits, int exponent) {
  return std::strtod(fmt::format("{}e{}", digits, exponent).c_str(), nullptr);
}

}  // namespace

std::string with_uncertainty(double value, double error) {
  if (std::isnan(error) || !std::isfinite(value)) return fmt::format("{}", value);
  if (error == 0) return fmt::format("{}", value == 0 ? 0.0 : value);
  if (std::isinf(error)) return "?";
  for (int place = leading_exponent(error);; ++place) {
    const Cut shown = cut(value, place);
    const double off = error + std::abs(read(shown.digits, shown.exponent) - value);
    const double units = std::max(1.0, std::ceil(off / read("1", place) * (1 - 1e-9)));
    if (units > 9) continue;  // it takes two digits: the next place does with one
    return fmt::format("{}({:.0f}){}", shown.digits, units,
                       shown.exponent == 0 ? "" : fmt::format("e{}", shown.exponent));
  }
}

}  // namespace maupertuis
