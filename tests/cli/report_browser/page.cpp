// Writes a report of made-up numbers for the browser test: `report_browser_page plane|space FILE`.
#include <maupertuis/report.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

using namespace maupertuis;

namespace {

constexpr int frames = 401;
constexpr double duration = 8;

std::string symbol(const std::string& letter, const std::string& index = {}, const std::string& dots = {}) {
  const std::string base = dots.empty() ? "<mi>" + letter + "</mi>"
                                        : "<mover accent=\"true\"><mi>" + letter + "</mi><mo>" + dots + "</mo></mover>";
  return index.empty() ? base : "<msub>" + base + "<mn>" + index + "</mn></msub>";
}

// A cart on a rail with a pendulum, a spring to the wall, a box and a disc; and a point that is lost for a while.
Drawing plane_drawing() {
  Drawing drawing;
  drawing.gravity = {0, -9.81};
  Drawing::Element wall{Drawing::Kind::Spring, 2, {}, {}, {}, {0, 0}, {"", "cart"}};
  Drawing::Element box{Drawing::Kind::Box, 1, {}, {}, {}, {2}, {"cart"}};
  Drawing::Element rod{Drawing::Kind::Line, 2, {}, {}, {}, {0, 0.5}, {"cart", "bob"}};
  Drawing::Element disc{Drawing::Kind::Circle, 1, {}, {}, {}, {0}, {""}};
  Drawing::Element trail{Drawing::Kind::Trail, 1, {}, {}, {}, {0.5}, {"bob"}};
  for (int i = 0; i < frames; ++i) {
    const double t = duration * i / (frames - 1), x = 0.4 * std::cos(2 * t), angle = 0.9 * std::cos(3.1 * t);
    const double bob_x = x + 0.8 * std::sin(angle), bob_y = -0.8 * std::cos(angle);
    drawing.times.push_back(t);
    wall.positions.insert(wall.positions.end(), {-1.2, 0, x - 0.2, 0});
    box.positions.insert(box.positions.end(), {x, 0});
    box.sizes.insert(box.sizes.end(), {0.4, 0.2});
    rod.positions.insert(rod.positions.end(), {x, 0, bob_x, bob_y});
    disc.positions.insert(disc.positions.end(), {i < 200 ? 0.9 : std::numeric_limits<double>::quiet_NaN(), 0.3});
    disc.sizes.push_back(0.1);
    trail.positions.insert(trail.positions.end(), {bob_x, bob_y});
  }
  drawing.elements = {trail, wall, box, rod, disc};
  return drawing;
}

Drawing space_drawing() {
  Drawing drawing;
  drawing.dimension = 3;
  drawing.gravity = {0, 0, -9.81};
  Drawing::Element rod{Drawing::Kind::Line, 2, {}, {}, {}, {0, 1}, {"O", "bob"}};
  Drawing::Element trail{Drawing::Kind::Trail, 1, {}, {}, {}, {1}, {"bob"}};
  for (int i = 0; i < frames; ++i) {
    const double t = duration * i / (frames - 1), tilt = 0.8 + 0.3 * std::sin(5 * t), turn = 1.7 * t;
    const double x = std::sin(tilt) * std::cos(turn), y = std::sin(tilt) * std::sin(turn), z = -std::cos(tilt);
    drawing.times.push_back(t);
    rod.positions.insert(rod.positions.end(), {0, 0, 0, x, y, z});
    trail.positions.insert(trail.positions.end(), {x, y, z});
  }
  drawing.elements = {trail, rod};
  return drawing;
}

Trajectory trajectory() {
  Trajectory result;
  result.columns = {{"x", "m"}, {"θ", "rad"}, {"x'", "m/s"}, {"θ'", "rad/s"}, {"energy drift", "J"}};
  for (int i = 0; i < frames; ++i) {
    const double t = duration * i / (frames - 1);
    result.times.push_back(t);
    for (const double value : {0.4 * std::cos(2 * t), 0.9 * std::cos(3.1 * t), -0.8 * std::sin(2 * t),
                               -2.79 * std::sin(3.1 * t), 4e-15 * std::sin(40 * t * t)})
      result.values.push_back(value);
  }
  return result;
}

PlotOptions plot_of(std::vector<std::string> columns, std::string against = {}) {
  PlotOptions options;
  options.columns = std::move(columns);
  options.against = std::move(against);
  options.width = 440;
  return options;
}

ReportContent::Formula equation_of_cart() {
  const std::string plus = "<mo>+</mo>", minus = "<mo>−</mo>", theta = symbol("θ");
  const std::string term = symbol("m") + symbol("l") + "<mi>cos</mi><mo>&#x2061;</mo>" + theta + symbol("θ", "", "¨");
  const std::string square = symbol("m") + symbol("l") + "<mi>sin</mi><mo>&#x2061;</mo>" + theta + "<msup>" + symbol("θ", "", "˙") + "<mn>2</mn></msup>";
  return {"<mrow><mo>(</mo>" + symbol("M") + plus + symbol("m") + "<mo>)</mo>" + symbol("x", "", "¨") + plus + term + minus + square +
              plus + symbol("b") + symbol("x", "", "˙") + plus + symbol("k") + symbol("x") + minus + symbol("F", "0") +
              "<mi>cos</mi><mo>&#x2061;</mo>" + symbol("ω") + symbol("t") + "</mrow>",
          "<mn>0</mn>", "Euler-Lagrange", ""};
}

ReportContent content(bool space) {
  ReportContent c;
  c.name = "cart_pendulum";
  c.title = space ? "Spherical pendulum <3-D> & friends" : "Driven cart with friction";
  c.source = "A textbook, 3rd edition, §4.2";
  c.file = "cart_pendulum.lag";
  c.model_text = "system cart_pendulum \"Driven cart # 1\"\nparam M = 2 kg, m = 500 g   # </script><b>masses</b>\ncoord x : length, θ : angle\n";
  c.summary = {{"freedoms", "2"}, {"space", space ? "three dimensions" : "two dimensions"}};
  c.messages = {{Severity::Warning, "W0408", "the start is off by 2e-3 m", "The rod is longer.", "Take `l = 0.8 m`.", 2, "param M = 2 kg"}};
  c.drawing = space ? space_drawing() : plane_drawing();
  c.coordinates = {{symbol("x"), symbol("x", "", "˙"), "length in m", "0.4 m", "0 m/s"}, {symbol("θ"), symbol("θ", "", "˙"), "angle in rad", "0.9 rad", "0 rad/s"}};
  c.parameters = {{symbol("M"), "2", "kg", ""}, {symbol("m"), "500", "g", "0.5 kg"}, {symbol("b"), "0.4", "N s/m", ""}};
  c.equations = {equation_of_cart(), equation_of_cart()};
  c.energies = {{symbol("T"), "<mfrac><mn>1</mn><mn>2</mn></mfrac>" + symbol("M") + "<msup>" + symbol("x", "", "˙") + "<mn>2</mn></msup>", "", ""}};
  c.derivation = {{"Coordinates", {{"", "", "choice of generalized coordinates", "2 generalized coordinates: x and θ."}}},
                  {"Equation of x", {{"<mfrac><mrow><mo>∂</mo><mi>L</mi></mrow><mrow><mo>∂</mo>" + symbol("x", "", "˙") + "</mrow></mfrac>", symbol("M") + symbol("x", "", "˙"), "partial derivative", ""},
                                     equation_of_cart()}}};
  c.certified = true;
  c.certificate = {{"jet_residual", "M q̈ + h equals the residual obtained by jets of L.", "zero", true, true, 6, 3e-17},
                   {"dalembert", "d'Alembert's principle gives the same equations.", "no points", true, false, 0, 1}};
  c.conserved = {{"The energy function is conserved.", {symbol("h"), symbol("T") + "<mo>+</mo>" + symbol("V"), "", ""}, "1.25 J", "3.2e-15"}};
  c.statistics = {{"steps", "96"}, {"energy drift", "3.2e-15"}};
  c.expectations = {{4, "expect θ at 1 s = 0.5 rad ± 1e-9", false, true, "0.5 rad", "", "", "", ""}};
  c.trajectory = trajectory();
  c.pictures = {{"Coordinates", plot_of({"x", "θ"})}, {"Velocities", plot_of({"x'", "θ'"})}, {"Energy drift", plot_of({"energy drift"})}, {"Phase portrait", plot_of({"θ'"}, "θ")}};
  return c;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const std::string problem = write_file(arguments[2], report_html(content(arguments[1] == std::string("space"))));
  if (problem.empty()) return 0;
  std::fprintf(stderr, "%s\n", problem.c_str());
  return 1;
}
