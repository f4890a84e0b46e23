// What is seen: projections against closed forms, what hides what, and that wheels are seen to roll.
#include <maupertuis/drawing.hpp>

#include "../model_text.hpp"

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A run that a function of time prescribes: coordinate i is q(i, t).
template <class Q>
Trajectory prescribed(const MechanicalSystem& system, double duration, Q q) {
  Trajectory run;
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name, ""});
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name + "'", ""});
  constexpr int rows = 801;
  for (int r = 0; r < rows; ++r) {
    const double t = duration * r / (rows - 1), h = 1e-6;
    run.times.push_back(t);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) run.values.push_back(q(i, t));
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      run.values.push_back((q(i, t + h) - q(i, t - h)) / (2 * h));
  }
  return run;
}

/// Tilted by θ about the x axis; a wheel of radius r.
const char* const tilted =
    "system s\nparam r = 2 m, I = 1 kg m^2\ncoord θ : angle\n"
    "body w inertia diag(I, I, I) at (0, 0, 0) rotation axis (1, 0, 0) angle θ\nrun 1 s\n";

Drawing tilted_drawing(const std::string& draw, double angle) {
  const ModelText m(std::string(tilted) + draw + "\n");
  const auto drawing = evaluate_drawing(m.model, prescribed(*m.system, 1, [&](std::size_t, double) { return angle; }));
  REQUIRE(drawing);
  return *drawing;
}

FrameOptions from_above() {
  FrameOptions o;
  o.camera = {-pi / 2, pi / 2, false};  // the eye on the z axis, x to the right
  o.furniture = false;
  return o;
}

struct Box {
  double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
  explicit Box(const std::vector<double>& points) {
    for (std::size_t i = 0; i < points.size(); i += 2) {
      left = std::min(left, points[i]), right = std::max(right, points[i]);
      top = std::min(top, points[i + 1]), bottom = std::max(bottom, points[i + 1]);
    }
  }
};

}  // namespace

TEST_CASE("a hoop that is tilted is seen as the ellipse that perspective makes of it") {
  for (const double angle : {0.0, 0.4, 1.1}) {
    const Drawing drawing = tilted_drawing("draw hoop w r", angle);
    const FrameOptions options = from_above();
    const View view(drawing, options);
    const auto items = frame_items(drawing, view, 0.5, options);
    REQUIRE(items.size() == 1);
    const Box box(items[0].points);
    const double r = 2 * view.scale(), away = 6 * drawing.radius, k = 2 * std::sin(angle) / away;
    CHECK(box.right - box.left == doctest::Approx(2 * r / std::sqrt(1 - k * k)).epsilon(2e-3));  // of 72 corners
    CHECK(box.bottom - box.top == doctest::Approx(2 * r * std::cos(angle) / (1 - k * k)).epsilon(2e-3));
    // All corners lie on that ellipse.
    const double a = r / std::sqrt(1 - k * k), b = r * std::cos(angle) / (1 - k * k),
                 y0 = 240 - r * std::cos(angle) * k / (1 - k * k);
    for (std::size_t i = 0; i < items[0].points.size(); i += 2) {
      const double x = (items[0].points[i] - 360) / a, y = (items[0].points[i + 1] - y0) / b;
      CHECK(x * x + y * y == doctest::Approx(1).epsilon(1e-9));
    }
  }
}

TEST_CASE("a ball is seen as the circle in which the rays of the eye touch it") {
  const Drawing drawing = tilted_drawing("draw circle w r", 0.3);
  const FrameOptions options = from_above();
  const View view(drawing, options);
  const auto items = frame_items(drawing, view, 0.5, options);
  REQUIRE(items.size() == 4);  // the outline and the half of three great circles
  const double away = 6 * drawing.radius, seen = view.scale() * 2 * away / std::sqrt(away * away - 4);
  for (std::size_t i = 0; i < items[0].points.size(); i += 2)
    CHECK(std::hypot(items[0].points[i] - 360, items[0].points[i + 1] - 240) == doctest::Approx(seen).epsilon(1e-9));
  for (std::size_t k = 1; k < 4; ++k) {
    CHECK(items[k].points.size() == 50);
    for (std::size_t i = 0; i < items[k].points.size(); i += 2)
      CHECK(std::hypot(items[k].points[i] - 360, items[k].points[i + 1] - 240) <= seen + 1e-6);
  }
}

