// Switches: which there are, points in their branches, and what jumps at them.
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace maupertuis;

namespace {

struct Fixture {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate),
       t = context.symbol("t", Role::Time);

  Expr number(const Rational& r) { return context.number(r); }
  Expr less(Expr a, Expr b) { return context.function(Kind::Less, std::array{a, b}); }
  Expr piecewise(Expr condition, Expr yes, Expr no) {
    return context.function(Kind::Piecewise, std::array{condition, yes, no});
  }
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
  const std::array roots{abs(x - y) + step(y - x) + max(x, y), piecewise(less(x, y), x, y), apply(Kind::Sign, t),
                         sin(x)};
  CHECK(switches_of(roots).size() == 2);  // x − y and t
}

TEST_CASE_FIXTURE(Fixture, "jumps are told from kinks and from pieces that meet") {
  const Expr third = number(Rational(1, 3));
  for (const Expr& continuous :
       {abs(x), sqrt(abs(x)), pow(max(x, number(0)), Rational(3, 2)), pow(abs(x), Rational(1, 5)),
        x * apply(Kind::Sign, x), abs(abs(x) - third), piecewise(less(x, third), pow(x, Rational(2)), third * x),
        max(sin(x), cos(y)), (x - third) * step(x - third) * y, apply(Kind::Exp, -pow(abs(x), Rational(-1)))}) {
    const auto [jump, samples] = largest_jump(continuous);
    CHECK(samples > 0);
    CHECK(jump == 0);
  }
  CHECK(largest_jump(step(x)).first == 1);
  CHECK(largest_jump(apply(Kind::Sign, x - y)).first == 2);
  CHECK(largest_jump(Rational(2, 5) * step(x - third)).first == doctest::Approx(0.4).epsilon(1e-15));
  // By 1e-12 only, where everything is of order one.
  CHECK(largest_jump(piecewise(less(x, third), x, x + Rational(1, 1000000000000))).first ==
        doctest::Approx(1e-12).epsilon(1e-9));
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
  const Expr g = pow(x, Rational(2)) + pow(y, Rational(2)) - Rational(4),
             f = piecewise(less(g, number(0)), number(5), number(7));
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
  for (const SwitchSample& s : sample_switches({&wall, 1}, switches_of({&wall, 1}), search()))
    CHECK(std::isnan(s.jump[0]));
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
  const std::array switches{x - Rational(1000), x - Rational(1001), y - Rational(2000),
                            y - Rational(2001), t - Rational(7000), t - Rational(7001)};
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

TEST_CASE_FIXTURE(Fixture, "of a sum and of its multiples a switch decides the terms that hold it") {
  const Expr held = abs(x - y) * y, other = abs(t) + x;
  const Expr root = number(3) * t * (held + other) + x;
  const SwitchUses uses(std::array{root, other});
  CHECK(uses.terms_with(x - y) == std::vector<Expr>{number(3) * t * held, number(0)});
  CHECK(uses.terms_with(y - x) == std::vector<Expr>{number(3) * t * held, number(0)});
  CHECK(uses.terms_with(t) == std::vector<Expr>{number(3) * t * abs(t), abs(t)});
  CHECK(uses.terms_with(x) == std::vector<Expr>{number(0), number(0)});
  const Expr both = step(t) * abs(t);  // no sum: the whole
  CHECK(SwitchUses({&both, 1}).terms_with(t).front() == both);
}

TEST_CASE_FIXTURE(Fixture, "the jump across a switch leaves out what both sides have, and is their difference") {
  const Expr f = y * (sin(x) + pow(abs(t) - number(2), Rational(2)) + abs(x)) + cos(y);
  const Expr jump = jump_across({&f, 1}, t).front();
  CHECK(zero_test(jump - (on_side({&f, 1}, t, true).front() - on_side({&f, 1}, t, false).front())).verdict ==
        Verdict::Zero);
  const auto symbols = symbols_of({&jump, 1});
  CHECK(std::find(symbols.begin(), symbols.end(), x) == symbols.end());
  const Expr g = y * step(t);
  CHECK(jump_across({&g, 1}, t).front() == y);
}

TEST_CASE_FIXTURE(Fixture, "a sampler sees what switches within the branch of another one") {
  // max(x, 3) where y > 0, |x| where not; sampled on x = 3 and x = 0 with either sign of y.
  const Expr f = piecewise(less(number(0), y), max(x, number(3)) + step(x - number(3)), abs(x) + step(x));
  const SwitchSampler sampler({f}, search());
  std::set<double> jumps;
  for (const SwitchSample& s : sampler.sample(x - number(3))) {
    CHECK(s.at.at(x) == doctest::Approx(3));
    CHECK(s.jump[0] == doctest::Approx(s.at.at(y) > 0 ? 1 : 0));
    jumps.insert(s.jump[0]);
  }
  CHECK(jumps == std::set<double>{0, 1});
  for (const SwitchSample& s : sampler.sample(x, std::array{x, t + number(2)})) {
    CHECK(s.jump[0] == doctest::Approx(s.at.at(y) > 0 ? 0 : 1));
    CHECK(s.above[2] == doctest::Approx(s.at.at(t) + 2));  // what is evaluated beside the functions
  }
}

TEST_CASE_FIXTURE(Fixture, "a function of a thousand pieces is differentiated in proportion to its size") {
  std::vector<Expr> pieces;
  for (int k = 0; k < 1000; ++k) {
    pieces.push_back(less(x, number(k)));
    pieces.push_back(number(k) * pow(x, Rational(2)) + number(k % 3) * y * sin(x));
  }
  pieces.push_back(y);
  const Expr f = context.function(Kind::Piecewise, pieces);
  const std::array symbols{x, y, t};
  const std::vector<Expr> slopes = gradient(sin(f) + x, symbols);
  CHECK(topological_order(slopes).size() < 20 * topological_order({&f, 1}).size());
  for (const double at : {0.5, 17.25, 611.125, 998.5, 1200.0}) {
    const int k = static_cast<int>(std::floor(at)) + 1;
    const Bindings point{{x, at}, {y, 0.375}, {t, 1}};
    const double value = k < 1000 ? k * at * at + k % 3 * 0.375 * std::sin(at) : 0.375;
    const double by_x = k < 1000 ? 2 * k * at + k % 3 * 0.375 * std::cos(at) : 0,
                 by_y = k < 1000 ? k % 3 * std::sin(at) : 1;
    CHECK(evaluate(slopes[0], point) == doctest::Approx(std::cos(value) * by_x + 1).epsilon(1e-9));
    CHECK(evaluate(slopes[1], point) == doctest::Approx(std::cos(value) * by_y).epsilon(1e-9));
    CHECK(slopes[2].is_zero());
  }
}

TEST_CASE_FIXTURE(Fixture, "a switch that is no sum is 0 at its root up to rounding, and has both branches there") {
  // cos t at the double next to pi/2 is 6e-17; t^3 and a product are as small beside 0.
  for (const Expr& g : {apply(Kind::Cos, t), pow(t - number(1), Rational(3)), (t - number(1)) * (number(2) + sin(x))}) {
    const Expr f = step(g) * (number(2) + y * y) + apply(Kind::Sign, sin(x) + number(5));
    const SwitchSampler sampler({f}, search());
    const std::vector<SwitchSample> samples = sampler.sample(g);
    CHECK(samples.size() >= 4);
    for (const SwitchSample& s : samples) CHECK(s.jump[0] == doctest::Approx(2 + s.at.at(y) * s.at.at(y)));
  }
}

TEST_CASE_FIXTURE(Fixture, "a switch at a constant larger than all other values is met") {
  for (const int far : {2'000'000, 40'000'000, -900'000'000}) CHECK(largest_jump(step(x - number(far))).first == 1);
}

TEST_CASE_FIXTURE(Fixture, "a narrow gate about a product or a function of constants is met") {
  const Expr a = context.symbol("a", Role::Parameter), b = context.symbol("b", Role::Parameter);
  for (const Expr& place : {a * b, a * sin(b), a / (b + number(3))}) {
    const Expr gate = piecewise(less(pow(x - place, Rational(2)), number(Rational(1, 1000000))), number(1), number(0));
    const auto samples = sample_switches({&gate, 1}, switches_of({&gate, 1}), {{x}, {{x, 0.1}, {a, 0.71}, {b, 0.93}}});
    REQUIRE(!samples.empty());
    CHECK(std::abs(samples.front().jump[0]) == 1);
  }
}
