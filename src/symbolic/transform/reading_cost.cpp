#include "symbolic/transform/reading_cost.hpp"

#include <maupertuis/decimal_places.hpp>

#include <algorithm>

namespace maupertuis::terms {
namespace {

constexpr double name = 1, lone_number = 0.7, whole_factor = 0.4, fraction_factor = 0.6;
constexpr double plus = 0.9, brackets = 1.3, light_brackets = 0.8;
constexpr double exponent = 0.4, root = 0.8, other_exponent = 1, below_the_bar = 0.2;
constexpr double function_of_name = 1.5, function = 1.1, angle = 0.9, multiple_of_angle = 1.6, name_in_angle = 0.5;

/// What a long number costs beyond a short one.
double length_cost(const Rational& value) {
  constexpr std::size_t at_a_glance = 4;
  constexpr double digit = 0.12;
  const std::size_t digits = digits_of(value);
  return digits > at_a_glance ? digit * static_cast<double>(digits - at_a_glance) : 0;
}

double coefficient_cost(const Rational& value) {
  if (abs(value).is_one()) return 0;
  return (value.is_integer() ? whole_factor : fraction_factor) + length_cost(value);
}

/// (m1 + m2) and (r - l0) are taken in at a glance; brackets around products make the eye go back.
double brackets_around(Expr sum) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const Expr rest = split_coefficient(sum[i]).rest;
    if (!rest.is_symbol() && !rest.is_one()) return brackets;
  }
  return light_brackets;
}

}  // namespace

std::size_t digits_of(const Rational& value) {
  const Rational size = abs(value);
  if (size.is_integer()) return size.numerator_string().size();
  if (const auto places = decimal_places(size)) {
    const Rational shifted = size * pow(Rational(10), *places);
    return std::max(shifted.numerator_string().size(), static_cast<std::size_t>(*places) + 1);
  }
  return size.numerator_string().size() + size.denominator_string().size();
}

double ReadingCost::operator()(Expr e) {
  if (const auto known = known_.find(e.id()); known != known_.end()) return known->second;
  const double value = compute(e);
  known_.emplace(e.id(), value);
  return value;
}

double ReadingCost::compute(Expr e) {
  if (e.is_number()) return lone_number + length_cost(e.number());
  if (e.is(Kind::Power)) return of_power(e);
  if (e.is(Kind::Product)) return of_product(e);
  if (e.is(Kind::Sin) || e.is(Kind::Cos) || e.is(Kind::Tan)) return of_circular(e);
  // Names, the signs of a sum, the name of a function: and what stands below.
  double total = e.is(Kind::Sum) ? plus * static_cast<double>(e.size() - 1) : name;
  for (std::size_t i = 0; i < e.size(); ++i) total += (*this)(e[i]);
  return total;
}

double ReadingCost::of_power(Expr e) {
  double total = (*this)(e[0]);
  const Rational* value = e[1].number_or_null();
  if (!value) return total + (*this)(e[1]);
  const Rational size = abs(*value);
  if (value->sign() < 0) total += below_the_bar;
  if (size.is_one()) return total;
  const bool is_root = size == Rational(1, 2);
  if (!is_root && (e[0].is(Kind::Sum) || e[0].is(Kind::Product))) total += brackets;
  return total + (is_root ? root : size.is_integer() ? exponent : other_exponent);
}

double ReadingCost::of_product(Expr e) {
  double total = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (e[i].is_number())
      total += coefficient_cost(e[i].number());
    else
      total += (*this)(e[i]) + (e[i].is(Kind::Sum) ? brackets_around(e[i]) : 0);
  }
  return total;
}

double ReadingCost::of_circular(Expr e) {
  const Expr argument = e[0];
  if (argument.is_symbol()) return function_of_name;
  const auto cost_of_term = [](Expr term) {
    const ScaledTerm scaled = split_coefficient(term);
    double cost = angle + (abs(scaled.coefficient).is_one() ? 0 : multiple_of_angle);
    if (scaled.rest.is(Kind::Product)) cost += name_in_angle * static_cast<double>(scaled.rest.size() - 1);
    return cost;
  };
  if (!argument.is(Kind::Sum)) return function + cost_of_term(argument);
  double total = function;
  for (std::size_t i = 0; i < argument.size(); ++i) total += cost_of_term(argument[i]);
  return total;
}

}  // namespace maupertuis::terms