TEST_CASE("a body is drawn as the ellipsoid of its inertia where nothing is said") {
  const ModelText m(
      "system s\nparam m = 2 kg\ncoord φ : angle\nbody b mass m inertia diag(1 [kg m^2], 1 [kg m^2], 1.6 [kg m^2]) at "
      "(0, 0, 0) "
      "rotation axis (0, 0, 1) angle φ\nrun 1 s\n");
  const auto drawing = evaluate_drawing(m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return t; }));
  REQUIRE(drawing);
  const auto solid = std::find_if(drawing->elements.begin(), drawing->elements.end(),
                                  [](const auto& e) { return e.kind == Drawing::Kind::Solid; });
  REQUIRE(solid != drawing->elements.end());
  CHECK(solid->shape.ball);
  const double* pose = solid->positions.data();
  const auto reach = [&](int a) {
    return std::hypot(pose[3 * a] - pose[0], pose[3 * a + 1] - pose[1], pose[3 * a + 2] - pose[2]);
  };
  CHECK(reach(1) == doctest::Approx(std::sqrt(2.5 * 1.6 / 2)));  // a² = 5 (I2 + I3 − I1)/(2 m)
  CHECK(reach(3) == doctest::Approx(std::sqrt(2.5 * 0.4 / 2)));
}

TEST_CASE("of a cuboid three faces are seen at most, and of a plate one") {
  const Drawing cuboid = tilted_drawing("draw box w 2 m by 1 m by 50 cm", 0.7);
  FrameOptions options;
  const View view(cuboid, options);
  const auto items = frame_items(cuboid, view, 0, options);
  CHECK(items.size() == 3);
  const Drawing plate = tilted_drawing("draw box w 2 m by 1 m", 0.7);
  CHECK(frame_items(plate, View(plate, options), 0, options).size() == 1);
}

TEST_CASE("a rolling wheel has six spokes, which turn by the way it rolls") {
  const ModelText m(
      "system s\nparam m = 1 kg, R = 20 cm\ncoord x : length\nbody wheel mass m inertia m R^2/2 at (x, R) rotation "
      "angle -x/R\n"
      "gravity (0, -9.81 [m/s^2])\nrun 2 s\ndraw disc wheel R, ground at (0, 0)\n");
  const auto drawing =
      evaluate_drawing(m.model, prescribed(*m.system, 2, [](std::size_t, double t) { return 0.3 * t; }));
  REQUIRE(drawing);
  const FrameOptions options;
  const View view(*drawing, options);
  const auto spokes = [&](double t) {
    std::vector<double> angles;
    for (const FrameItem& item : frame_items(*drawing, view, t, options))
      if (item.points.size() == 4 && std::hypot(item.points[2] - item.points[0], item.points[3] - item.points[1]) ==
                                         doctest::Approx(0.2 * view.scale()).epsilon(1e-6))
        angles.push_back(std::atan2(item.points[1] - item.points[3], item.points[2] - item.points[0]));
    return angles;
  };
  const auto before = spokes(0.5), after = spokes(1.1);
  REQUIRE(before.size() == 6);
  REQUIRE(after.size() == 6);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(std::remainder(after[i] - before[i] + 0.3 * 0.6 / 0.2, 2 * pi) == doctest::Approx(0).epsilon(1e-6));
  // It stands on the ground: the lowest point of the rim is on the line.
  double lowest = 0, line = 0;
  for (const FrameItem& item : frame_items(*drawing, view, 0.5, options)) {
    if (item.closed && item.points.size() == 144) lowest = Box(item.points).bottom;
    if (item.points.size() == 4 && item.points[1] == item.points[3] && std::abs(item.points[2] - item.points[0]) > 200)
      line = item.points[1];
  }
  CHECK(lowest == doctest::Approx(line).epsilon(1e-3));
}

TEST_CASE("a wheel that does not turn about its axis has no spokes") {
  const ModelText m(
      "system s\nparam R = 1 m\ncoord φ : angle\nframe ring at (0, 0, 0) rotation axis (0, 0, 1) angle φ\n"
      "point P mass 1 [kg] at R (cos φ, sin φ, 0)\nrun 1 s\ndraw hoop ring R axis (0, 1, 0)\n");
  const auto run = prescribed(*m.system, 1, [](std::size_t, double t) { return 3 * t; });
  const auto drawing = evaluate_drawing(m.model, run);
  REQUIRE(drawing);
  CHECK(drawing->elements[0].shape.lines.size() == 1);
  const ModelText spun(
      "system s\nparam R = 1 m\ncoord φ : angle\nframe ring at (0, 0, 0) rotation axis (0, 1, 0) angle φ\n"
      "point P mass 1 [kg] at R (cos φ, sin φ, 0)\nrun 1 s\ndraw hoop ring R axis (0, 1, 0)\n");
  CHECK(evaluate_drawing(spun.model, run)->elements[0].shape.lines.size() == 7);
}

