// How near to 0 distances come on a disk: bounds must hold for what the functions do there in complex numbers, and must
// be near enough to it that bodies which head at each other are told from bodies that have met.
#include "../under_sanitizers.hpp"
#include "followed.hpp"
#include "disks/least_modulus.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;
using namespace maupertuis::test;
using maupertuis::disk_rules::least_modulus;

namespace {

/// (x² + y²)^(−3/2)
Expr inverse_cube(Followed& f) { return pow(pow(f.x, 2) + pow(f.y, 2), Rational(-3, 2)); }

/// The largest |w^(−3/2) − w₀^(−3/2)| on |s| = r, where no root of w lies within.
double farthest(const Followed& f, double r) {
  const auto w = [&](Complex s) { return std::pow(f.polynomial(0, s), 2) + std::pow(f.polynomial(1, s), 2); };
  double most = 0;
  Complex root = std::sqrt(w(0)), at_centre = std::pow(root, -3);
  // From the centre outward along each ray, on the branch that is continuous.
  for (int k = 0; k < 128; ++k) {
    Complex branch = std::sqrt(w(0));
    for (int part = 1; part <= 40; ++part) {
      const Complex next = std::sqrt(w(on_circle(r * part / 40, k, 128)));
      branch = std::abs(next - branch) <= std::abs(next + branch) ? next : -next;
    }
    most = std::max(most, std::abs(std::pow(branch, -3) - at_centre));
  }
  return most;
}

}  // namespace

TEST_CASE("the least modulus of a quadratic function on a disk is bounded from below, up to its nearest root") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-2, 2);
  for (int draw = 0; draw < 2000; ++draw) {
    const double a = part(random), b = draw % 7 == 0 ? 0 : part(random), c = draw % 5 == 0 ? 0 : part(random),
                 r = std::abs(part(random));
    double least = std::abs(a);
    for (int k = 0; k < 64; ++k)
      for (const double inner : {0.25, 0.5, 0.75, 1.0}) {
        const Complex s = on_circle(inner * r, k, 64);
        least = std::min(least, std::abs(a + b * s + c * s * s));
      }
    const double bound = least_modulus(a, b, c, r);
    CAPTURE(a);
    CAPTURE(b);
    CAPTURE(c);
    CAPTURE(r);
    CHECK(bound >= 0);
    CHECK(bound <= least * (1 + 1e-12) + 1e-15);
    CHECK(bound >= std::abs(a) - std::abs(b) * r - std::abs(c) * r * r - 1e-12);
  }
  for (const double r : {0.1, 1.0, 1.9, 1.999})  // (2 − s)²
    CHECK(least_modulus(4, -4, 1, r) == doctest::Approx((2 - r) * (2 - r)));
  CHECK(least_modulus(4, -4, 1, 2.001) == 0);
  CHECK(least_modulus(0, 0, 0, 1.0) == 0);
  CHECK(least_modulus(3, 0, 0, 1e6) == 3);
}

TEST_CASE("a body that comes straight on is told from one that has arrived, almost up to its arrival") {
  Followed f;
  f.c[0][0] = 3, f.c[0][1] = -2, f.c[1][0] = 4e-3;  // passes the origin at s = 1.5, by 0.004
  f.follow(inverse_cube(f));
  for (const double part : {0.3, 0.6, 0.9, 0.98}) {
    CAPTURE(part);
    f.disks->begin({f.retrace->row(0), f.retrace->stride(), order});
    f.disks->evaluate(part * 1.5, Disks::Depth::Rules);
    CHECK(f.disks->tail(f.slot) < infinity);
    CHECK(f.disks->reach(f.slot) >= farthest(f, part * 1.5));
  }
  f.disks->begin({f.retrace->row(0), f.retrace->stride(), order});
  f.disks->evaluate(1.01 * 1.5, Disks::Depth::Rules);
  CHECK(f.disks->tail(f.slot) == infinity);
}

TEST_CASE("distances are bounded on a disk whatever the orders of their coordinates") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1, 1);
  int finite = 0;
  const int draws = under_sanitizers ? 30 : 300;
  for (int draw = 0; draw < draws; ++draw) {
    Followed f;
    f.c[0][0] = 1 + 0.2 * part(random), f.c[1][0] = 0.3 * part(random);
    // A few terms of any order: some products of them are beyond what the rows hold.
    for (std::size_t i = 0; i < 2; ++i)
      for (int terms = 0; terms < 3; ++terms)
        f.c[i][1 + random() % static_cast<unsigned>(order + 1)] = 0.25 * part(random);
    f.follow(inverse_cube(f));
    for (const double r : {1.0, 0.7}) {
      f.disks->begin({f.retrace->row(0), f.retrace->stride(), order});
      f.disks->evaluate(r, Disks::Depth::Rules);
      if (!(f.disks->tail(f.slot) < infinity)) continue;
      ++finite;
      CAPTURE(draw);
      CAPTURE(r);
      CHECK(f.disks->reach(f.slot) >= farthest(f, r) * (1 - 1e-9));
    }
  }
  CHECK(finite > draws);
}

TEST_CASE("what the rows leave out of a distance counts") {
  Followed f;
  f.c[0][0] = 1, f.c[1][15] = 0.6;  // w = 1 + 0.36 s³⁰, of which the rows hold 1
  f.follow(inverse_cube(f));
  f.disks->evaluate(1, Disks::Depth::Rules);
  CHECK(f.disks->reach(f.slot) >= farthest(f, 1));
  CHECK(farthest(f, 1) > 0.9);
}

TEST_CASE("what the rows leave out of a product counts, whichever of its factors is of high order") {
  for (const std::size_t high : {std::size_t{0}, std::size_t{1}}) {
    CAPTURE(high);
    Followed f;
    f.c[high][20] = 0.9, f.c[1 - high][5] = 0.9;
    f.follow(pow(f.x * f.y + Rational(1), Rational(-3, 2)));  // w = 1 + 0.81 s²⁵, of which the rows hold 1
    f.disks->evaluate(1, Disks::Depth::Rules);
    CHECK(f.disks->reach(f.slot) >= std::pow(0.19, -1.5) - 1);
  }
}
