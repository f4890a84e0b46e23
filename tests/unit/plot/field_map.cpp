#include "plot/bands.hpp"

#include <maupertuis/field_map.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace maupertuis;

namespace {

/// Area of closed lines, whatever their direction.
double area_of(const std::vector<Polyline>& loops) {
  double sum = 0;
  for (const Polyline& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Pixel &a = loop[i], &b = loop[(i + 1) % loop.size()];
      sum += (a.x * b.y - b.x * a.y) / 2;
    }
  return std::abs(sum);
}

struct Sampled {
  std::vector<double> x, y, values;
  template <class F>
  Sampled(std::size_t n, F&& f) {
    for (std::size_t i = 0; i <= n; ++i) x.push_back(-1 + 2.0 * static_cast<double>(i) / static_cast<double>(n));
    y = x;
    for (const double b : y)
      for (const double a : x) values.push_back(f(a, b));
  }
  double area_above(double level) const { return area_of(region_above({x, y, values}, level)); }
};

/// Lightness of "#rrggbb", CIE L* of its luminance.
double lightness(const std::string& colour) {
  double y = 0;
  const double weight[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::stoi(colour.substr(1 + 2 * k, 2), nullptr, 16) / 255.0;
    y += weight[k] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return 116 * std::cbrt(y) - 16;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("the region above a level has the area of its closed form") {
  const Sampled bowl(80, [](double x, double y) { return 1 - x * x - y * y; });
  CHECK(bowl.area_above(0.5) == doctest::Approx(3.14159265358979 * 0.5).epsilon(1e-3));
  CHECK(bowl.area_above(-5) == doctest::Approx(4));
  CHECK(bowl.area_above(2) == 0);
  // a saddle and its negative share the square between them
  const Sampled saddle(7, [](double x, double y) { return x * y; }),
      turned(7, [](double x, double y) { return -x * y; });
  CHECK(saddle.area_above(0.2) == doctest::Approx(turned.area_above(0.2)));
  CHECK(saddle.area_above(0.2) + turned.area_above(-0.2) == doctest::Approx(4).epsilon(0.02));
  // one value that is missing takes its four cells away
  Sampled hole(10, [](double, double) { return 1; });
  hole.values[5 * 11 + 5] = std::numeric_limits<double>::quiet_NaN();
  CHECK(hole.area_above(0) == doctest::Approx(4 - 0.16));
}

TEST_CASE("colours go evenly from dark over white to dark, or from pale to dark") {
  for (const double s : {0.1, 0.3, 0.5, 0.7, 0.9})
    CHECK(std::abs(lightness(field_colour(s, true)) - lightness(field_colour(-s, true))) < 6);
  double before = 200;
  for (double s = 0; s <= 1; s += 0.05) {
    for (const bool two : {false, true}) {
      const double step = lightness(field_colour(s, two)) - lightness(field_colour(std::min(1.0, s + 0.05), two));
      CHECK(step > (s < 0.97 ? 1.2 : -1e-9));
      CHECK(step < 5.5);
    }
    CHECK(lightness(field_colour(s, false)) < before);
    before = lightness(field_colour(s, false));
  }
}

TEST_CASE("a map has its bar, its axes and a curve for each moment, whatever the numbers") {
  FieldMap map;
  map.title = "T < 1", map.x_name = "x", map.x_unit = "m", map.y_name = "t", map.y_unit = "s", map.value_name = "u";
  map.x = {0, 1, 2}, map.y = {0, 1};
  map.sheets = {{"", {0, 1, 2, -2, 0, 1}}};
  map.lines = {{0, "t = 0 s"}, {1, "t = 1 s"}};
  const std::string svg = field_map_svg(map);
  CHECK(occurrences(svg, "<rect x=") == 25);
  CHECK(occurrences(svg, "class=\"curve") == 6);  // each with its key and its mark at the map
  CHECK(occurrences(svg, "T &lt; 1") >= 1);
  CHECK(svg.find("nan") == std::string::npos);
  for (const double value : {0.0, 1e300, -1e-300, std::numeric_limits<double>::quiet_NaN()}) {
    map.sheets[0].values.assign(6, value);
    CHECK(field_map_svg(map).find("nan") == std::string::npos);
  }
}
