#pragma once
#include <maupertuis/expression.hpp>

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

inline Expr made_by(std::uint32_t step, const std::vector<Expr>& made, Functions functions) {
  const auto pick = [&](std::uint32_t bits) { return made[bits % made.size()]; };
  const Expr a = pick(step / 32), b = pick(step / 4096);
  Context& c = a.context();
  const auto of_two = [&](Kind kind) { return c.function(kind, std::array{a, b}); };
  const Expr positive = pow(b, Rational(2)) + Rational(2);
  const std::uint32_t choices = functions == Functions::Polynomial ? 6 : functions == Functions::Smooth ? 20 : 25;
  switch (step % 32 % choices) {
    case 0: return a + b;
    case 1: return a - b;
    case 2: case 3: return a * b;
    case 4: return pow(a, Rational(2));
    case 5: return Rational(static_cast<int>(step / 4096 % 7) - 3, 1 + static_cast<int>(step / 32 % 4)) * a;
    case 6: return sin(a);
    case 7: return cos(a);
    case 8: return sin(a - b);
    case 9: return cos(Rational(2) * a + b);
    case 10: return a / positive;
    case 11: return sqrt(positive);
    case 12: return a * pow(positive, Rational(-3, 2));
    case 13: return apply(Kind::Atan, a);
    case 14: return apply(Kind::Log, positive);
    case 15: return apply(Kind::Tanh, a);
    case 16: return apply(Kind::Exp, sin(a));
    case 17: return c.function(Kind::Atan2, std::array{a, positive});
    case 18: return apply(Kind::Erf, a);
    case 19: return apply(Kind::LambertW, positive);
    case 20: return apply(Kind::Abs, a);
    case 21: return of_two(Kind::Max);
    case 22: return of_two(Kind::Min);
    case 23: return a * apply(Kind::Sign, b);
    default: return c.function(Kind::Piecewise, std::array{c.function(Kind::Less, std::array{a, b}), a, b * b});
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
    auto steps = gen::resize(10, gen::container<std::vector<std::uint32_t>>(gen::resize(100, gen::inRange<std::uint32_t>(0, 1u << 22))));
    return gen::map(std::move(steps), [](std::vector<std::uint32_t> s) { return maupertuis::property::Recipe{std::move(s)}; });
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
