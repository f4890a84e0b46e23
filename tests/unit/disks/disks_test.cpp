// Bounds on disks against the functions themselves, in complex numbers on the circle: each rule must cover what a value
// does there, must not be absurdly wide, and must say ∞ where the disk reaches a singularity.
#include "followed.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;
using namespace maupertuis::test;

TEST_CASE("reach covers what a value does on the disk, and not absurdly more") {
  for (const Case& a : cases())
    for (unsigned seed = 0; seed < 6; ++seed) {
      CAPTURE(std::string(a.name));
      CAPTURE(seed);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> part(-0.3, 0.3);
      Followed f;
      f.c[0][0] = a.x0, f.c[1][0] = 0.7;
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 1; k < 4; ++k) f.c[i][k] = part(random);
      f.t0 = 1.3;
      f.follow(a.expression(f));
      const Complex at_centre = a.value(f.polynomial(0, 0), f.polynomial(1, 0), f.t0);
      for (const double r : {0.9, 0.6, 0.4, 0.2, 0.1, 0.02}) {
        CAPTURE(r);
        f.disks->evaluate(r);
        double largest = 0;
        for (int k = 0; k < 64; ++k) {
          const Complex s = on_circle(r, k, 64);
          largest = std::max(largest, std::abs(a.value(f.polynomial(0, s), f.polynomial(1, s), f.t0 + s) - at_centre));
        }
        CHECK(f.disks->reach(f.slot) >= largest * (1 - 1e-9));
        CHECK(f.disks->tail(f.slot) >= 0);
        if (r <= 0.02) CHECK(f.disks->reach(f.slot) <= 32 * largest + 1e-12);  // terms may cancel
      }
    }
}

TEST_CASE("tails cover what the polynomial leaves out") {
  for (const Case& a : cases()) {
    CAPTURE(std::string(a.name));
    Followed f;
    f.c[0] = std::vector<double>(order + 2, 0.0), f.c[1] = f.c[0];
    f.c[0][0] = a.x0, f.c[0][1] = 0.5, f.c[0][2] = -0.2, f.c[1][0] = 0.7, f.c[1][1] = -0.4;
    f.t0 = 0.4;
    f.follow(a.expression(f));
    int finite = 0;
    for (const double r : {0.9, 0.6, 0.4, 0.2}) {
      f.disks->evaluate(r);
      const double tail = f.disks->tail(f.slot);
      if (!(tail < infinity)) continue;
      ++finite;
      for (const double x : {0.45, -0.45, 0.3}) {
        const double s = x * r;
        const double exact = a.value(f.polynomial(0, s), f.polynomial(1, s), f.t0 + s).real();
        double by_series = 0;
        for (int k = order + 1; k >= 0; --k) by_series = by_series * s + f.retrace->row(k)[f.slot];
        CHECK(std::abs(exact - by_series) <=
              tail * std::pow(std::abs(x), order + 2) / (1 - std::abs(x)) + 1e-14 * (1 + std::abs(exact)));
      }
    }
    CHECK(finite > 0);
  }
}

TEST_CASE("a disk that reaches a singularity bounds nothing") {
  for (const Case& a : cases()) {
    if (!(a.singular < infinity)) continue;
    CAPTURE(std::string(a.name));
    Followed f;
    f.c[0][0] = a.x0, f.c[0][1] = 1, f.c[1][0] = 0.7;
    f.follow(a.expression(f));
    f.disks->evaluate(1.01 * a.singular);
    CHECK(f.disks->tail(f.slot) == infinity);
  }
}

TEST_CASE("what is far from its layer costs nothing, and wakes up when the disk comes near") {
  Followed f;  // a pulse at t = 6, 0.05 wide, seen from t = 0
  const Expr pulse = apply(Kind::Exp, pow((f.t - Rational(6)) * Rational(20), 2) * Rational(-1));
  f.follow(pulse);
  f.disks->evaluate(2);
  CHECK(f.disks->tail(f.slot) < 1e-300);
  Followed g;
  g.follow(apply(Kind::Exp, pow((g.t - Rational(6)) * Rational(20), 2) * Rational(-1)));
  g.disks->evaluate(6.5);
  CHECK(g.disks->tail(g.slot) > 1);
  g.disks->evaluate(2);
  CHECK(g.disks->tail(g.slot) < 1e-300);
}

TEST_CASE("polynomials in t of degrees that the step keeps have no tail, of higher ones they have") {
  for (const int degree : {1, 3, 16, 32}) {
    Followed f;
    f.t0 = 0.5;
    Expr power = f.t;
    for (int d = 1; d < degree; d *= 2) power = d == 1 && degree == 3 ? power * f.t * f.t : power * power;
    f.follow(degree == 1 ? f.t : power);
    f.disks->evaluate(1);
    CAPTURE(degree);
    CHECK((f.disks->tail(f.slot) == 0) == (degree < order));
  }
}

TEST_CASE("derivatives of functions are bounded with a larger disk, and not without one") {
  Followed f;
  f.c[0][0] = 0.4, f.c[0][1] = 0.5, f.c[0][2] = -0.2, f.c[0][3] = 0.1;
  f.follow(f.context.time_derivative(sin(f.x * Rational(3))));
  REQUIRE(f.disks->needs_larger_disk());
  const auto value = [&](Complex s) {
    const Complex x = f.polynomial(0, s), v = 0.5 + s * (-0.4 + s * 0.3);
    return 3.0 * std::cos(3.0 * x) * v;
  };
  const SlotCoefficients rows{f.retrace->row(0), f.retrace->stride(), order};
  for (const double r : {0.6, 0.3, 0.1}) {
    CAPTURE(r);
    f.disks->begin(rows);
    f.disks->evaluate(r, Disks::Depth::Rules);
    CHECK(f.disks->reach(f.slot) == infinity);
    f.disks->begin(rows);
    f.disks->evaluate(1.4 * r, Disks::Depth::Derivatives);
    f.disks->evaluate(r, Disks::Depth::Rules);
    double largest = 0;
    for (int k = 0; k < 64; ++k) largest = std::max(largest, std::abs(value(on_circle(r, k, 64)) - value(0)));
    CHECK(f.disks->reach(f.slot) >= largest);
    CHECK(f.disks->reach(f.slot) < 100 * largest + 1);
    for (const double x : {0.45, -0.45}) {
      double by_series = 0;
      for (int k = order; k >= 0; --k) by_series = by_series * x * r + f.retrace->row(k)[f.slot];
      CHECK(std::abs(value(x * r) - by_series) <=
            f.disks->tail(f.slot) * std::pow(std::abs(x), order + 1) / (1 - std::abs(x)) + 1e-13 * std::abs(value(0)));
    }
  }
}
