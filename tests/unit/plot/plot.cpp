#include <maupertuis/plot.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace maupertuis;

namespace plot_test {
namespace {

Trajectory waves(std::size_t rows) {
  Trajectory trajectory;
  trajectory.columns = {{"θ1", "rad"}, {"θ2", "rad"}, {"θ1'", "rad/s"}, {"B.x", "m"}, {"B.y", "m"}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    trajectory.times.push_back(t);
    for (const double v : {std::sin(t), std::cos(t), std::cos(t), 2 * std::sin(t), std::cos(t)})
      trajectory.values.push_back(v);
  }
  return trajectory;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

// Elements open and close in pairs, attributes are quoted, nothing else stands in angle brackets.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos || xml.find('<', at + 1) < end) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (count(tag, "\"") % 2 != 0) return false;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/')
      open.push_back(tag.substr(0, tag.find(' ')));
  }
  return open.empty();
}

std::string plot(const Trajectory& trajectory, const PlotOptions& options = {}) {
  const std::string svg = plot_svg(trajectory, options);
  CHECK(well_formed(svg));
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  return svg;
}

PlotOptions columns(std::vector<std::string> names) {
  PlotOptions options;
  options.columns = std::move(names);
  return options;
}

// The numbers of an attribute of every element that has it.
std::vector<double> attributes(const std::string& svg, const std::string& element, const std::string& name) {
  std::vector<double> values;
  for (auto at = svg.find("<" + element); at != std::string::npos; at = svg.find("<" + element, at + 1)) {
    const auto place = svg.find(" " + name + "=\"", at);
    values.push_back(std::strtod(svg.c_str() + place + name.size() + 3, nullptr));
  }
  return values;
}

}  // namespace

TEST_CASE("no chord goes across rows that were left out of a phase portrait; over time they are joined") {
  Trajectory run = waves(600);
  run.gaps = {200, 400};
  PlotOptions options;
  options.columns = {"θ1'"};
  const auto stretches = [&] {  // moves of the pen in the path of the curve
    const std::string svg = plot_svg(run, options);
    const std::size_t at = svg.find(" d=\"", svg.find("class=\"curve"));
    return count(svg.substr(at, svg.find("\"/>", at) - at), "M");
  };
  CHECK(stretches() == 1);
  options.against = "θ1";
  CHECK(stretches() == 3);
  run.gaps = {200, 599};
  CHECK(count(plot_svg(run, options), "class=\"dot") == 1);  // the start; the last row is no point of its own
}

TEST_CASE("one panel for each unit, one legend entry for each of several curves") {
  const std::string svg = plot(waves(500), columns({"θ1", "θ1'", "θ2"}));
  CHECK(count(svg, "class=\"axis\"") == 2);
  CHECK(count(svg, "class=\"curve s1\"") == 3);  // two curves and a legend entry
  CHECK(count(svg, "class=\"curve s2\"") == 2);
  CHECK(count(svg, "(rad)") == 1);
  CHECK(count(svg, "(rad/s)") == 1);
  CHECK(count(svg, " (s)") == 1);
}

TEST_CASE("a title of an axis is no longer than its panel, and its blanks are kept") {
  Trajectory rows = waves(200);
  rows.columns.push_back({"energy", "J"});
  std::vector<double> values;
  for (std::size_t row = 0; row < 200; ++row) {
    for (std::size_t c = 0; c < 5; ++c) values.push_back(rows.values[row * 5 + c]);
    values.push_back(0.1973920880217 + 1e-15 * static_cast<double>(row % 7));
  }
  rows.values = values;
  const std::string svg = plot(rows, columns({"θ1", "θ1'", "B.x", "energy"}));
  const auto title = svg.rfind("<text", svg.find("energy ("));
  const double size = std::strtod(svg.c_str() + svg.find("font-size=\"", title) + 11, nullptr);
  CHECK(size > 4);
  CHECK(size < 12);
  const std::string two = plot(waves(500), columns({"B.x", "B.y"}));
  const auto names = two.rfind("<text", two.find("> ("));
  CHECK(two.substr(names, two.find('>', names) - names).find("xml:space=\"preserve\"") != std::string::npos);
}

TEST_CASE("each theme has its own ground; Page leaves it to the page") {
  CHECK(plot(waves(10)).find("fill:#ffffff") != std::string::npos);
  PlotOptions options;
  options.theme = PlotTheme::Dark;
  CHECK(plot(waves(10), options).find("fill:#16181d") != std::string::npos);
  options.theme = PlotTheme::Page;
  const std::string page = plot(waves(10), options);
  CHECK(page.find("<style>") == std::string::npos);
  CHECK(page.find("<rect") == std::string::npos);
  CHECK(plot_page_style().find("var(--series-7)") != std::string::npos);
  CHECK(plot_palette(false).size() == plot_palette(true).size());
}

TEST_CASE("degrees replace radians in values and labels") {
  PlotOptions options = columns({"θ1", "θ1'", "B.x"});
  options.degrees = true;
  const std::string svg = plot(waves(700), options);
  CHECK(svg.find("(°)") != std::string::npos);
  CHECK(svg.find("(°/s)") != std::string::npos);
  CHECK(svg.find(">30<") != std::string::npos);
  CHECK(svg.find("rad") == std::string::npos);
}

