#include <maupertuis/diagram.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace maupertuis;

namespace {
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t out = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++out;
  return out;
}
}  // namespace

TEST_CASE("a diagram draws lines, dashes, dots, marks and names") {
  Diagram d;
  d.x_name = "Ω";
  d.x_unit = "rad/s";
  d.y_name = "θ";
  d.degrees_y = true;
  d.curves.push_back({{0, 1, 2}, {0, 0, 0}, 0, false, false});
  d.curves.push_back({{2, 3}, {0, 0.5}, 1, true, false});
  d.curves.push_back({{0, 1, 2, 3}, {1, 1, 1, 1}, 2, false, true});
  d.marks.push_back({2, 0, "Ω = 2 rad/s"});
  d.legend.push_back({"stable", 0, false, false});
  const std::string svg = diagram_svg(d);
  CHECK(count(svg, "<path class=\"curve") == 3);  // two curves and the legend
  CHECK(count(svg, "stroke-dasharray=") == 1);
  CHECK(count(svg, "<circle class=\"dot") == 4);
  CHECK(count(svg, "<circle class=\"axis\"") == 1);
  CHECK(count(svg, "Ω = 2 rad/s") == 1);
  CHECK(count(svg, "°") >= 1);
}

TEST_CASE("a diagram survives empty, constant and missing numbers") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Diagram d;
  d.x_name = "x";
  d.y_name = "y";
  CHECK(count(diagram_svg(d), "</svg>") == 1);
  d.curves.push_back({{1, 1, nan, 2}, {3, 3, 3, nan}, 0, false, false});
  CHECK(count(diagram_svg(d), "nan") == 0);
}
