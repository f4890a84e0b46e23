// Switches: which there are, points in their branches, and what jumps at them.
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>

using namespace maupertuis;

namespace {

struct Fixture {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate), t = context.symbol("t", Role::Time);

  Expr number(const Rational& r) { return context.number(r); }
  Expr less(Expr a, Expr b) { return context.function(Kind::Less, std::array{a, b}); }
  Expr piecewise(Expr condition, Expr yes, Expr no) { return context.function(Kind::Piecewise, std::array{condition, yes, no}); }
  Expr max(Expr a, Expr b) { return context.function(Kind::Max, std::array{a, b}); }
  Expr step(Expr a) { return apply(Kind::Step, a); }
  Expr abs(Expr a) { return apply(Kind::Abs, a); }

  SwitchSearch search() const { return {{x, y, t}, {{x, 0.7}, {y, 0.3}, {t, 0}}}; }
  /// The largest jump of the first function over all switches; how many samples there were.
  std::pair<double, std::size_t> largest_jump(Expr f) const {
    const std::vector<Expr> switches = switches_of({&f, 1});
    const auto samples = sample_switches({&f, 1}, switches, search());
    double largest = 0;
    for (const SwitchSample& s : samples) largest = std::max(largest, std::abs(s.jump[0]));
    return {largest, samples.size()};
  }
};

}  // namespace

TEST_CASE_FIXTURE(Fixture, "each switch is listed once, whatever its sign and however often it stands there") {
  const std::array roots{abs(x - y) + step(y - x) + max(x, y), piecewise(less(x, y), x, y), apply(Kind::Sign, t), sin(x)};
  CHECK(switches_of(roots).size() == 2);  // x − y and t
}

TEST_CASE_FIXTURE(Fixture, "jumps are told from kinks and from pieces that meet") {
  const Expr third = number(Rational(1, 3));
  for (const Expr& continuous :
       {abs(x), sqrt(abs(x)), pow(max(x, number(0)), Rational(3, 2)), pow(abs(x), Rational(1, 5)), x * apply(Kind::Sign, x),
        abs(abs(x) - third), piecewise(less(x, third), pow(x, Rational(2)), third * x), max(sin(x), cos(y)),
        (x - third) * step(x - third) * y, apply(Kind::Exp, -pow(abs(x), Rational(-1)))}) {
    const auto [jump, samples] = largest_jump(continuous);
    CHECK(samples > 0);
    CHECK(jump == 0);
  }
  CHECK(largest_jump(step(x)).first == 1);
  CHECK(largest_jump(apply(Kind::Sign, x - y)).first == 2);
  CHECK(largest_jump(Rational(2, 5) * step(x - third)).first == doctest::Approx(0.4).epsilon(1e-15));
  // By 1e-12 only, where everything is of order one.
  CHECK(largest_jump(piecewise(less(x, third), x, x + Rational(1, 1000000000000))).first == doctest::Approx(1e-12).epsilon(1e-9));
  // The difference of two kinks.
  CHECK(largest_jump(abs(x) * pow(x, Rational(-1))).first == 2);
}

TEST_CASE_FIXTURE(Fixture, "a jump in a corner that no random point meets") {
  // Behind two other switches, in a gate of width 0.2 and in one of 1e-4 at 3.
  CHECK(largest_jump(step(x - Rational(50)) * step(y - Rational(70))).first == 1);
  const Expr gate = apply(Kind::Exp, Rational(-100) * pow(x - Rational(3), Rational(2))) - Rational(1, 2);
  CHECK(largest_jump(step(gate)).first == 1);
  const Expr narrow = apply(Kind::Exp, Rational(-100000000) * pow(x - Rational(3), Rational(2))) - Rational(1, 2);
  CHECK(largest_jump(step(narrow)).first == 1);
  CHECK(largest_jump(step(pow(x, Rational(2)) + Rational(1))).second == 0);  // no root: no sample
}

TEST_CASE_FIXTURE(Fixture, "samples lie on their switch, below and above are its sides") {
  const Expr g = pow(x, Rational(2)) + pow(y, Rational(2)) - Rational(4), f = piecewise(less(g, number(0)), number(5), number(7));
  const std::vector<Expr> switches = switches_of({&f, 1});
  REQUIRE(switches.size() == 1);
  const auto samples = sample_switches({&f, 1}, switches, search());
  REQUIRE(samples.size() > 8);
  for (const SwitchSample& s : samples) {
    CHECK(std::abs(evaluate(g, s.at)) <= 1e-12 * (1 + std::pow(s.at.at(x), 2) + std::pow(s.at.at(y), 2)));
    const bool rises = switches[0] == g;  // the comparison is g < 0: its difference is −g
    CHECK(s.below[0] == (rises ? 5 : 7));
    CHECK(s.jump[0] == (rises ? 2 : -2));
  }
}

TEST_CASE_FIXTURE(Fixture, "a side that is undefined or unbounded has no jump to speak of") {
  const Expr f = abs(x) + apply(Kind::Log, x);
  const std::vector<Expr> switches = switches_of({&f, 1});
  for (const SwitchSample& s : sample_switches({&f, 1}, switches, search())) CHECK(std::isnan(s.jump[0]));
  const Expr wall = step(x) * pow(x, Rational(-1));
  for (const SwitchSample& s : sample_switches({&wall, 1}, switches_of({&wall, 1}), search())) CHECK(std::isnan(s.jump[0]));
}

TEST_CASE_FIXTURE(Fixture, "all branches of nested switches are found, and what excludes itself is counted") {
  const std::array switches{x - Rational(50), y - Rational(70), x + y - Rational(1000), sin(Rational(50) * t)};
  const BranchPoints found = points_in_branches(switches, search());
  std::set<int> patterns;
  for (const Bindings& p : found.points) {
    int pattern = 0;
    for (const Expr& g : switches) pattern = 2 * pattern + (evaluate(g, p) > 0);
    patterns.insert(pattern);
  }
  CHECK(found.combinations == 16);
  CHECK(patterns.size() == 14);  // x < 50 and y < 70 is not beyond x + y = 1000
  CHECK(found.missing == 2);
}

TEST_CASE_FIXTURE(Fixture, "narrow bands between two constants are found, in several coordinates at once") {
  const std::array switches{x - Rational(1000), x - Rational(1001), y - Rational(2000), y - Rational(2001), t - Rational(7000), t - Rational(7001)};
  const BranchPoints found = points_in_branches(switches, search());
  CHECK(found.combinations == 64);
  CHECK(found.missing == 64 - 27);  // below, in and above each band
}

TEST_CASE_FIXTURE(Fixture, "the formula on one side of a switch") {
  const Expr f = abs(x) + max(x, y) + piecewise(less(x, number(0)), y, step(x) * number(3));
  const Expr above = on_side({&f, 1}, x, true)[0], below = on_side({&f, 1}, x, false)[0];
  const Bindings right{{x, 2}, {y, 0.5}, {t, 0}}, left{{x, -2}, {y, 0.5}, {t, 0}};
  CHECK(evaluate(above, right) == evaluate(f, right));
  CHECK(evaluate(below, left) == evaluate(f, left));
  CHECK(evaluate(above, left) == -2 + 0.5 + 3);  // the right formula at a point on the left
  CHECK(switches_of({&above, 1}).size() == 1);   // x − y is left
}
