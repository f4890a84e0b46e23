#include "../processors.hpp"
#include "evaluate_line.hpp"
#include "random_line.hpp"

#include "kernel/straight_line/compile.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

// Machine code against the meaning of the nodes.

using namespace maupertuis;
using namespace maupertuis::straight;

TEST_CASE("random lines, short ones and ones that are cut into functions, for this processor and lesser ones") {
  const std::vector<double> x{0.3, -0.7, 1.1, 0.9, -0.2, 0.5};
  for (const std::string& processor : levels_here({"", "x86-64", "x86-64-v3"}))
    for (const int length : {3, 40, 2000}) {
      CAPTURE(processor);
      CAPTURE(length);
      const StraightLine line = random_line(static_cast<unsigned>(length), length);
      const auto [code, report] = compile({line, line}, {.cache = false, .processor = processor});
      REQUIRE_MESSAGE(code, report.trouble);
      const Evaluated expected = evaluate(line, {x, std::vector<double>(30, 0.0)});
      std::vector<double> y(30), scratch(scratch_size(line));
      code(1, x.data(), y.data(), scratch.data());
      for (std::size_t i = 0; i < y.size(); ++i)
        CHECK(y[i] == doctest::Approx(expected.arrays[1][i]).epsilon(1e-9).scale(1));
      CHECK(scratch[0] == doctest::Approx(expected.margin).epsilon(1e-9));
      CHECK(sound(scratch.data()) == (expected.margin > 0));
    }
}

