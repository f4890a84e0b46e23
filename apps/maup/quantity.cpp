#include "quantity.hpp"

#include <fmt/format.h>

#include <cmath>
#include <maupertuis/units.hpp>
#include <numbers>

namespace maupertuis::app {

namespace {

/// The number that a text begins with; its end, at the beginning where there is none.
std::size_t end_of_number(const std::string& text) {
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
  return end;
}

/// A number of units of time, or the number alone for seconds.
std::optional<Rational> seconds_in(const std::string& text, std::size_t word) {
  word = text.find_first_not_of(' ', word);
  if (word == std::string::npos) return Rational(1);
  const auto unit = find_unit(std::string_view(text).substr(word));
  if (!unit || !(unit->dimension == dimensions::time()) || unit->pi_power != 0) return {};
  return unit->factor;
}

/// `pi`, `2 pi`, `2*pi/3 ms`: the times of oscillations of a model whose frequencies are numbers.
std::optional<double> parse_multiple_of_pi(const std::string& text) {
  std::size_t end = end_of_number(text);
  const auto factor = end == 0 ? std::optional(Rational(1)) : Rational::parse(std::string_view(text).substr(0, end));
  if (end > 0) end = text.find_first_not_of(" *", end);
  if (!factor || end == std::string::npos) return {};
  if (text.compare(end, 2, "pi") != 0 && text.compare(end, 2, "π") != 0) return {};
  end += 2;
  Rational divisor(1);
  if (end < text.size() && text[end] == '/') {
    const std::string rest = text.substr(end + 1);
    const std::size_t length = end_of_number(rest);
    const auto number = Rational::parse(std::string_view(rest).substr(0, length));
    if (!number || number->is_zero()) return {};
    divisor = *number;
    end += 1 + length;
  }
  const auto unit = seconds_in(text, end);
  return unit ? std::optional(std::numbers::pi * (*factor / divisor * *unit).to_double()) : std::nullopt;
}

}  // namespace

std::optional<Rational> parse_exact_time(const std::string& text) {
  const std::size_t end = end_of_number(text);
  const std::size_t begin = !text.empty() && text[0] == '+' ? 1 : 0;
  if (end < begin) return {};
  const auto number = Rational::parse(std::string_view(text).substr(begin, end - begin));
  if (!number) return {};
  const auto unit = seconds_in(text, end);
  return unit ? std::optional(*number * *unit) : std::nullopt;
}

std::optional<double> parse_time(const std::string& text) {
  const std::optional<Rational> exact_time = parse_exact_time(text);
  return exact_time ? std::optional(exact_time->to_double()) : parse_multiple_of_pi(text);
}

std::string brief(double value) { return fmt::format("{:.6g}", value); }
std::string exact(double value) { return fmt::format("{}", value); }

}  // namespace maupertuis::app
