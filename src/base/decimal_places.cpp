#include <maupertuis/decimal_places.hpp>

#include <cstdint>

namespace maupertuis {

std::optional<int> decimal_places(const Rational& value) {
  constexpr int most_of_short = 9, most_of_long = 30;
  const auto small = value.small();
  constexpr std::int64_t longest_short = 9'999'999'999;
  const int most = small && small->denominator <= longest_short ? most_of_short : most_of_long;
  if (!(value * pow(Rational(10), most)).is_integer()) return std::nullopt;
  int places = 0;
  for (Rational shifted = value; !shifted.is_integer(); shifted = shifted * Rational(10)) ++places;
  return places;
}

}  // namespace maupertuis
