#pragma once
#include <maupertuis/expression.hpp>

#include <string>
#include <string_view>

/// A quantity as the rate of its integral over time: symbol(integral_name("p_θ"), Role::Coordinate, 1) is p_θ, order 2
/// is p_θ'. Every pass takes it for a velocity, as a momentum in place of a velocity should be taken; printers show the
/// quantity.
namespace maupertuis {

inline constexpr std::string_view integral_sign = "∫";

inline std::string integral_name(std::string_view quantity) {
  return std::string(integral_sign) + std::string(quantity);
}
inline bool is_integral(std::string_view name) { return name.substr(0, integral_sign.size()) == integral_sign; }

/// The quantity itself, as an expression of `context`.
inline Expr rate_of_integral(Context& context, std::string_view quantity) {
  return context.symbol(integral_name(quantity), Role::Coordinate, 1);
}

}  // namespace maupertuis
