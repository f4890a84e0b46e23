#include <maupertuis/plot.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

namespace {

Trajectory ramp() {
  Trajectory out;
  out.columns = {{"x", "m"}, {"x'", "m/s"}};
  for (int i = 0; i <= 100; ++i) {
    out.times.push_back(0.1 * i);
    out.values.insert(out.values.end(), {0.01 * i, 1.0});
  }
  return out;
}

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

/// The path of a class.
std::string path_of(const std::string& svg, const std::string& name) {
  const auto at = svg.find("<path class=\"" + name + "\" d=\"");
  if (at == std::string::npos) return {};
  const auto from = svg.find("d=\"", at) + 3;
  return svg.substr(from, svg.find('"', from) - from);
}

double number_after(const std::string& text, char letter) { return std::stod(text.substr(text.find(letter) + 1)); }

}  // namespace

TEST_CASE("marks are thin lines through all panels at their times; names stand above where there is room") {
  PlotOptions options;
  options.marks = {{2.5, "floor", false}, {5, "hit", true}, {5.001, "hit", true}};
  const std::string svg = plot_svg(ramp(), options), bare = plot_svg(ramp());
  CHECK(times_in(path_of(svg, "mark"), "M") == 2);        // two panels
  CHECK(times_in(path_of(svg, "mark event"), "M") == 2);  // the third is on the second
  CHECK(times_in(svg, "floor") == 1);
  CHECK(times_in(svg, "hit") == 1);
  options.marks[2].name = "other";  // another name goes to a line of its own
  const std::string two = plot_svg(ramp(), options);
  CHECK(times_in(two, "other") == 1);
  CHECK(times_in(two, "hit") == 1);
  const auto height = [](const std::string& picture) {
    return std::stod(picture.substr(picture.find(" height=\"") + 9));
  };
  CHECK(height(two) == doctest::Approx(height(svg) + 16));
  CHECK(times_in(bare, "<path class=\"mark") == 0);
  const std::string frame = path_of(svg, "axis");
  const double left = number_after(frame, 'M'), width = number_after(frame, 'h');
  CHECK(number_after(path_of(svg, "mark"), 'M') == doctest::Approx(left + width / 4).epsilon(1e-4));
}

TEST_CASE("strips: a bar a contact, as long as its state lasts; the legend names what occurs") {
  using State = PlotStrip::State;
  PlotOptions options;
  options.strips = {{"belt", {{0, 2, State::Stick}, {2, 4, State::Forward}, {4, 10, State::Open}}},
                    {"wall", {{0, 10, State::Closed}}}};
  const std::string svg = plot_svg(ramp(), options);
  for (const char* word : {"belt", "wall", "sticking", "sliding +", "closed"}) {
    CAPTURE(word);
    CHECK(times_in(svg, word) == 1);
  }
  CHECK(times_in(svg, "sliding −") == 0);
  const double width = number_after(path_of(svg, "axis"), 'h');
  CHECK(number_after(path_of(svg, "strip s3"), 'h') == doctest::Approx(width / 5).epsilon(1e-3));
  CHECK(number_after(path_of(svg, "strip s1"), 'h') == doctest::Approx(width).epsilon(1e-3));
}

TEST_CASE("a long name of a contact leaves room for the picture") {
  PlotOptions options;
  options.strips = {{std::string(200, 'w'), {{0, 10, PlotStrip::State::Closed}}}};
  const std::string svg = plot_svg(ramp(), options);
  CHECK(number_after(path_of(svg, "axis"), 'h') > 400);
  CHECK(times_in(svg, "…") == 1);
}

TEST_CASE("over another axis than the time there are neither marks nor strips") {
  PlotOptions options;
  options.columns = {"x'"};
  options.against = "x";
  const std::string bare = plot_svg(ramp(), options);
  options.marks = {{2.5, "floor", false}};
  options.strips = {{"wall", {{0, 10, PlotStrip::State::Closed}}}};
  CHECK(plot_svg(ramp(), options) == bare);
}

TEST_CASE("a hundred thousand impacts give a picture of bounded size") {
  PlotOptions options;
  for (int i = 0; i < 100'000; ++i) options.marks.push_back({1e-4 * i, "wall", false});
  CHECK(plot_svg(ramp(), options).size() < 60'000);
}
