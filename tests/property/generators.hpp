#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/functions.hpp>

#include <rapidcheck.h>

#include <array>
#include <ostream>
#include <vector>

/// Random expressions that shrink: a recipe is a list of numbers, each of which makes one more expression out of those
/// made before. RapidCheck shrinks the list; every list is a valid recipe.
namespace maupertuis::property {

struct Recipe {
  std::vector<std::uint32_t> steps;
};

enum class Functions { Polynomial, Smooth, WithSwitches };

/// A function of the table, of an argument inside its domain and, where it grows quickly, of a bounded one.
inline Expr function_of_table(std::size_t row, Expr e) {
  const auto kind = static_cast<Kind>(static_cast<std::size_t>(Kind::Sin) + row);
  const Expr above_two = pow(e, Rational(2)) + Rational(2);
  if (kind == Kind::Acosh || kind == Kind::Log || kind == Kind::LambertW) return apply(kind, above_two);
  if (kind == Kind::Asin || kind == Kind::Acos || kind == Kind::Atanh || kind == Kind::Tan)
    return apply(kind, e / above_two);
  if (kind == Kind::Exp || kind == Kind::Sinh || kind == Kind::Cosh) return apply(kind, sin(e));
  return apply(kind, e);
}

/// One of the kinds that jump or have a kink.
inline Expr switch_of(std::uint32_t choice, Expr a, Expr b) {
  Context& c = a.context();
  const auto of_two = [&](Kind kind, Expr first, Expr second) { return c.function(kind, std::array{first, second}); };
  const auto where = [&](Expr condition) { return c.function(Kind::Piecewise, std::array{condition, a, b * b}); };
  const Expr less = of_two(Kind::Less, a, b);
  switch (choice) {
    case 0:
      return apply(Kind::Abs, a);
    case 1:
      return a * apply(Kind::Sign, b);
    case 2:
      return a * apply(Kind::Step, b);
    case 3:
      return of_two(Kind::Max, a, b);
    case 4:
      return of_two(Kind::Min, a, b);
    case 5:
      return where(less);
    case 6:
      return where(of_two(Kind::And, less, of_two(Kind::LessEqual, b, Rational(2) * a + Rational(1))));
    default:
      return where(of_two(Kind::Or, less, of_two(Kind::LessEqual, b, Rational(3) * a - Rational(1))));
  }
}

inline constexpr std::uint32_t polynomials = 6, composites = 6, switches = 8;
inline constexpr std::uint32_t smooth = polynomials + composites + static_cast<std::uint32_t>(functions::count);

/// Polynomials, composites of several functions, each function of the table, switches: in this order.
inline Expr made_by(std::uint32_t step, const std::vector<Expr>& made, Functions functions) {
  const auto pick = [&](std::uint32_t bits) { return made[bits % made.size()]; };
  const Expr a = pick(step / 64), b = pick(step / 4096);
  Context& c = a.context();
  const Expr positive = pow(b, Rational(2)) + Rational(2);
  const std::uint32_t choices = functions == Functions::Polynomial ? polynomials
                                : functions == Functions::Smooth   ? smooth
                                                                   : smooth + switches;
  const std::uint32_t choice = step % 64 % choices;
  if (choice >= smooth) return switch_of(choice - smooth, a, b);
  if (choice >= polynomials + composites) return function_of_table(choice - polynomials - composites, a);
  switch (choice) {
    case 0:
      return a + b;
    case 1:
      return a - b;
    case 2:
    case 3:
      return a * b;
    case 4:
      return pow(a, Rational(2));
    case 5:
      return Rational(static_cast<int>(step / 4096 % 7) - 3, 1 + static_cast<int>(step / 64 % 4)) * a;
    case 6:
      return sin(a - b);
    case 7:
      return cos(Rational(2) * a + b);
    case 8:
      return a / positive;
    case 9:
      return a * pow(positive, Rational(-3, 2));
    case 10:
      return sin(a + c.pi() * Rational(1, 5)) * sqrt(positive);
    default:
      return c.function(Kind::Atan2, std::array{a, positive});
  }
}

/// The last expression of the recipe, from the leaves; the sum of the leaves for an empty one.
inline Expr build(const Recipe& recipe, const std::vector<Expr>& leaves, Functions functions) {
  std::vector<Expr> made = leaves;
  for (const std::uint32_t step : recipe.steps) made.push_back(made_by(step, made, functions));
  if (recipe.steps.empty()) return leaves.front().context().sum(leaves);
  return made.back();
}

inline void showValue(const Recipe& recipe, std::ostream& out) {
  for (const std::uint32_t step : recipe.steps) out << step << ' ';
}

}  // namespace maupertuis::property

namespace rc {

template <>
struct Arbitrary<maupertuis::property::Recipe> {
  static Gen<maupertuis::property::Recipe> arbitrary() {
    auto steps = gen::resize(
        10, gen::container<std::vector<std::uint32_t>>(gen::resize(100, gen::inRange<std::uint32_t>(0, 1u << 22))));
    return gen::map(std::move(steps),
                    [](std::vector<std::uint32_t> s) { return maupertuis::property::Recipe{std::move(s)}; });
  }
};

/// Runs a property inside a doctest case and reports what falsified it.
template <class Property>
void holds(const std::string& name, Property property) {
  const auto result = rc::detail::checkTestable(property);
  INFO(name);
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  FAIL(name << ": " << text.str());
}

}  // namespace rc
