#include "plot/polyline.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace maupertuis;

namespace {

double distance_to_segment(Pixel p, Pixel a, Pixel b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double s = square == 0 ? 0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0);
  return std::hypot(p.x - a.x - s * dx, p.y - a.y - s * dy);
}

double distance_to_line(Pixel p, const Polyline& line) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    nearest = std::min(nearest, distance_to_segment(p, line[i], line[i + 1]));
  return nearest;
}

Polyline random_walk(unsigned seed, std::size_t count, double step) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, step);
  Polyline line{{300, 200}};
  while (line.size() < count)
    line.push_back({std::clamp(line.back().x + normal(random), 0.0, 600.0),
                    std::clamp(line.back().y + normal(random), 0.0, 400.0)});
  return line;
}

}  // namespace

TEST_CASE("gaps cut a line; a lone point is a line of one point") {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const auto lines = split_at_gaps({{0, nan}, {1, 1}, {2, 2}, {3, inf}, {4, 4}, {5, nan}, {6, nan}});
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].size() == 2);
  CHECK(lines[1].size() == 1);
  CHECK(lines[1][0].x == 4);
  CHECK(split_at_gaps({}).empty());
  const auto apart = split_at_gaps({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, nan}, {5, 5}}, {2, 4});
  REQUIRE(apart.size() == 3);
  CHECK(apart[0].back().x == 1);
  CHECK(apart[1].front().x == 2);
  CHECK(apart[2].front().x == 5);
}

TEST_CASE("columns keep first, lowest, highest, last, in their order") {
  const Polyline line{{0.1, 5}, {0.2, 9}, {0.3, 1}, {0.4, 6}, {1.1, 2}, {1.2, 2}};
  const Polyline thinned = thin_columns(line, 1);
  REQUIRE(thinned.size() == 6);
  CHECK(thinned[1].y == 9);
  CHECK(thinned[2].y == 1);
  CHECK(thin_columns({{0.1, 1}, {0.2, 2}, {0.3, 3}, {0.4, 4}}, 1).size() == 2);
}

TEST_CASE("a million rows of noise become at most four points a column, extremes included") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 300);
  Polyline line;
  for (int i = 0; i < 1'000'000; ++i) line.push_back({i * 640e-6, uniform(random)});
  line[123'456].y = 1000;
  line[654'321].y = -1000;
  const Polyline thinned = thin_columns(line, 0.5);
  CHECK(thinned.size() <= 4 * 1281u);
  const auto higher = [](Pixel a, Pixel b) { return a.y < b.y; };
  CHECK(std::max_element(thinned.begin(), thinned.end(), higher)->y == 1000);
  CHECK(std::min_element(thinned.begin(), thinned.end(), higher)->y == -1000);
}

TEST_CASE("straighten stays within its tolerance and keeps the ends") {
  const bool held = rc::check("tolerance", [](unsigned seed) {
    const double step = *rc::gen::element(0.01, 0.1, 1.0, 10.0);
    const Polyline line = random_walk(seed, 150, step);
    const Polyline straight = straighten(line, 0.05);
    RC_ASSERT(straight.front().x == line.front().x);
    RC_ASSERT(straight.back().y == line.back().y);
    for (const Pixel& p : line) RC_ASSERT(distance_to_line(p, straight) < 0.0501);
  });
  CHECK(held);
  CHECK(straighten({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, 0.05).size() == 2);
  // There and back again: the turning point stays.
  CHECK(straighten({{0, 0}, {5, 0}, {2, 0}}, 0.05).size() == 3);
}

TEST_CASE("ink: a curve that repeats itself is drawn once; what is new is drawn") {
  Polyline circle;
  for (int i = 0; i <= 100 * 360; ++i)
    circle.push_back({200 + 100 * std::cos(i * 0.017453292519943295), 200 + 100 * std::sin(i * 0.017453292519943295)});
  Ink ink(400, 400);
  std::size_t points = 0;
  for (const auto& part : ink.draw(circle)) points += part.size();
  CHECK(points > 300);
  CHECK(points < 800);
  const auto chord = ink.draw({{120, 200}, {280, 200}});
  REQUIRE(chord.size() == 1);
  CHECK(ink.draw({{120, 200}, {280, 200}}).empty());
}

TEST_CASE("path data: hundredths, relative, as short as SVG reads") {
  CHECK(path_data({{{1, 2}, {1.5, 1.25}, {1.5, 1.25}, {11.5, -0.75}}}) == "M1 2l.5-.75 10-2");
  CHECK(path_data({{{1, 2}}}) == "M1 2h0");
  CHECK(path_data({{{0, 0}, {1, 1}}, {{5, 5}, {6, 5.05}}}) == "M0 0l1 1M5 5l1 .05");
  CHECK(path_data({}) == "");
}
