#include "evaluate_line.hpp"
#include "random_line.hpp"

#include "kernel/straight_line/evaluator.hpp"

#include <doctest/doctest.h>

// Lines run number by number against the meaning of their nodes.

using namespace maupertuis;
using namespace maupertuis::straight;

TEST_CASE("random lines, whether what is given changes from call to call or seldom") {
  const std::vector<double> x{0.3, -0.7, 1.1, 0.9, -0.2, 0.5}, other{1.3, 0.4, -0.6, 0.2, 0.8, -1.5};
  const double* const unused = nullptr;
  for (const int length : {3, 40, 2000}) {
    CAPTURE(length);
    const StraightLine line = random_line(static_cast<unsigned>(length), length);
    Evaluator often(line), seldom(line, std::vector<std::uint32_t>{0});
    for (const std::vector<double>& given : {x, other}) {
      const Evaluated expected = evaluate(line, {given, std::vector<double>(30, 0.0)});
      std::vector<double> y(30), z(30);
      CHECK(often(given.data(), y.data()) == (expected.margin > 0));
      seldom.set(given.data(), unused);
      CHECK(seldom(unused, z.data()) == (expected.margin > 0));
      for (std::size_t i = 0; i < y.size(); ++i)
        CHECK(y[i] == doctest::Approx(expected.arrays[1][i]).epsilon(1e-12).scale(1));
      CHECK(y == z);
    }
  }
}

TEST_CASE("of a guarded line nothing is stored where a pivot is small or a number infinite or undefined") {
  Builder to;
  for (std::uint32_t i = 0; i < 3; ++i) to.check({to.given(0, i), to.literal(1), 0.5});
  to.require_finite(to.given(0, 3));
  to.store(to.sum({{2, to.given(0, 0)}}), 1, 0);
  to.guard();
  Evaluator run(to.finish(2, 1, 0));
  const auto result = [&run](std::vector<double> x) {
    double y = 7;
    const bool is_sound = run(x.data(), &y);
    CHECK(y == (is_sound ? 2 * x[0] : 7));
    return is_sound;
  };
  CHECK(result({1, 1, 1, 1}));
  for (std::size_t i = 0; i < 3; ++i)
    for (const double bad : {0.4, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
      std::vector<double> x{1, 1, 1, 1};
      x[i] = bad;
      CHECK_FALSE(result(x));
    }
  CHECK_FALSE(result({1, 1, 1, NAN}));
  CHECK_FALSE(result({1, 1, 1, -INFINITY}));
}

TEST_CASE("functions with a value on each side of a switch keep what is not a number") {
  for (const Kind kind : {Kind::Abs, Kind::Sign, Kind::Step, Kind::Min, Kind::Max}) {
    Builder to;
    to.store(to.call(kind, to.given(0, 0), to.given(0, 1)), 1, 0);
    Evaluator run(to.finish(2, 1, 0));
    const std::vector<double> x{NAN, 1};
    double y = 0;
    run(x.data(), &y);
    CHECK(std::isnan(y));
  }
}
