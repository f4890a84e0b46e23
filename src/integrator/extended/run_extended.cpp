#include "integrator/extended/motion.hpp"
#include "kernel/extended/number.hpp"

#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {

using extended::Real;

namespace {

#ifdef __EMSCRIPTEN__
constexpr bool has_narrow = false;
#else
constexpr bool has_narrow = true;
#endif

}  // namespace

Mantissa compiled_mantissa(Mantissa mantissa) {
  if (has_narrow) return mantissa;
  return mantissa == Mantissa::Bits113 || mantissa == Mantissa::Bits384 ? Mantissa::Bits384 : Mantissa::Bits448;
}

ExtendedMotion run_extended(const ExtendedProblem& problem, Mantissa mantissa, const ExtendedOptions& options) {
  const Mantissa compiled = compiled_mantissa(mantissa);
  if constexpr (has_narrow) {
    if (compiled == Mantissa::Bits113) return extended::run_motion<Real<113>>(problem, options);
    if (compiled == Mantissa::Bits192) return extended::run_motion<Real<192>>(problem, options);
  }
  return compiled == Mantissa::Bits384 ? extended::run_motion<Real<384>>(problem, options)
                                       : extended::run_motion<Real<448>>(problem, options);
}

int bits_of(Mantissa mantissa) {
  switch (mantissa) {
    case Mantissa::Bits113:
      return 113;
    case Mantissa::Bits192:
      return 192;
    case Mantissa::Bits384:
      return 384;
    case Mantissa::Bits448:
      break;
  }
  return 448;
}

double log2_rounding(Mantissa mantissa) { return 1 - bits_of(mantissa); }

namespace {

using Widest = Real<448>;

/// "d.ddde±xx" as people write it where the point falls near the digits.
std::string plain(const std::string& scientific) {
  const std::size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  const bool negative = scientific[0] == '-';
  std::string digits;
  for (const char c : scientific.substr(0, e))
    if (c >= '0' && c <= '9') digits += c;
  if (exponent < -5 || exponent >= static_cast<int>(digits.size()))
    return fmt::format("{}e{}", scientific.substr(0, e), exponent);
  if (exponent < 0) digits.insert(0, static_cast<std::size_t>(-exponent), '0');
  const auto point = static_cast<std::size_t>(std::max(exponent, 0)) + 1;
  if (point < digits.size()) digits.insert(point, ".");
  return (negative ? "-" : "") + digits;
}

/// One digit, "d e±xx": Boost takes 0 places as "all of them".
std::string one_digit(const Widest& value) {
  const std::string many = value.str(17, std::ios_base::scientific);
  const std::size_t e = many.find('e');
  int exponent = std::stoi(many.substr(e + 1));
  long digit = std::lround(std::stod(many.substr(0, e)));
  if (std::labs(digit) == 10) digit /= 10, ++exponent;
  return fmt::format("{}e{}", digit, exponent);
}

std::string with_digits(const Widest& value, int digits) {
  return digits == 1 ? one_digit(value) : value.str(digits - 1, std::ios_base::scientific);
}

}  // namespace

AgreedNumber agreed_number(const std::string& rough, const std::string& fine, int most_digits) {
  const Widest value(fine), difference = abs(Widest(rough) - value);
  AgreedNumber out;
  out.difference = difference == 0 ? "0" : difference.str(1, std::ios_base::scientific);
  if (value == 0 && difference == 0) return {"0", most_digits, "0"};
  if (value == 0) return {"0", 0, out.difference};
  int digits = most_digits;
  if (difference != 0) {
    const std::string leading = value.str(1, std::ios_base::scientific);
    const int exponent = std::stoi(leading.substr(leading.find('e') + 1));
    digits = std::min(
        digits, static_cast<int>(std::floor(exponent + 1 - (1 + extended::log2_size(difference)) * std::log10(2.0))));
  }
  if (digits < 1) return {"0", 0, out.difference};
  out.digits = digits;
  out.text = plain(with_digits(value, digits));
  return out;
}

}  // namespace maupertuis
