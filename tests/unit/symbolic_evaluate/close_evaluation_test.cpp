// Values that keep their digits where terms cancel, and bounds of what rounding does, against 100 digits.
#include <doctest/doctest.h>
#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/rounded_value.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace maupertuis;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("1 - cos θ at a small θ has all its digits, and in double its error is told") {
  Context c;
  const Expr angle = c.symbol("θ", Role::Coordinate), height = c.number(1) - cos(angle);
  const CloseEvaluation evaluation({&height, 1});
  const double θ = 1e-7, right = θ * θ / 2 * (1 - θ * θ / 12);
  const auto value_of = [&](Expr) { return θ; };
  const CloseEvaluation::Values close = evaluation(value_of), rough = evaluation.in_double(value_of);
  CHECK(std::abs(close.values[0] - right) <= 2 * epsilon * right);
  CHECK(close.errors[0] <= epsilon * right);
  CHECK(std::abs(rough.values[0] - right) > 1e-4 * right);
  CHECK(rough.errors[0] >= std::abs(rough.values[0] - right));
  CHECK(rough.errors[0] < 4 * epsilon);
}

TEST_CASE("the bound of rounding covers it, and is no thousand times too large") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
  const Expr tenth = c.number(Rational(1, 10)), two = c.number(2);
  const std::vector<Expr> formulas{
      x + tenth * y - two,
      sin(x + y) - sin(x) * cos(y) - tenth * cos(x),
      apply(Kind::Exp, x) - c.number(1) - x,
      pow(x * x + y * y + tenth, Rational(1, 2)) - x,
      apply(Kind::Log, c.number(1) + x * x) / (x - y),
      pow(x, Rational(5)) - c.pi() * y,
      apply(Kind::Tan, x * c.number(30)),
      apply(Kind::Asin, x / two) - apply(Kind::Atan, y),
      apply(Kind::Erf, x) + apply(Kind::LambertW, y) - tenth,
  };
  const CloseEvaluation evaluation(formulas);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.05, 1.9);
  std::vector<double> largest(formulas.size(), 0);
  for (int trial = 0; trial < 300; ++trial) {
    const double at_x = uniform(random), at_y = uniform(random);
    const auto value_of = [&](Expr s) { return s == x ? at_x : at_y; };
    const CloseEvaluation::Values rough = evaluation.in_double(value_of), close = evaluation(value_of);
    const std::vector<double> right = rounded_values(formulas, value_of);
    for (std::size_t i = 0; i < formulas.size(); ++i) {
      CAPTURE(i);
      const double off = std::abs(rough.values[i] - right[i]);
      CHECK(off <= rough.errors[i] + epsilon * std::abs(right[i]));
      CHECK(std::abs(close.values[i] - right[i]) <= close.errors[i] + epsilon * std::abs(right[i]));
      CHECK(close.errors[i] <= 4 * epsilon * std::abs(close.values[i]));
      largest[i] = std::max(largest[i], off / rough.errors[i]);
    }
  }
  for (const double part : largest) CHECK(part > 1e-3);
}

TEST_CASE("a choice that rounding leaves open has no bound, and is made with 100 digits") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate);
  const Expr third = c.number(Rational(1, 3));
  const Expr larger = apply(Kind::Step, x * third - third);  // at 1 it is 0, but for rounding
  const CloseEvaluation evaluation({&larger, 1});
  const auto at_one = [](Expr) { return 1.0; };
  CHECK(std::isnan(evaluation.in_double(at_one).errors[0]));
  CHECK(evaluation(at_one).values[0] == 1);
}
