// One bound for many motions: whatever motion keeps below the sizes that an envelope was asked for, its functions keep
// below the envelope's tail.
#include "disks/envelope.hpp"
#include "followed.hpp"

#include <doctest/doctest.h>
#include "../under_sanitizers.hpp"

#include <string>

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

constexpr double pi = std::numbers::pi;

/// Sizes of the motion that `f` follows, on |s| ≤ r, widened.
struct Sizes {
  std::vector<double> centre, reach, rate, acceleration, least, most;
  double time;

  Sizes(const Followed& f, const Envelope& envelope, double r, double widened) : time(widened * std::abs(f.t0)) {
    for (const std::vector<double>& c : f.c) {
      double sums[3] = {0, 0, 0};
      for (int k = 1; k <= order + 1; ++k)
        for (int d = 0; d < 3; ++d)
          sums[d] += std::abs(c[static_cast<std::size_t>(k)]) * std::pow(r, k - d) *
                     (d == 0   ? 1
                      : d == 1 ? k
                               : k * (k - 1));
      centre.push_back(widened * std::abs(c[0]));
      reach.push_back(widened * sums[0]), rate.push_back(widened * sums[1]), acceleration.push_back(widened * sums[2]);
    }
    for (const Slot slot : envelope.observed()) {
      const double value = f.retrace->row(0)[slot], beside = (widened - 1) * std::abs(value);
      least.push_back(value - beside), most.push_back(value + beside);
    }
  }
  MotionSizes view() const { return {centre, reach, rate, acceleration, least, most, time}; }
  bool cover(const Sizes& other) const {
    bool below = other.time <= time;
    for (std::size_t i = 0; i < 2; ++i)
      below = below && other.centre[i] <= centre[i] && other.reach[i] <= reach[i] && other.rate[i] <= rate[i] &&
              other.acceleration[i] <= acceleration[i];
    for (std::size_t i = 0; i < least.size(); ++i)
      below = below && least[i] <= other.least[i] && other.most[i] <= most[i];
    return below;
  }
};

void draw(Followed& f, const Case& a, std::mt19937& random, double size) {
  std::uniform_real_distribution<double> part(-size, size);
  f.c[0][0] = a.x0 * (1 + 0.15 * part(random)), f.c[1][0] = 0.7 * (1 + 0.15 * part(random));
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 1; k < 4; ++k) f.c[i][k] = 0.4 * part(random);
  f.t0 = 1.3 + 0.1 * part(random);
}

/// d^n/ds^n of what a case is along the motion, by Cauchy's integral.
Complex derivative(const Followed& f, const Case& a, Complex s, int n) {
  if (n == 0) return a.value(f.polynomial(0, s), f.polynomial(1, s), f.t0 + s);
  constexpr int points = 16;
  constexpr double radius = 0.01;
  Complex sum = 0;
  for (int k = 0; k < points; ++k) {
    const Complex z = std::polar(radius, 2 * pi * k / points);
    sum += derivative(f, a, s + z, 0) / std::pow(z, n);
  }
  return sum * (n == 2 ? 2.0 : 1.0) / double(points);
}

/// The n-th derivative of the case in the residual; the tail has to cover how far it is from its centre: nothing in it
/// is a polynomial.
void check(const Case& a, int n, double r, bool may_be_unbounded, int& checked) {
  CAPTURE(std::string(a.name));
  CAPTURE(n);
  CAPTURE(r);
  std::mt19937 random(7);
  Followed f;
  draw(f, a, random, 1);
  Expr value = a.expression(f);
  const Expr plain = value;
  for (int d = 0; d < n; ++d) value = f.context.time_derivative(value);
  f.follow(plain, value);
  const Program& program = f.kernel->program();
  Envelope envelope(program, f.disks->degrees());
  const Sizes sizes(f, envelope, r, 1.2);
  envelope.evaluate(f.constants.data(), sizes.view(), r, order);
  const double tail = envelope.residual_tail(0);
  if (!(tail < infinity)) {
    CHECK(may_be_unbounded);
    return;
  }
  int motions = 0;
  double largest = 0;
  for (int turn = 0; turn < 400 && motions < 20; ++turn) {
    Followed g;
    draw(g, a, random, 0.9);
    Expr same = a.expression(g);
    const Expr observed = same;
    for (int d = 0; d < n; ++d) same = g.context.time_derivative(same);
    g.follow(observed, same);
    if (!sizes.cover(Sizes(g, envelope, r, 1))) continue;
    ++motions;
    const Complex centre = derivative(g, a, 0, n);
    for (int k = 0; k < 32; ++k)
      largest = std::max(largest, std::abs(derivative(g, a, on_circle(r, k, 32), n) - (n == 2 ? 0.0 : centre)));
  }
  if (motions == 0) return;  // what is observed may change by less than these motions do
  ++checked;
  CHECK(tail >= largest * (1 - 1e-6));
  if (n == 0 && r < 0.1) CHECK(tail <= 60 * largest);  // terms may cancel
}

