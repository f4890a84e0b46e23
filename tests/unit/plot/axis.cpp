#include "plot/axis.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>
#include <limits>

using maupertuis::Axis;
using maupertuis::Range;

namespace {

Range range(double low, double high) {
  Range result;
  result.include(low);
  result.include(high);
  return result;
}

std::string labels(const Axis& axis) {
  std::string text;
  for (const auto& tick : axis.ticks()) text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

double number(std::string label) {
  if (const auto minus = label.find("−"); minus == 0) label.replace(0, std::string("−").size(), "-");
  return std::strtod(label.c_str(), nullptr);
}

// The value that a reader of the axis takes a tick for.
double read_value(const Axis& axis, const maupertuis::Tick& tick) {
  return axis.offset() + std::pow(10.0, axis.exponent()) * number(tick.label);
}

}  // namespace

TEST_CASE("ticks are 1, 2, 5 times a power of ten") {
  CHECK(labels(Axis(range(0, 20), {500, 60, 0, false})) == "0 5 10 15 20");
  CHECK(labels(Axis(range(-1, 1), {250, 60, 0, false})) == "−1.0 −0.5 0.0 0.5 1.0");
  CHECK(labels(Axis(range(0, 0.3), {400, 100, 0, false})) == "0.0 0.1 0.2 0.3");
}

TEST_CASE("degrees have their own steps where they are large") {
  CHECK(labels(Axis(range(-180, 180), {400, 60, 0, true})) == "−180 −90 0 90 180");
  CHECK(labels(Axis(range(0, 60), {400, 60, 0, true})) == "0 10 20 30 40 50 60");
  CHECK(labels(Axis(range(0, 10), {300, 60, 0, true})) == "0 2 4 6 8 10");
}

TEST_CASE("large and small magnitudes share a power of ten") {
  const Axis large(range(0, 3e8), {400, 100, 0, false});
  CHECK(large.exponent() == 8);
  CHECK(labels(large) == "0 1 2 3");
  const Axis small(range(-2e-13, 0), {400, 200, 0, false});
  CHECK(small.exponent() == -13);
  CHECK(labels(small) == "−2 −1 0");
  CHECK(Axis(range(0, 9999), {}).exponent() == 0);
}

TEST_CASE("digits that all values share go to the offset") {
  const Axis axis(range(-19.62 - 1.2e-13, -19.62 + 1.2e-13), {400, 200, 0, false});
  CHECK(axis.offset() == -19.62);
  CHECK(axis.offset_label() == "−19.62");
  CHECK(axis.exponent() == -13);
  CHECK(Axis(range(1e6, 1e6 + 3), {}).offset_label() == "1000000");
  CHECK(Axis(range(99, 101), {}).offset() == 0);
}

TEST_CASE("degenerate ranges still give an axis") {
  CHECK(labels(Axis(Range{}, {400, 200, 0, false})) == "0.0 0.5 1.0");
  CHECK(Axis(range(3, 3), {}).position(3) == doctest::Approx(0.5));
  CHECK(Axis(range(0, 0), {}).position(0) == doctest::Approx(0.5));
  CHECK(Axis(range(5e-324, 5e-324), {}).ticks().size() >= 2);
  CHECK(std::isnan(Axis(range(0, 1), {}).position(std::nan(""))));
  Range infinite;
  infinite.include(std::numeric_limits<double>::infinity());
  CHECK(infinite.empty);
}

TEST_CASE("with_span shows exactly the span about the middle") {
  const Axis axis = Axis::with_span(range(2, 4), 10, {});
  CHECK(axis.span() == doctest::Approx(10));
  CHECK(axis.position(3) == doctest::Approx(0.5));
}

TEST_CASE("labels say the truth: what stands at a tick is the value there, on any range") {
  const bool held = rc::check("labels", [] {
    const double size = std::pow(10.0, *rc::gen::inRange(-280, 280));
    const double middle = size * *rc::gen::inRange(-1000, 1001);
    const double half = size * std::pow(10.0, *rc::gen::inRange(-9, 4));
    const double padding = *rc::gen::element(0.0, 0.05);
    const Axis axis(range(middle - half, middle + half), {*rc::gen::element(100.0, 640.0), 60, padding, false});
    RC_ASSERT(!axis.ticks().empty());
    RC_ASSERT(axis.ticks().size() <= 12u);
    const double rounding = 1e-15 * std::abs(middle) / half;  // of the values themselves
    for (const auto& tick : axis.ticks()) {
      RC_ASSERT(tick.position > -1e-6 - rounding);
      RC_ASSERT(tick.position < 1 + 1e-6 + rounding);
      RC_ASSERT(std::abs(axis.position(read_value(axis, tick)) - tick.position) < 1e-5 + rounding);
    }
    for (std::size_t i = 1; i < axis.ticks().size(); ++i) RC_ASSERT(axis.ticks()[i].label != axis.ticks()[i - 1].label);
  });
  CHECK(held);
}
