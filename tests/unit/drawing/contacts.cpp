// Surfaces of contacts against the places where they are known to be, and arrows against the forces of the run.
#include <maupertuis/drawing.hpp>

#include "../model_text.hpp"

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace {

/// A run that functions of the time prescribe, with the columns of reactions.
template <class Q>
Trajectory contact_run(const MechanicalSystem& system, double duration, Q q,
                       const std::vector<std::pair<std::string, double>>& reactions = {}) {
  Trajectory run;
  for (const char* dash : {"", "'"})
    for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name + dash, ""});
  for (const auto& [name, value] : reactions) run.columns.push_back({"reaction(" + name + ")", "N"});
  constexpr int rows = 401;
  for (int r = 0; r < rows; ++r) {
    const double t = duration * r / (rows - 1), h = 1e-6;
    run.times.push_back(t);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) run.values.push_back(q(i, t));
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      run.values.push_back((q(i, t + h) - q(i, t - h)) / (2 * h));
    for (const auto& reaction : reactions) run.values.push_back(reaction.second);
  }
  return run;
}

std::vector<const Drawing::Element*> grounds(const Drawing& drawing) {
  std::vector<const Drawing::Element*> out;
  for (const auto& e : drawing.elements)
    if (e.kind == Drawing::Kind::Solid && e.shape.role == SolidShape::Role::Ground) out.push_back(&e);
  return out;
}

/// A line of a solid in the world, at a frame.
std::vector<double> world(const Drawing::Element& e, const SolidShape::Outline& line, std::size_t frame = 0) {
  const double* pose = &e.positions[e.still ? 0 : 6 * frame];
  std::vector<double> out;
  for (std::size_t i = 0; i < line.points.size(); i += 2)
    for (std::size_t k = 0; k < 2; ++k)
      out.push_back(pose[k] + line.points[i] * (pose[2 + k] - pose[k]) + line.points[i + 1] * (pose[4 + k] - pose[k]));
  return out;
}

const char* const ball =
    "system s\nparam m = 1 kg, r = 0.1 m, g = 10 m/s^2\ncoord x, z : length\n"
    "point P mass m at (x, z)\ngravity (0, -g)\n";

double bounce(std::size_t i, double t) { return i == 0 ? 0.5 * t : 0.2 + 0.8 * std::abs(std::cos(3 * t)); }

}  // namespace

TEST_CASE("a floor is drawn below the ball that touches it, hatched on its far side") {
  const ModelText m(std::string(ball) + "contact z >= 0 name floor\nrun 1 s\ndraw circle P r\n");
  const Drawing drawing = evaluate_drawing(m.model, contact_run(*m.system, 1, bounce)).value();
  const auto floors = grounds(drawing);
  REQUIRE(floors.size() == 1);
  CHECK(floors[0]->still);
  const auto line = world(*floors[0], floors[0]->shape.lines[0]);
  CHECK(line[1] == doctest::Approx(-0.1).epsilon(1e-9));
  CHECK(line[3] == doctest::Approx(-0.1).epsilon(1e-9));
  CHECK(std::min(line[0], line[2]) < -1);
  CHECK(std::max(line[0], line[2]) > 1.5);
  for (std::size_t k = 1; k < floors[0]->shape.lines.size(); ++k) {
    const auto stroke = world(*floors[0], floors[0]->shape.lines[k]);
    CHECK(stroke[3] < -0.1);
  }
  CHECK(drawing.low[1] < -0.1);
}

TEST_CASE("ground of the model that shows the floor is not drawn twice") {
  const ModelText m(std::string(ball) +
                    "contact z >= 0 name floor\nrun 1 s\ndraw circle P r, ground at (0, 0) normal (0, 1)\n");
  CHECK(grounds(evaluate_drawing(m.model, contact_run(*m.system, 1, bounce)).value()).size() == 1);
}

TEST_CASE("a ball that leaves a sphere: a closed circle, less the radius of the ball, hatched inside") {
  const ModelText m(std::string(ball) + "contact sqrt(x^2 + z^2) >= 1 [m] + r name sphere\nrun 1 s\ndraw circle P r\n");
  const auto q = [](std::size_t i, double t) { return 1.1 * (i == 0 ? std::sin(t) : std::cos(t)); };
  const Drawing drawing = evaluate_drawing(m.model, contact_run(*m.system, 1.2, q)).value();
  const auto spheres = grounds(drawing);
  REQUIRE(spheres.size() == 1);
  const auto& lines = spheres[0]->shape.lines;
  CHECK(lines[0].closed);
  REQUIRE(lines[0].points.size() > 100);
  const auto circle = world(*spheres[0], lines[0]);
  for (std::size_t i = 0; i < circle.size(); i += 2)
    CHECK(std::hypot(circle[i], circle[i + 1]) == doctest::Approx(1).epsilon(1e-7));
  CHECK(lines.size() > 20);
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto stroke = world(*spheres[0], lines[k]);
    CHECK(std::hypot(stroke[2], stroke[3]) < 0.999);
  }
  CHECK(drawing.low[1] < -1);  // all of it is seen
}