TEST_CASE("near things are painted over far ones; a plate lies under what stands on the side of the eye") {
  const ModelText m(
      "system s\nparam R = 1 m\ncoord φ : angle\npoint A mass 1 [kg] at R (cos φ, sin φ, 0)\npoint B mass 1 [kg] at -R "
      "(cos φ, sin φ, 0)\n"
      "run 1 s\ndraw circle A 30 cm, circle B 30 cm\n");
  const auto drawing =
      evaluate_drawing(m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return 2 * pi * t; }));
  REQUIRE(drawing);
  FrameOptions options;
  options.camera = {0, 0.1, false};  // the eye on the x axis: A is near at first, far half a turn later
  const View view(*drawing, options);
  CHECK(frame_items(*drawing, view, 0, options).front().id > frame_items(*drawing, view, 0, options).back().id);
  CHECK(frame_items(*drawing, view, 0.5, options).front().id < frame_items(*drawing, view, 0.5, options).back().id);

  const ModelText table(
      "system s\nparam R = 1 m\ncoord φ : angle\nframe top at (0, 0, 0) rotation axis (0, 0, 1) angle φ\n"
      "point A mass 1 [kg] at (-R/2, 0, 10 [cm])\npoint C mass 1 [kg] at R (cos φ, sin φ, 0)\nrun 1 s\ndraw circle A "
      "10 cm, disc top R\n");
  const auto laid =
      evaluate_drawing(table.model, prescribed(*table.system, 1, [](std::size_t, double t) { return t; }));
  REQUIRE(laid);
  const auto items = frame_items(*laid, View(*laid, options), 0, options);
  CHECK(items.back().id < 4096);  // the ball, of the first element, though it is farther than the middle of the table
}

TEST_CASE("the area of a bob follows its mass, and no bob swallows its rod") {
  const ModelText m(
      "system s\nparam l = 1 m\ncoord a, b : angle\npoint A mass 4 [kg] at l (sin a, -cos a)\npoint B mass 1 [kg] at A "
      "+ l (sin b, -cos b)\n"
      "gravity (0, -9.81 [m/s^2])\nrun 1 s\ndraw O - A - B\n");
  const auto run = prescribed(*m.system, 1, [](std::size_t i, double t) { return i == 0 ? t : -t; });
  const auto drawing = evaluate_drawing(m.model, run);
  REQUIRE(drawing);
  const auto& e = drawing->elements.back();
  REQUIRE(e.radii.size() == 3);
  CHECK(e.radii[1] * e.radii[1] / (e.radii[2] * e.radii[2]) == doctest::Approx(4));
  CHECK(e.radii[0] < e.radii[2]);
  for (const double r : e.radii) CHECK(r <= 0.3);
  const ModelText close(
      "system s\nparam l = 1 m, d = 1 cm\ncoord a, b : angle\npoint A mass 4 [kg] at l (sin a, -cos a)\n"
      "point B mass 1 [kg] at A + d (sin b, -cos b)\ngravity (0, -9.81 [m/s^2])\nrun 1 s\ndraw O - A - B\n");
  const Drawing near_each_other = evaluate_drawing(close.model, run).value();
  for (const double r : near_each_other.elements.back().radii) CHECK(r <= 0.003 + 1e-12);
}

TEST_CASE("springs and dampers are drawn by themselves, once, and stand on something") {
  const std::string model =
      "system s\nparam m = 1 kg, k = 10 N/m, c = 1 N s/m, a = 1 m\ncoord x : length\npoint P mass m at (x, 0)\n"
      "spring (-a, 0) - P stiffness k length a\ndamper (-a, -a/4) - P coefficient c\nrun 1 s\n";
  const auto solids = [&](const std::string& draw) {
    const ModelText m(model + draw);
    const auto drawing = evaluate_drawing(
        m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return 0.3 * std::sin(6 * t); }));
    REQUIRE(drawing);
    return std::count_if(drawing->elements.begin(), drawing->elements.end(),
                         [](const auto& e) { return e.kind == Drawing::Kind::Solid; });
  };
  CHECK(solids("") == 5);  // the coil, cup and plate, two anchors
  CHECK(solids("draw trail P\n") == 5);
  CHECK(solids("draw spring (-a, 0) - P\n") == 5);  // not a second time
  CHECK(solids("draw P - (-a, 0)\n") ==
        4);  // the line stands for the spring: its pivot, and the dashpot with its anchor
}

