// For the tests of the page: `report_browser_page plane|space FILE` writes a report of made-up numbers,
// `report_browser_page scene-plane|scene-space FILE` a drawing with some of its frames, as JSON.
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace maupertuis;

namespace {

constexpr int frames = 401;
constexpr double duration = 8;

using layouts::name, layouts::number, layouts::power, layouts::product, layouts::sum, layouts::words;

/// "x", "θ" with two dots, …
Layout symbol(const std::string& letter, int dots = 0) { return name(letter, dots); }

/// A model's drawing along a run that formulas prescribe.
template <class Q>
Drawing drawn(const char* text, Q q) {
  Diagnostics diagnostics;
  const SourceText source("page.lag", text);
  const auto model = elaborate(syntax::parse(source, diagnostics), source, diagnostics);
  if (!model) std::fputs(render(diagnostics, source).c_str(), stderr), std::exit(1);
  Trajectory run;
  const auto& coordinates = model->system.coordinates;
  for (const char* dash : {"", "'"})
    for (const Coordinate& c : coordinates) run.columns.push_back({c.name + dash, ""});
  const auto& contacts = model->system.contacts;
  std::vector<ContactImpulse> impulses;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    run.columns.push_back({"reaction(" + contacts[c].name + ")", "N"});
    impulses.push_back({c, 0.15 * duration, 1});  // seen at 1.234 s
  }
  for (int i = 0; i < frames; ++i) {
    const double t = duration * i / (frames - 1), h = 1e-6;
    run.times.push_back(t);
    for (std::size_t k = 0; k < coordinates.size(); ++k) run.values.push_back(q(k, t));
    for (std::size_t k = 0; k < coordinates.size(); ++k) run.values.push_back((q(k, t + h) - q(k, t - h)) / (2 * h));
    for (std::size_t c = 0; c < contacts.size(); ++c) run.values.push_back(std::max(0.0, std::sin(t)));
  }
  const auto system = std::make_shared<const MechanicalSystem>(model->system);
  const auto equations = euler_lagrange(system, diagnostics);
  return evaluate_drawing(*model, run, 6000, equations ? &*equations : nullptr, impulses).value();
}

// A cart on a rail with a pendulum, a spring and a dashpot to the wall, a box, a wheel and a label; a table that
// moves and presses on the bob; and a point that is lost at the end.
Drawing plane_drawing() {
  return drawn(
      "system plane\nparam m = 1 kg, k = 3 N/m, c = 1 N s/m, l = 80 cm, w = 1.2 m, R = 10 cm, T0 = 6 s\ncoord x : "
      "length, θ : angle\n"
      "point cart mass 4 m at (x, 0)\npoint bob mass m at cart + l (sin θ, -cos θ)\nframe wheel at (x, R) rotation "
      "angle -x/R\n"
      "point lost at (w sqrt(1 - t/T0), 3 R)\nspring (-w, 0) - cart stiffness k length w\ndamper (-w, -R) - cart "
      "coefficient c\n"
      "gravity (0, -9.81 [m/s^2])\ncontact bob.y >= -l - w/4 + R sin(t/T0) name table\nrun 8 s\n"
      "draw trail bob, box cart 0.4 m by 0.2 m, cart - bob, hoop wheel R, circle lost R, label bob, wall at (-w, 0), "
      "ground at (0, -R)\n",
      [](std::size_t k, double t) { return k == 0 ? 0.4 * std::cos(2 * t) : 0.9 * std::cos(3.1 * t); });
}

// Everything that space has: rods, a ball that turns, a box, a disc that rolls its spokes, a hoop that follows an axis,
// a spring, the floor.
Drawing space_drawing() {
  return drawn(
      "system space\nparam m = 1 kg, k = 3 N/m, l = 1 m, I = 1 kg m^2, r = 20 cm\ncoord θ, φ : angle\n"
      "point bob mass m at l (sin θ cos φ, sin θ sin φ, -cos θ)\nbody ball mass m inertia diag(I, I, I) at (l/2, l/2, "
      "0) rotation euler zxz (φ, θ, 3 φ)\n"
      "frame wheel at (-l/2, l/2, -l/2) rotation axis (0, 1, 0) angle 4 φ\nframe crate at (-l/2, -l/2, 0) rotation "
      "axis (1, 0, 0) angle φ\n"
      "spring (0, 0, l) - ball stiffness k\ngravity (0, 0, -9.81 [m/s^2])\nrun 8 s\n"
      "draw trail bob, O - bob, ellipsoid ball r by 2 r by r/2, disc wheel 2 r axis (0, 1, 0), box crate r by 2 r by 3 "
      "r,\n"
      "    hoop O r axis (sin θ cos φ, sin θ sin φ, cos θ), label bob \"B\"\n",
      [](std::size_t k, double t) { return k == 0 ? 0.8 + 0.3 * std::sin(5 * t) : 1.7 * t; });
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
  const Layout coupling = product({symbol("m"), symbol("l"), words("cos"), symbol("θ"), symbol("θ", 2)});
  const Layout centrifugal =
      product({symbol("m"), symbol("l"), words("sin"), symbol("θ"), power(symbol("θ", 1), number("2"))});
  return {sum({product({sum({symbol("M"), symbol("m")}), symbol("x", 2)}), coupling, centrifugal,
               product({symbol("b"), symbol("x", 1)}), product({symbol("k"), symbol("x")}),
               product({symbol("F_0"), words("cos"), symbol("ω"), symbol("t")})}),
          number("0"), "Euler-Lagrange", ""};
}