TEST_CASE("an incline in its own coordinates, and a curve that is no straight line") {
  const ModelText m(
      "system s\nparam m = 1 kg, α = 0.4 rad\ncoord s, n : length\n"
      "point P mass m at s (cos α, sin α) + n (-sin α, cos α)\n"
      "contact n >= 0 name plane\nrun 1 s\ndraw circle P 1 cm\n");
  const auto sliding = [](std::size_t i, double t) { return i == 0 ? t : 0.0; };
  const Drawing incline = evaluate_drawing(m.model, contact_run(*m.system, 1, sliding)).value();
  REQUIRE(grounds(incline).size() == 1);
  const auto line = world(*grounds(incline)[0], grounds(incline)[0]->shape.lines[0]);
  CHECK(std::abs(std::atan2(line[3] - line[1], line[2] - line[0])) == doctest::Approx(0.4).epsilon(1e-9));

  const ModelText valley(std::string(ball) + "contact z >= 0.5 [1/m] x^2 name valley\nrun 1 s\ndraw circle P 1e-9 m\n");
  const auto rolling = [](std::size_t i, double t) { return i == 0 ? t - 0.5 : 0.5 * (t - 0.5) * (t - 0.5); };
  const Drawing parabola = evaluate_drawing(valley.model, contact_run(*valley.system, 1, rolling)).value();
  REQUIRE(grounds(parabola).size() == 1);
  const auto curve = world(*grounds(parabola)[0], grounds(parabola)[0]->shape.lines[0]);
  REQUIRE(curve.size() > 40);
  for (std::size_t i = 0; i < curve.size(); i += 2)
    CHECK(curve[i + 1] == doctest::Approx(0.5 * curve[i] * curve[i]).epsilon(1e-6));
}

TEST_CASE("a table that vibrates moves, a belt goes by, a stop stands across the way of a pendulum") {
  const ModelText table(std::string(ball) +
                        "contact z >= 0.1 [m] sin(5 [rad/s] t) name table\nrun 1 s\ndraw circle P r\n");
  const Drawing moving = evaluate_drawing(table.model, contact_run(*table.system, 1, bounce)).value();
  REQUIRE(grounds(moving).size() == 1);
  const Drawing::Element& e = *grounds(moving)[0];
  CHECK_FALSE(e.still);
  for (std::size_t f = 0; f < moving.times.size(); f += 50)
    CHECK(e.positions[6 * f + 1] == doctest::Approx(0.1 * std::sin(5 * moving.times[f]) - 0.1).epsilon(1e-8));

  const ModelText belt(std::string(ball) + "contact z >= 0 friction 0.3 slip x' - 2 [m/s] name belt\nrun 1 s\n");
  const auto resting = [](std::size_t i, double t) { return i == 0 ? 0.3 * std::sin(t) : 0.0; };
  const Drawing going = evaluate_drawing(belt.model, contact_run(*belt.system, 1, resting)).value();
  REQUIRE(grounds(going).size() == 1);
  const auto& way = grounds(going)[0]->positions;
  CHECK(way[way.size() - 6] - way[0] == doctest::Approx(2).epsilon(1e-6));

  const ModelText stop(
      "system s\nparam m = 1 kg\ncoord θ : angle\npoint P mass m at (sin θ, -cos θ) * 1 [m]\n"
      "contact θ <= 0.3 [rad] name stop\nrun 1 s\ndraw O - P\n");
  const auto swing = [](std::size_t, double t) { return 0.3 - 0.5 * t; };
  const Drawing wall = evaluate_drawing(stop.model, contact_run(*stop.system, 1, swing)).value();
  const auto found = std::find_if(wall.elements.begin(), wall.elements.end(), [](const Drawing::Element& x) {
    return x.kind == Drawing::Kind::Solid && x.shape.role == SolidShape::Role::Ground && x.shape.faces.empty();
  });
  REQUIRE(found != wall.elements.end());
  const double nx = found->positions[4] - found->positions[0], ny = found->positions[5] - found->positions[1];
  CHECK(nx == doctest::Approx(-std::cos(0.3)).epsilon(1e-9));  // against the way up
  CHECK(ny == doctest::Approx(-std::sin(0.3)).epsilon(1e-9));
}