TEST_CASE("a spring and a damper between the same ends stand to either side of their line, whichever way each goes") {
  for (const char* damper : {"damper O - P coefficient c", "damper P - O coefficient c"}) {
    const ModelText m(
        std::string("system s\nparam m = 1 kg, k = 10 N/m, c = 1 N s/m\ncoord x : length\npoint P mass m at (x, "
                    "0)\nspring O - P stiffness k length 1 m\n") +
        damper + "\nrun 1 s\n");
    const auto drawing = evaluate_drawing(
        m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return 1 + 0.3 * std::sin(6 * t); }));
    REQUIRE(drawing);
    std::vector<double> heights;  // of the first end of the coil, of the cup, of the plate
    for (const auto& e : drawing->elements)
      if (e.kind == Drawing::Kind::Solid && e.positions[1] != 0) heights.push_back(e.positions[1]);
    REQUIRE(heights.size() == 3);
    CHECK(heights[0] > 0.01);
    CHECK(heights[1] < -0.01);
    CHECK(heights[2] == doctest::Approx(heights[1]));
  }
}

TEST_CASE("rods are found where a distance is kept, and nowhere else") {
  const auto rods = [](const std::string& text, auto q) {
    const ModelText m(text);
    const auto drawing = evaluate_drawing(m.model, prescribed(*m.system, 1, q));
    REQUIRE(drawing);
    return std::count_if(drawing->elements.begin(), drawing->elements.end(),
                         [](const auto& e) { return e.kind == Drawing::Kind::Path && e.points == 2; });
  };
  const auto circle = [](std::size_t i, double t) { return i == 0 ? std::sin(t) : -std::cos(t); };
  CHECK(rods("system s\nparam l = 1 m, m = 1 kg\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\nrun 1 s\n",
             [](std::size_t, double t) { return t; }) == 1);
  // On a circle by chance: no rod. On a circle by a constraint: a rod.
  CHECK(rods("system s\nparam l = 1 m, m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nrun 1 s\n", circle) ==
        0);
  CHECK(rods("system s\nparam l = 1 m, m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint x^2 + y^2 = "
             "l^2\nrun 1 s\n",
             circle) == 1);
}

TEST_CASE("a camera that follows keeps its point in place, and sees no more than it needs") {
  const std::string model =
      "system s\nparam m = 1 kg, R = 20 cm\ncoord x : length\nbody wheel mass m inertia m R^2/2 at (x, R) rotation "
      "angle -x/R\nrun 2 s\n";
  const auto run = [](std::size_t, double t) { return 30 * t; };
  const ModelText still(model + "draw disc wheel R\n"), going(model + "draw disc wheel R, follow wheel\n");
  const auto a = evaluate_drawing(still.model, prescribed(*still.system, 2, run)),
             b = evaluate_drawing(going.model, prescribed(*going.system, 2, run));
  REQUIRE(a);
  REQUIRE(b);
  CHECK(a->high[0] - a->low[0] > 60);
  CHECK(b->high[0] - b->low[0] < 1);
  const FrameOptions options;
  const View view(*b, options);
  const auto middle = [&](double t) {
    const Box box(frame_items(*b, view, t, options)[0].points);
    return (box.left + box.right) / 2;
  };
  CHECK(middle(0.2) == doctest::Approx(middle(1.7)).epsilon(1e-6));
}

TEST_CASE("labels stand at their points, with the name as it is set or the words that are given") {
  const ModelText m(
      "system s\nparam m = 1 kg\ncoord x : length\npoint P1 mass m at (x, 0)\nrun 1 s\ndraw label P1, label P1 \"a & "
      "b\"\n");
  const auto drawing = evaluate_drawing(m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return t; }));
  REQUIRE(drawing);
  const std::string svg = frame_svg(*drawing, 0, {});
  CHECK(svg.find("<tspan font-style=\"italic\">P</tspan><tspan dy=") != std::string::npos);
  CHECK(svg.find("a &amp; b") != std::string::npos);
}