const Case& named(const std::string& name) {
  for (const Case& a : cases())
    if (a.name == name) return a;
  throw std::logic_error("no case " + name);
}

}  // namespace

TEST_CASE("tails of an envelope cover all motions of its sizes, and not absurdly more") {
  for (const Case& a : cases()) {
    if (std::string(a.name) == "sin(5 t) x + t^3") continue;  // partly a polynomial
    int checked = 0;
    const bool has_no_rule = std::string(a.name) == "atan2(y, x)";
    for (const double r : {0.5, 0.2, 0.05}) {
      if (under_sanitizers && r == 0.2) continue;
      check(a, 0, r, r > 0.1 || has_no_rule, checked);
    }
    CHECK((checked > 0 || has_no_rule ||
           std::string(a.name) == "logistic"));  // exp(−300 x) changes by more than an observed value may
  }
}

TEST_CASE("derivatives in the residual: tails of an envelope cover them") {
  int checked = 0;
  for (const char* name : {"x y", "x^2", "x^9", "1/x", "y/(x + 1)", "sqrt(x)", "x^(5/3)", "x^(-3/2)", "sin 3x",
                           "cos 3x", "sinh 2x", "cosh 2x"})
    for (const int n : {1, 2}) check(named(name), n, 0.1, false, checked);
  for (const char* name : {"exp(-4x)", "log x", "tanh x"}) check(named(name), 1, 0.1, false, checked);
  CHECK(checked == 27);
}

TEST_CASE("motions that use up their sizes are covered too") {
  for (const Case& a : cases())
    for (const double slope : {0.5, -0.5})
      for (const int n : {0, 1, 2}) {
        CAPTURE(std::string(a.name));
        CAPTURE(slope);
        CAPTURE(n);
        Followed f;
        f.c[0][0] = a.x0, f.c[0][1] = slope, f.c[1][0] = 0.7, f.c[1][1] = 0.5, f.t0 = 0;
        const Expr plain = a.expression(f);
        Expr value = plain;
        for (int d = 0; d < n; ++d) value = f.context.time_derivative(value);
        f.follow(plain, value);
        Envelope envelope(f.kernel->program(), f.disks->degrees());
        const double r = 0.3;
        const Sizes sizes(f, envelope, r, 1);
        envelope.evaluate(f.constants.data(), sizes.view(), r, order);
        const double tail = envelope.residual_tail(0);
        if (!(tail < infinity) || std::string(a.name) == "sin(5 t) x + t^3") continue;
        const Complex centre = n == 0 ? derivative(f, a, 0, 0) : 0.0;
        double largest = 0;
        for (int k = 0; k < 64; ++k)
          largest = std::max(largest, std::abs(derivative(f, a, std::polar(r, 2 * pi * k / 64), n) - centre));
        CHECK(tail >= largest * (1 - 1e-6) - 1e-11);  // rounding of the derivatives
      }
}

TEST_CASE("what an envelope has no rule for is unbounded, what is a polynomial costs nothing") {
  Followed f;
  f.c[0][0] = 0.6, f.c[0][1] = 0.3, f.c[1][0] = 0.7;
  const auto tail = [&](const Expr& e) {
    f.follow(e);
    Envelope envelope(f.kernel->program(), f.disks->degrees());
    const Sizes sizes(f, envelope, 0.1, 1.1);
    envelope.evaluate(f.constants.data(), sizes.view(), 0.1, order);
    return envelope.residual_tail(0);
  };
  const Expr both[] = {f.y, f.x};
  CHECK(!(tail(f.context.function(Kind::Atan2, both)) < infinity));
  CHECK(!(tail(f.context.time_derivative(f.context.time_derivative(apply(Kind::Tanh, f.x)))) < infinity));
  CHECK(tail(f.x * Rational(3) + f.y + f.t * f.t) == 0);
  CHECK(tail(f.x * f.y) > 0);
}

TEST_CASE("angles that stand in sines alone may be as large as they are") {
  Followed f;
  f.c[0][0] = 0.6, f.c[1][0] = 0.7;
  f.follow(sin(f.x * Rational(3)) + f.y * f.y);
  const Envelope envelope(f.kernel->program(), f.disks->degrees());
  CHECK(!envelope.needs_centre(0));
  CHECK(envelope.needs_centre(1));
}