TEST_CASE("the end of a rod is found on its body; a string that a line shows is no wall; joints have no surface") {
  const ModelText rod(
      "system s\nparam m = 1 kg, l = 2 m\ncoord x, y : length, θ : angle\n"
      "body rod mass m inertia 1/12 m l^2 at (x, y) rotation angle θ\n"
      "contact y - l/2 sin θ >= 0 name floor\nrun 1 s\ndraw box rod l by 1 cm\n");
  const auto fall = [](std::size_t i, double t) { return i == 0 ? 0.0 : i == 1 ? std::sin(1 - 0.5 * t) : 1 - 0.5 * t; };
  const Drawing falling = evaluate_drawing(rod.model, contact_run(*rod.system, 1, fall)).value();
  REQUIRE(grounds(falling).size() == 1);
  CHECK(grounds(falling)[0]->positions[1] == doctest::Approx(0).epsilon(1e-9));

  const ModelText string(std::string(ball) + "contact sqrt(x^2 + z^2) <= 1 [m] name string\nrun 1 s\ndraw O - P\n");
  const auto round = [](std::size_t i, double t) { return i == 0 ? std::sin(t) : -std::cos(t); };
  const Drawing slack = evaluate_drawing(string.model, contact_run(*string.system, 1, round)).value();
  for (const Drawing::Element* e : grounds(slack)) CHECK(e->shape.faces.size() == 1);  // the pivot of O

  const ModelText joint(
      "system s\nparam m = 1 kg\ncoord θ1, θ2 : angle\n"
      "point A mass m at (sin θ1, -cos θ1) * 1 [m]\npoint B mass m at A + (sin θ2, -cos θ2) * 1 [m]\n"
      "contact θ2 - θ1 <= 0.5 [rad] name knee\nrun 1 s\ndraw O - A - B\n");
  const auto bend = [](std::size_t i, double t) { return i == 0 ? t : 1.2 * t; };
  const Drawing bent = evaluate_drawing(joint.model, contact_run(*joint.system, 1, bend)).value();
  for (const Drawing::Element* e : grounds(bent)) CHECK(e->shape.faces.size() == 1);
}

TEST_CASE("forces stand on the rim of what is pressed, along the normal; impulses shrink and are gone") {
  const ModelText m(std::string(ball) + "contact z >= 0 restitution 0.5 name floor\nrun 1 s\ndraw circle P r\n");
  const auto resting = [](std::size_t i, double t) { return i == 0 ? t : 0.0; };
  const Trajectory run = contact_run(*m.system, 1, resting, {{"floor", 10}});
  const Drawing drawing = evaluate_drawing(m.model, run, 6000, &m.equations, {{0, 0.5, 2}}).value();
  const auto arrow = [&](bool impulse) {
    return std::find_if(drawing.elements.begin(), drawing.elements.end(), [&](const Drawing::Element& e) {
      return e.kind == Drawing::Kind::Arrow && e.impulse == impulse;
    });
  };
  REQUIRE(arrow(false) != drawing.elements.end());
  REQUIRE(arrow(true) != drawing.elements.end());
  for (std::size_t f = 0; f < drawing.times.size(); ++f) {
    const double* force = &arrow(false)->positions[4 * f];
    CHECK(force[0] == doctest::Approx(drawing.times[f]));
    CHECK(force[1] == doctest::Approx(-0.1));
    CHECK(force[2] == doctest::Approx(force[0]));
    CHECK(force[3] > force[1] + 0.1);
    const double* impulse = &arrow(true)->positions[4 * f];
    const double length = impulse[3] - impulse[1], since = drawing.times[f] - 0.5;
    if (since < 0 || since > 0.1) CHECK(length == 0);
    if (since >= 0 && since < 0.01) CHECK(length > 0.05);
  }
  for (const auto& e : drawing.elements)  // the model says where: no second arrow
    CHECK((e.kind != Drawing::Kind::Arrow || e.names[0] == "floor"));
}