TEST_CASE("light and dark, and the size that is asked for") {
  const Drawing drawing = tilted_drawing("draw hoop w r", 0.5);
  FrameOptions options;
  options.width = 400;
  options.height = 300;
  CHECK(frame_svg(drawing, 0, options).find("viewBox=\"0 0 400 300\"") != std::string::npos);
  CHECK(frame_svg(drawing, 0, options).find("fill=\"#ffffff\"") != std::string::npos);
  options.theme = PlotTheme::Dark;
  CHECK(frame_svg(drawing, 0, options).find("fill=\"#16181d\"") != std::string::npos);
  CHECK(frame_svg(drawing, 0, options).find("#ffffff") == std::string::npos);
}

TEST_CASE("an animated picture has a value for each frame; things that pass each other are pages that turn") {
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const ModelText plane(
      "system s\nparam m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\nrun 1 s\ndraw circle P 10 cm\n");
  const auto flat =
      evaluate_drawing(plane.model, prescribed(*plane.system, 1, [](std::size_t, double t) { return t; }));
  REQUIRE(flat);
  FrameOptions options;
  options.trail = TrailLength::None;
  Playback playback{{0, 0.25, 0.5, 0.75, 1}, 2, true};
  const std::string moving = animated_svg(*flat, playback, options);
  const std::size_t at = moving.find("attributeName=\"d\"");
  REQUIRE(at != std::string::npos);
  const std::string values = moving.substr(at, moving.find("/>", at) - at);
  CHECK(count(values, ";") == 4);
  CHECK(count(moving, "dur=\"2s\"") == count(moving, "<animate "));
  CHECK(count(moving, "repeatCount=\"indefinite\"") == count(moving, "<animate "));
  playback.loop = false;
  CHECK(count(animated_svg(*flat, playback, options), "repeatCount") == 0);

  const ModelText space(
      "system s\nparam R = 1 m\ncoord φ : angle\npoint A mass 1 [kg] at R (cos φ, sin φ, 0)\npoint B mass 1 [kg] at -R "
      "(cos φ, sin φ, 0)\n"
      "run 1 s\ndraw circle A 30 cm, circle B 30 cm\n");
  const auto passing =
      evaluate_drawing(space.model, prescribed(*space.system, 1, [](std::size_t, double t) { return 2 * pi * t; }));
  REQUIRE(passing);
  CHECK(count(animated_svg(*passing, playback, options), "<g visibility") == 5);
}

TEST_CASE("positions without a value leave their element out, and the rest stays") {
  const ModelText m(
      "system s\nparam m = 1 kg, a = 1 m\ncoord x : length\npoint P mass m at (x, 0)\npoint Q at (0, sqrt(a^2 - "
      "x^2))\nrun 1 s\ndraw circle P 10 cm, circle Q 10 cm\n");
  const auto drawing = evaluate_drawing(m.model, prescribed(*m.system, 1, [](std::size_t, double t) { return 2 * t; }));
  REQUIRE(drawing);
  const FrameOptions options;
  const View view(*drawing, options);
  CHECK(frame_items(*drawing, view, 0.2, options).size() == 2);
  CHECK(frame_items(*drawing, view, 0.9, options).size() == 1);
  CHECK(std::isfinite(view.scale()));
}

TEST_CASE("a motion that swings faster than its frames is shown at them, and nothing is made up between") {
  const ModelText m("param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\nrun 1 s\n");
  const auto swings = [&](double periods, std::size_t frames) {
    const auto drawing = evaluate_drawing(
        m.model, prescribed(*m.system, 1, [&](std::size_t, double t) { return std::cos(2 * pi * periods * t); }),
        frames);
    REQUIRE(drawing);
    return drawing->moments_only;
  };
  CHECK_FALSE(swings(100, 801));  // eight rows in a period
  CHECK(swings(100, 400));
  CHECK(swings(300, 801));
  CHECK_FALSE(swings(30, 200));
  CHECK_FALSE(swings(0, 10));
}

TEST_CASE("frames follow a motion where about five of them fall on a swing") {
  const ModelText m("param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\nrun 1 s\n");
  const Trajectory run = prescribed(*m.system, 1, [](std::size_t, double t) { return std::cos(2 * pi * 100 * t); });
  const auto follow = [&](double frames_in_a_period) {
    std::vector<double> moments;
    for (double t = 0; t < 0.2; t += 0.01 / frames_in_a_period) moments.push_back(t);
    return frames_follow(m.model, run, moments);
  };
  CHECK(follow(8));
  CHECK_FALSE(follow(3));
  CHECK_FALSE(follow(1.05));
}
