#include "quantity.hpp"

#include <fmt/format.h>

#include <cmath>
#include <maupertuis/units.hpp>

namespace maupertuis::app {

std::optional<Rational> parse_exact_time(const std::string& text) {
  // Not strtod: "0x10", "inf" and "nan" are no times. The exponent's e belongs to the number only before a digit.
  std::size_t end = 0;
  const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
  while (is_digit(end) || (end < text.size() && text[end] == '.')) ++end;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '-' || text[end + 1] == '+') ? 1 : 0;
    if (is_digit(end + 1 + sign)) {
      end += 1 + sign;
      while (is_digit(end)) ++end;
    }
  }
  const std::size_t begin = !text.empty() && text[0] == '+' ? 1 : 0;
  if (end < begin) return {};
  const auto number = Rational::parse(std::string_view(text).substr(begin, end - begin));
  if (!number) return {};

  const std::size_t word = text.find_first_not_of(' ', end);
  if (word == std::string::npos) return number;
  const auto unit = find_unit(std::string_view(text).substr(word));
  if (!unit || !(unit->dimension == dimensions::time()) || unit->pi_power != 0) return {};
  return *number * unit->factor;
}

std::optional<double> parse_time(const std::string& text) {
  const std::optional<Rational> exact_time = parse_exact_time(text);
  return exact_time ? std::optional(exact_time->to_double()) : std::nullopt;
}

std::string brief(double value) { return fmt::format("{:.6g}", value); }
std::string exact(double value) { return fmt::format("{}", value); }

}  // namespace maupertuis::app