TEST_CASE(
    "friction tilts the force of a contact; where a gap is written in a point its normal is that of the surface") {
  const ModelText m(std::string(ball) + "contact z >= 0 friction 0.5 slip x' name floor\nrun 1 s\ndraw circle P r\n");
  const auto resting = [](std::size_t i, double t) { return i == 0 ? t : 0.0; };
  Trajectory run = contact_run(*m.system, 1, resting, {{"floor", 10}});
  run.columns.push_back({"friction(floor)", "N"});
  std::vector<double> values;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const auto begin = run.values.begin() + static_cast<std::ptrdiff_t>(row * (run.columns.size() - 1));
    values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(run.columns.size() - 1));
    values.push_back(-5);
  }
  run.values = values;
  const Drawing drawing = evaluate_drawing(m.model, run, 6000, &m.equations).value();
  const auto arrow = std::find_if(drawing.elements.begin(), drawing.elements.end(),
                                  [](const Drawing::Element& e) { return e.kind == Drawing::Kind::Arrow; });
  REQUIRE(arrow != drawing.elements.end());
  CHECK((arrow->positions[2] - arrow->positions[0]) / (arrow->positions[3] - arrow->positions[1]) ==
        doctest::Approx(-0.5));

  // The shoe of a lever on a wheel: the lever moves it aslant to the normal.
  const ModelText brake(
      "system s\nparam J = 1 kg m^2\ncoord β : angle\nframe lever at (-1 [m], 1.2 [m]) rotation angle β\n"
      "body arm inertia J at (-1 [m], 1.2 [m]) rotation angle β\n"
      "point shoe in lever at (1 [m], -0.2 [m])\n"
      "contact sqrt(shoe.x^2 + shoe.y^2) >= 1 [m] name block\nrun 1 s\ndraw (-1 [m], 1.2 [m]) - shoe\n");
  const auto held = [](std::size_t, double) { return 0.0; };
  const Drawing wheel =
      evaluate_drawing(brake.model, contact_run(*brake.system, 1, held, {{"block", 10}}), 6000, &brake.equations)
          .value();
  const auto push = std::find_if(wheel.elements.begin(), wheel.elements.end(),
                                 [](const Drawing::Element& e) { return e.kind == Drawing::Kind::Arrow; });
  REQUIRE(push != wheel.elements.end());
  CHECK(push->positions[2] == doctest::Approx(push->positions[0]));
  CHECK(push->positions[3] > push->positions[1] + 0.01);
}

TEST_CASE("two walls of one contact, the corners of a box, a hoop that moves") {
  const ModelText walls(std::string(ball) + "contact 1 [m^2] - x^2 >= 0 name walls\nrun 1 s\ndraw trail P\n");
  const auto across = [](std::size_t i, double t) { return i == 0 ? 0.99 * std::cos(6 * t) : 0.3 * t; };
  CHECK(grounds(evaluate_drawing(walls.model, contact_run(*walls.system, 1, across)).value()).size() == 2);

  const ModelText box(std::string(ball) +
                      "contact x >= 0 name left\ncontact x <= 2 [m] name right\ncontact z >= 0 name floor\n"
                      "run 1 s\ndraw circle P r\n");
  const auto inside = [](std::size_t i, double t) { return i == 0 ? 1 + std::sin(6 * t) : 0.5 * t; };
  const auto found = evaluate_drawing(box.model, contact_run(*box.system, 1, inside)).value();
  REQUIRE(grounds(found).size() == 3);
  for (const Drawing::Element* e : grounds(found)) {
    const auto line = world(*e, e->shape.lines[0]);
    if (line[1] == doctest::Approx(line[3])) {  // the floor, from wall to wall
      CHECK(std::min(line[0], line[2]) == doctest::Approx(-0.1));
      CHECK(std::max(line[0], line[2]) == doctest::Approx(2.1));
    } else  // a wall, from the floor on
      CHECK(std::min(line[1], line[3]) == doctest::Approx(-0.1));
  }

  const ModelText hoop(std::string(ball) +
                       "contact sqrt((x - 1 [m/s] t)^2 + z^2) <= 1 [m] name hoop\nrun 1 s\ndraw circle P 1e-9 m\n");
  const auto carried = [](std::size_t i, double t) { return i == 0 ? t + std::sin(t) : -std::cos(t); };
  const Drawing moving = evaluate_drawing(hoop.model, contact_run(*hoop.system, 1, carried)).value();
  REQUIRE(grounds(moving).size() == 1);
  const Drawing::Element& e = *grounds(moving)[0];
  REQUIRE_FALSE(e.still);
  for (std::size_t f = 0; f < moving.times.size(); f += 100) {
    const auto circle = world(e, e.shape.lines[0], f);
    for (std::size_t i = 0; i < circle.size(); i += 20)
      CHECK(std::hypot(circle[i] - moving.times[f], circle[i + 1]) == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("two balls that touch push each other with opposite forces") {
  const ModelText m(
      "system s\nparam m = 1 kg, r = 0.1 m\ncoord a, b : length\n"
      "point A mass m at (a, 0)\npoint B mass m at (b, 0)\n"
      "contact b - a >= 2 r name balls\nrun 1 s\ndraw circle A r, circle B r\n");
  const auto meet = [](std::size_t i, double t) { return i == 0 ? t : t + 0.2; };
  const Drawing drawing =
      evaluate_drawing(m.model, contact_run(*m.system, 1, meet, {{"balls", 5}}), 6000, &m.equations).value();
  CHECK(grounds(drawing).empty());
  double ends[2] = {0, 0};
  int count = 0;
  for (const auto& e : drawing.elements)
    if (e.kind == Drawing::Kind::Arrow && count < 2) {
      CHECK(e.positions[0] == doctest::Approx(0.1));  // where they touch at the start
      ends[count++] = e.positions[2] - e.positions[0];
    }
  REQUIRE(count == 2);
  CHECK(ends[0] < -0.05);
  CHECK(ends[1] == doctest::Approx(-ends[0]));
}
