#include "numeric.hpp"
#include "systems.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace maupertuis;
using test::agree;

namespace {

/// Random expressions over three coordinates, their velocities, time and three parameters.
class Grower {
 public:
  Grower(Context& context, const std::vector<int>& choices) : context_(context), choices_(choices) {}

  Expr angle() {
    std::vector<Expr> terms;
    for (const char* name : {"θ", "φ", "ψ"})
      terms.push_back(Rational(pick(5) - 2) * context_.symbol(name, Role::Coordinate));
    if (pick(4) == 0) terms.push_back(context_.symbol("ω", Role::Parameter) * context_.time());
    if (pick(6) == 0) terms.push_back(Rational(pick(7), 4) * context_.pi());
    return context_.sum(terms);
  }

  Expr trigonometric(int depth) {
    if (depth == 0 || pick(4) == 0) {
      switch (pick(5)) {
        case 0:
          return context_.number(Rational(pick(7) - 3, 1 + pick(3)));
        case 1:
          return context_.symbol(pick(2) ? "a" : "b", Role::Parameter);
        case 2:
          return context_.symbol("x", Role::Coordinate, pick(3));
        case 3:
          return sin(angle());
        default:
          return cos(angle());
      }
    }
    switch (pick(3)) {
      case 0:
        return trigonometric(depth - 1) + trigonometric(depth - 1);
      case 1:
        return trigonometric(depth - 1) * trigonometric(depth - 1);
      default:
        return pow(trigonometric(depth - 1), Rational(2));
    }
  }

  Expr any(int depth) {
    if (depth == 0) return trigonometric(1);
    const Expr x = any(depth - 1);
    switch (pick(10)) {
      case 0:
        return x + any(depth - 1);
      case 1:
        return x * any(depth - 1);
      case 2:
        return pow(pow(x, Rational(2)) + any(0) * any(0) + Rational(3), Rational(pick(5) - 3, 2));
      case 3:
        return pow(x + context_.symbol("b", Role::Parameter), Rational(-1 - pick(2)));
      case 4:
        return apply(Kind::Exp, sin(flat(x)) + trigonometric(1) / Rational(4));
      case 5:
        return apply(Kind::Tan, angle()) * x;
      case 6:
        return pow(cos(angle()), Rational(-1 - pick(2))) * x;
      case 7:
        return context_.power(context_.symbol("r", Role::Coordinate),
                              context_.symbol("s", Role::Parameter) - Rational(pick(3))) *
               x;
      case 8:
        return apply(pick(2) ? Kind::Abs : Kind::Sign, x) + trigonometric(1);
      default:
        return sin(flat(x)) * trigonometric(1);
    }
  }

 private:
  static Expr flat(Expr x) {
    const Expr expanded = expand(x);
    return expanded ? expanded : x;
  }
  int pick(int n) { return choices_.empty() ? 0 : choices_[next_++ % choices_.size()] % n; }

  Context& context_;
  const std::vector<int>& choices_;
  std::size_t next_ = 0;
};

std::vector<int> choices() { return *rc::gen::container<std::vector<int>>(60, rc::gen::inRange(0, 5040)); }

ReadingOrder order_of(Context& c) {
  ReadingOrder order;
  for (const char* p : {"a", "b", "ω", "s"}) order.parameters.push_back(c.symbol(p, Role::Parameter));
  for (const char* q : {"θ", "φ", "ψ", "x", "r"}) order.coordinates.push_back(c.symbol(q, Role::Coordinate));
  return order;
}

}  // namespace

TEST_CASE("the readable form equals what it was made from") {
  CHECK(rc::check([] {
    Context c;
    const auto random = choices();
    const Expr e = Grower(c, random).any(3);
    const ReadingOrder order = order_of(c);
    const Expr r = readable(e, order).value;
    for (unsigned seed = 1; seed <= 3; ++seed)
      if (!agree(e, r, seed)) RC_FAIL(to_plain(e, order) + "   became   " + to_plain(r, order));
  }));
}

TEST_CASE("a readable equation equals its residual") {
  CHECK(rc::check([] {
    Context c;
    const auto random = choices();
    const Expr e = c.time_derivative(Grower(c, random).trigonometric(3)) + Grower(c, random).trigonometric(2);
    const ReadingOrder order = order_of(c);
    const Expr r = readable_equations({&e, 1}, order).front().value;
    const Expr carried_out = expand_time_derivatives(e);
    for (unsigned seed = 1; seed <= 3; ++seed) RC_ASSERT(agree(carried_out, r, seed));
  }));
}

TEST_CASE("expand and the Fourier form keep the value") {
  CHECK(rc::check([] {
    Context c;
    const auto random = choices();
    const Expr e = Grower(c, random).any(2);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      if (const Expr expanded = expand(e)) RC_ASSERT(agree(e, expanded, seed));
      if (const Expr harmonics = fourier_form(e)) RC_ASSERT(agree(e, harmonics, seed));
    }
  }));
}

TEST_CASE("the Fourier form is canonical") {
  // Rewriting by the addition theorems changes the tree, not the form.
  CHECK(rc::check([] {
    Context c;
    const auto random = choices();
    Grower grow(c, random);
    const Expr f = grow.trigonometric(3), a = grow.angle(), b = grow.angle();
    const Expr left = f * cos(expand(a + b)) + pow(sin(a), Rational(2)) * f;
    const Expr right = f * (cos(a) * cos(b) - sin(a) * sin(b)) + f - f * pow(cos(a), Rational(2));
    RC_ASSERT(fourier_form(left) == fourier_form(right));
    RC_ASSERT(fourier_form(left - right).is_zero());
    RC_ASSERT(fourier_form(fourier_form(left)) == fourier_form(left));
  }));
}

TEST_CASE("the Fourier form tells apart") {
  Context c;
  const Expr a = c.symbol("θ", Role::Coordinate), b = c.symbol("φ", Role::Coordinate);
  CHECK(fourier_form(sin(a) * cos(b)) != fourier_form(cos(a) * sin(b)));
  CHECK(fourier_form(cos(a - b)) == fourier_form(cos(b - a)));
  CHECK(fourier_form(cos(a / Rational(2)) * cos(a / Rational(2))) ==
        fourier_form((cos(a) + Rational(1)) / Rational(2)));
  CHECK(fourier_form(sin(a + c.pi() / Rational(2))) == cos(a));
  CHECK(!fourier_form(pow(cos(a) + cos(b), Rational(60)), 50));
}