TEST_CASE("a path in space has one scale in both directions") {
  PlotOptions options = columns({"B.y"});
  options.against = "B.x";
  options.width = 600;
  // x goes from -2 to 2 and y from -1 to 1: a tenth of the picture's width is as long in x as in y.
  const std::string svg = plot(waves(700), options);
  const auto at = svg.find("class=\"curve s1\" d=\"M");
  double x = 0, y = 0, low_x = 0, high_x = 0, low_y = 0, high_y = 0;
  const char* p = svg.c_str() + at + std::string("class=\"curve s1\" d=\"M").size();
  char* next = nullptr;
  std::strtod(p, &next);
  std::strtod(next, &next);
  for (++next; *next != '"';) {
    x += std::strtod(next, &next);
    y += std::strtod(next, &next);
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  CHECK((high_x - low_x) / (high_y - low_y) == doctest::Approx(2).epsilon(0.002));
  CHECK(high_x - low_x > 400);
  CHECK(count(svg, "<circle") == 1);  // the start
}

TEST_CASE("gaps: a lone point is a dot, a line is cut") {
  Trajectory trajectory;
  trajectory.columns = {{"x", "m"}};
  trajectory.times = {0, 1, 2, 3, 4, 5};
  trajectory.values = {1, std::nan(""), 2, 3, std::numeric_limits<double>::infinity(), 4};
  const std::string svg = plot(trajectory);
  CHECK(count(svg, "<circle") == 2);
  const auto at = svg.find("class=\"curve s1\"");
  CHECK(count(svg.substr(at, svg.find("/>", at) - at), "M") == 3);
}

TEST_CASE("degenerate runs give a picture") {
  CHECK(plot(waves(0)).find("no data") != std::string::npos);
  CHECK(count(plot(waves(1)), "<circle") == 5);
  CHECK(plot(Trajectory{}).find("no data") != std::string::npos);
  for (const double value : {0.0, 3.0, -1e300, 1.7e308, 5e-324, std::nan("")}) {
    Trajectory constant;
    constant.columns = {{"x", "m"}};
    constant.times = {0, 1e-9, 2e-9};
    constant.values = {value, value, value};
    plot(constant);
    constant.values = {value, -value, 0};
    plot(constant);
    constant.times = {5, 5, 5};
    plot(constant);
  }
}

TEST_CASE("a backwards run is drawn like a forward one") {
  Trajectory forward = waves(300), backward = forward;
  const std::size_t width = forward.columns.size();
  for (std::size_t row = 0; row < 300; ++row) {
    backward.times[row] = forward.times[299 - row];
    for (std::size_t c = 0; c < width; ++c) backward.values[row * width + c] = forward.values[(299 - row) * width + c];
  }
  const auto frame = [](const std::string& svg) { return svg.substr(0, svg.find("class=\"curve")); };
  CHECK(frame(plot(forward, columns({"θ1"}))) == frame(plot(backward, columns({"θ1"}))));
}

TEST_CASE("a million rows give a small picture") {
  Trajectory trajectory;
  trajectory.columns = {{"x", "m"}, {"y", "m"}};
  for (int i = 0; i < 1'000'000; ++i) {
    trajectory.times.push_back(1e-3 * i);
    trajectory.values.push_back(std::sin(0.3 * i) + 0.5 * std::sin(0.0123 * i * i));
    trajectory.values.push_back(std::cos(0.7 * i));
  }
  CHECK(plot(trajectory, columns({"x"})).size() < 60'000);
  PlotOptions phase = columns({"y"});
  phase.against = "x";
  CHECK(plot(trajectory, phase).size() < 3'000'000);
}

TEST_CASE("many curves: colours from a ramp, a legend of some of them") {
  Trajectory trajectory;
  for (int k = 1; k <= 100; ++k) trajectory.columns.push_back({"θ" + std::to_string(k), "rad"});
  trajectory.times = {0, 1};
  for (int k = 0; k < 200; ++k) trajectory.values.push_back(k);
  const std::string svg = plot(trajectory);
  const auto curves = count(svg, "class=\"curve many\"");
  CHECK(curves > 105);
  CHECK(curves < 120);
}

TEST_CASE("an axis of many names shows as many as there is room for, in letters of the usual size") {
  Trajectory trajectory;
  for (int k = 1; k <= 12; ++k) trajectory.columns.push_back({"reaction(contact " + std::to_string(k) + ")", "N"});
  trajectory.times = {0, 1};
  for (int k = 0; k < 24; ++k) trajectory.values.push_back(k);
  const std::string svg = plot(trajectory);
  const auto label = svg.rfind("<text", svg.find("rotate(-90"));
  CHECK(std::strtod(svg.c_str() + svg.find("font-size=\"", label) + 11, nullptr) == 14);
  const std::string text = svg.substr(label, svg.find("</text>", label) - label);
  CHECK(text.find("…") != std::string::npos);
}

TEST_CASE("the legend stands above the frame") {
  const std::string svg = plot(waves(100), columns({"θ1", "θ2"}));
  const auto texts = attributes(svg, "text", "y");
  const auto frame = svg.find("class=\"axis\" d=\"M");
  const double top = std::strtod(svg.c_str() + svg.find(' ', frame + 17), nullptr);
  CHECK(texts[texts.size() - 2] < top);  // the last legend entry; the last text is the label of the time
}

TEST_CASE("a column that is not there is named, with a suggestion") {
  CHECK(plot_problem(waves(2), columns({"θ1", "θ3"})) == "the run has no θ3; did you mean θ1?");
  CHECK(plot_problem(waves(2), columns({"banana"})) == "the run has no banana");
  CHECK(plot_problem(waves(2), columns({"t"})) == "the time is the horizontal axis: name what to draw against it");
  PlotOptions options;
  options.against = "B.z";
  CHECK(plot_problem(waves(2), options) == "the run has no B.z; did you mean B.x?");
  CHECK(plot_problem(waves(2), {}) == "");
  options = {};
  options.width = 10;
  CHECK(plot_problem(waves(2), options) == "a picture is at least 240 px wide");
}

}  // namespace plot_test