TEST_CASE("what is small, infinite or undefined is told, wherever it stands") {
  Builder to;
  for (std::uint32_t i = 0; i < 3; ++i) to.check({to.given(0, i), to.literal(1), 0.5});
  to.require_finite(to.given(0, 3));
  const auto [code, report] = compile({to.finish(1, 1, 0)}, {.cache = false});
  REQUIRE_MESSAGE(code, report.trouble);
  const auto is_sound = [&code = code](std::vector<double> x) {
    std::vector<double> scratch(64);
    code(0, x.data(), scratch.data());
    return sound(scratch.data());
  };
  CHECK(is_sound({1, 1, 1, 1}));
  for (std::size_t i = 0; i < 3; ++i)
    for (const double bad : {0.4, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
      std::vector<double> x{1, 1, 1, 1};
      x[i] = bad;
      CHECK_FALSE(is_sound(x));
    }
  CHECK_FALSE(is_sound({1, 1, 1, NAN}));
  CHECK_FALSE(is_sound({1, 1, 1, -INFINITY}));
}

namespace {

/// Of all sizes, and beside multiples of π/2, where reduction cancels.
std::vector<double> various_angles() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> out{0.0,  -0.0,     0x1p-1000, 0x1.921fb54442d18p0, 0x1.921fb54442d18p-1, 0x1p20, -0x1p20,
                          1e22, INFINITY, NAN};
  for (int i = 0; i < 20'000; ++i) out.push_back(unit(random) * std::ldexp(1.0, i % 24 - 2));
  for (int k = 1; k < 20'000; ++k) {
    const double near = static_cast<double>(k * (k % 3 == 0 ? 31 : 1) * 0x1.921fb54442d18469898cc51701b8p0L);
    out.insert(out.end(), {near, std::nextafter(near, 0.0), -near});
  }
  return out;
}

double units_apart(double x, long double exact) {
  const double rounded = static_cast<double>(exact);
  const double unit = std::nextafter(std::abs(rounded), INFINITY) - std::abs(rounded);
  return static_cast<double>(std::abs(static_cast<long double>(x) - exact) / unit);
}

}  // namespace

TEST_CASE("sines and cosines: within a unit in the last place, and the same to the bit however many are made at once") {
  std::vector<StraightLine> lines;
  const std::vector<std::uint32_t> counts{1, 2, 3, 4, 8};
  for (const std::uint32_t count : counts) {
    Builder to;
    std::vector<Value> angles;
    for (std::uint32_t i = 0; i < count; ++i) angles.push_back(to.given(0, i));
    const auto both = to.sines(angles);
    for (std::uint32_t i = 0; i < count; ++i) to.store(both[i].first, 1, i), to.store(both[i].second, 2, i);
    lines.push_back(to.finish(3, 1, 0));
  }
  const auto [code, report] = compile(lines, {.cache = false});
  REQUIRE_MESSAGE(code, report.trouble);
  const std::vector<double> angles = various_angles();
  double worst = 0;
  bool same = true;
  for (std::size_t first = 0; first + 8 <= angles.size(); first += 8) {
    std::vector<double> scratch(4096), s(8), c(8);
    code(4, &angles[first], s.data(), c.data(), scratch.data());
    for (std::size_t i = 0; i < 8; ++i) {
      const double x = angles[first + i];
      if (!std::isfinite(x)) {
        CHECK(std::isnan(s[i]));
        CHECK(std::isnan(c[i]));
        continue;
      }
      worst = std::max({worst, units_apart(s[i], std::sin(static_cast<long double>(x))),
                        units_apart(c[i], std::cos(static_cast<long double>(x)))});
      if (x == 0) CHECK(std::signbit(s[i]) == std::signbit(x));
    }
    for (std::size_t k = 0; k + 1 < counts.size(); ++k)
      for (std::size_t i = 0; i + counts[k] <= 8; ++i) {
        std::vector<double> sines(8), cosines(8);
        code(k, &angles[first + i], sines.data(), cosines.data(), scratch.data());
        for (std::size_t lane = 0; lane < counts[k]; ++lane) {
          const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
          // Beyond 2²⁰ in one lane all come from the library.
          const auto inside = [&](std::size_t from, std::size_t count) {
            return std::all_of(&angles[from], &angles[from] + count, [](double x) { return std::abs(x) < 0x1p20; });
          };
          if (inside(first, 8) && inside(first + i, counts[k]))
            same = same && equal(sines[lane], s[i + lane]) && equal(cosines[lane], c[i + lane]);
        }
      }
  }
  CHECK(worst < 1);
  CHECK(same);
}

TEST_CASE("guarded lines store only where all went well, and last: results may go where arguments stood") {
  for (const int length : {1, 1500}) {
    Builder to;
    Value sum = to.given(0, 0);
    for (int i = 0; i < length; ++i) sum = to.sum({{0.5, sum}, {0.25, to.given(0, 1)}});
    to.store(sum, 1, 1), to.store(to.given(0, 1), 1, 0), to.store(to.given(0, 0), 1, 2);
    to.check({to.given(0, 1), to.literal(1), 0.5});
    to.require_finite(sum);
    to.guard();
    const StraightLine line = to.finish(2, 1, 0);
    const auto [code, report] = compile({line}, {.cache = false});
    REQUIRE_MESSAGE(code, report.trouble);
    std::vector<double> scratch(scratch_size(line));
    for (const std::vector<double>& given : {std::vector<double>{3, 2, 7}, {3, 0.2, 7}, {NAN, 2, 7}}) {
      std::vector<double> x = given, y(3, 5.0);
      const bool sound = !std::isnan(given[0]) && given[1] > 0.5;
      CHECK(code.guarded(0, given.data(), y.data(), scratch.data()) == sound);
      if (!sound) CHECK(y == std::vector<double>(3, 5.0));
      code.guarded(0, x.data(), x.data(), scratch.data());
      if (sound) CHECK(x == y);
      if (sound) CHECK(x == std::vector<double>{2, y[1], 3});
    }
  }
}

TEST_CASE("values of several widths, whose lanes come from one value, from two, and from anywhere") {
  Builder to;
  const Value a = to.wide_given(0, 0, 4), b = to.wide_given(0, 4, 4), pair = to.wide_given(0, 1, 2), x = to.given(0, 8);
  const auto lane = [&](Value v, std::uint32_t i) { return to.lane(v, i); };
  const Value turned = to.gather({lane(a, 3), lane(a, 2), lane(a, 1), lane(a, 0)});
  const Value both = to.gather({lane(a, 1), lane(b, 2), lane(b, 0), lane(a, 3)});
  const Value any = to.gather({lane(pair, 1), x, lane(a, 0), to.literal(7)});
  to.store(to.sum({{2, turned, x}, {-1, both}, {1}}), 1, 0);
  to.store(to.sum({{1, any}}, a, b), 1, 4);
  to.store(to.root(to.gather({lane(b, 3), lane(pair, 0)})), 1, 8);
  const auto [code, report] = compile({to.finish(2, 1, 0)}, {.cache = false});
  REQUIRE_MESSAGE(code, report.trouble);
  const std::vector<double> g{1, 2, 3, 4, 5, 6, 8, 9, 0.5};
  std::vector<double> y(10), scratch(8);
  code(0, g.data(), y.data(), scratch.data());
  CHECK(y == std::vector<double>{4 - 2 + 1, 3 - 8 + 1, 2 - 5 + 1, 1 - 4 + 1, 3.0 * 1 / 5, 0.5 * 2 / 6, 1.0 * 3 / 8,
                                 7.0 * 4 / 9, 3, std::sqrt(2.0)});
}

TEST_CASE("a line that is too long is declined in a sentence") {
  Builder to;
  Value x = to.given(0, 0);
  for (int i = 0; i < 40'000; ++i) x = to.sum({{1, x}, {0.5}});
  to.store(x, 1, 0);
  const auto [code, report] = compile({to.finish(2, 1, 0)}, {.cache = false});
  CHECK_FALSE(code);
  CHECK(report.trouble == "the program is too long to be written out as machine code");
}
