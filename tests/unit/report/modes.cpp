#include <maupertuis/report.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace maupertuis;

namespace modes_test {
namespace {

ReportContent with_modes() {
  ReportContent content;
  content.title = "Two pendulums";
  ReportContent::ModePoint point;
  point.name = "θ1 = 0, θ2 = 0";
  point.stability = "stable: the Hessian of the potential is positive definite";
  point.stable = true;
  point.rows.push_back({"oscillation", "3.13 rad/s", "0.498 Hz", "2.01 s", ""});
  Drawing swing;
  swing.times = {0, 0.5, 1};
  swing.elements.push_back({Drawing::Kind::Path, 1, {0, 0, 0.1, 0, 0, 0}, false, {1}, {0.1}, {"A"}, {}, {}});
  point.shapes.push_back({"Mode 1: 3.13 rad/s", swing, std::nullopt});
  Diagram stems;
  stems.y_name = "shape";
  stems.curves.push_back({{0, 0}, {0, 1}, 0, false, false});
  point.shapes.push_back({"Mode 2", std::nullopt, stems});
  content.mode_points.push_back(point);
  return content;
}

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("equilibria and modes have a part of the page, shapes swing without end") {
  const std::string page = report_html(with_modes());
  CHECK(has(page, "<section id=\"modes\">"));
  CHECK(has(page, "<figure class=\"mode\" data-drawing=\"mode-1-1\" data-loop data-rate=\"0.5\">"));
  CHECK(has(page, "id=\"mode-1-1\""));
  CHECK(has(page, "function animate(figure, scene)"));  // the script comes along though there is no drawing of a run
  CHECK(has(page, "<figcaption>Mode 2</figcaption>"));
}

TEST_CASE("a page without equilibria has no such part") {
  ReportContent content;
  content.title = "Free fall";
  const std::string page = report_html(content);
  CHECK_FALSE(has(page, "id=\"modes\""));
  CHECK_FALSE(has(page, "function animate("));
}

}  // namespace modes_test