ReportContent content(bool space) {
  ReportContent c;
  c.name = "cart_pendulum";
  c.title = space ? "Spherical pendulum <3-D> & friends" : "Driven cart with friction";
  c.source = "A textbook, 3rd edition, §4.2";
  c.file = "cart_pendulum.lag";
  c.model_text =
      "system cart_pendulum \"Driven cart # 1\"\nparam M = 2 kg, m = 500 g   # </script><b>masses</b>\ncoord x : "
      "length, θ : angle\n";
  c.summary = {{"freedoms", "2"}, {"space", space ? "three dimensions" : "two dimensions"}};
  c.messages = {{Severity::Warning, "W0408", "the start is off by 2e-3 m", "The rod is longer.", "Take `l = 0.8 m`.", 2,
                 "param M = 2 kg"}};
  c.drawing = space ? space_drawing() : plane_drawing();
  c.coordinates = {{symbol("x"), symbol("x", 1), "", "length in m", "0.4 m", "0 m/s"},
                   {symbol("θ"), symbol("θ", 1), "", "angle in rad", "0.9 rad", "0 rad/s"}};
  c.parameters = {{symbol("M"), "2", "kg", ""}, {symbol("m"), "500", "g", "0.5 kg"}, {symbol("b"), "0.4", "N s/m", ""}};
  c.equations = {equation_of_cart(), equation_of_cart()};
  c.energies = {{symbol("T"), product({number("1/2"), symbol("M"), power(symbol("x", 1), number("2"))}), "", ""}};
  c.derivation = {
      {"Coordinates", {{{}, {}, "choice of generalized coordinates", "2 generalized coordinates: x and θ."}}},
      {"Equation of x",
       {{layouts::partial(symbol("L"), symbol("x", 1)), product({symbol("M"), symbol("x", 1)}), "partial derivative",
         ""},
        equation_of_cart()}}};
  c.certified = true;
  c.certificate = {{"jet_residual", "M q̈ + h equals the residual obtained by jets of L.", "zero", true, true, 6, 3e-17},
                   {"dalembert", "d'Alembert's principle gives the same equations.", "no points", true, false, 0, 1}};
  c.conserved = {{"The energy function is conserved.",
                  {symbol("h"), sum({symbol("T"), symbol("V")}), "", ""},
                  "1.25 J",
                  "3.2e-15"}};
  c.statistics = {{"steps", "96"}, {"energy drift", "3.2e-15"}};
  c.expectations = {{4, "expect θ at 1 s = 0.5 rad ± 1e-9", false, true, "0.5 rad", "", "", "", false, "", "", ""}};
  c.trajectory = trajectory();
  c.pictures = {{"Coordinates", plot_of({"x", "θ"})},
                {"Velocities", plot_of({"x'", "θ'"})},
                {"Energy drift", plot_of({"energy drift"})},
                {"Phase portrait", plot_of({"θ'"}, "θ")}};
  return c;
}

std::string numbers(const std::vector<double>& list) {
  std::string out = "[";
  char text[32];
  for (const double x : list) std::snprintf(text, sizeof text, "%s%.9g", out.size() > 1 ? "," : "", x), out += text;
  return out + "]";
}

/// The drawing, and its strokes at some moments from the standard view of the page.
std::string scene(const Drawing& drawing) {
  FrameOptions options;
  options.width = 640;
  options.height = 420;
  options.camera.fitted = false;
  const View view(drawing, options);
  std::string out = "{\"scene\":" + drawing_json(drawing) + ",\"width\":640,\"height\":420,\"moments\":[";
  for (const double elapsed : {0.0, 1.234, 5.5, 7.9}) {
    out += (out.back() == '[' ? "{\"elapsed\":" : ",{\"elapsed\":") + std::to_string(elapsed) + ",\"items\":[";
    for (const FrameItem& item : frame_items(drawing, view, elapsed, options))
      out += (out.back() == '[' ? "{\"id\":" : ",{\"id\":") + std::to_string(item.id) +
             ",\"closed\":" + (item.closed ? "true" : "false") + ",\"width\":" + std::to_string(item.width) +
             ",\"radius\":" + std::to_string(item.radius) +
             ",\"fill\":" + std::to_string(item.fill.ink == FrameColour::Ink::None ? 0 : item.fill.strength) +
             ",\"stroke\":" + std::to_string(item.stroke.ink == FrameColour::Ink::None ? 0 : item.stroke.strength) +
             ",\"series\":" + std::to_string(item.fill.series + item.stroke.series) +
             ",\"points\":" + numbers(item.points) + "}";
    out += "]}";
  }
  return out + "]}";
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const std::string what = arguments[1];
  const std::string text = what == "scene-plane"   ? scene(plane_drawing())
                           : what == "scene-space" ? scene(space_drawing())
                                                   : report_html(content(what == "space"));
  const std::string problem = write_file(arguments[2], text);
  if (problem.empty()) return 0;
  std::fprintf(stderr, "%s\n", problem.c_str());
  return 1;
}
