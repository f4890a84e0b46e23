// The drawing follows the run: at its rows exactly, between them on the cubic through positions and velocities.
#include <maupertuis/drawing.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

namespace {

// A pendulum of length 2 whose angle is θ = cos t, sampled every `step` seconds.
struct Pendulum {
  Model model;
  Trajectory run;

  explicit Pendulum(double step, std::size_t rows) {
    auto& system = model.system;
    system.context = std::make_shared<Context>();
    Context& c = *system.context;
    const Expr theta = c.symbol("θ", Role::Coordinate), length = c.symbol("l", Role::Parameter);
    system.coordinates.push_back({"θ",
                                  theta,
                                  c.symbol("θ", Role::Coordinate, 1),
                                  c.symbol("θ", Role::Coordinate, 2),
                                  dimensions::angle(),
                                  "angle",
                                  {}});
    system.parameters.push_back({"l", length, c.number(2), 2, dimensions::length(), "m", 1, false, {}});
    const Expr mass = c.symbol("m", Role::Parameter);
    system.parameters.push_back({"m", mass, c.number(3), 3, dimensions::mass(), "kg", 1, false, {}});
    const ExprVector bob{length * sin(theta), -(length * cos(theta))};
    system.points.push_back({"bob", mass, bob, {}});
    system.gravity = {c.number(0), c.number(-9)};
    run.columns = {{"θ", "rad"}, {"θ'", "rad/s"}};
    for (std::size_t i = 0; i < rows; ++i) {
      const double t = step * static_cast<double>(i);
      run.times.push_back(t);
      run.values.insert(run.values.end(), {std::cos(t), -std::sin(t)});
    }
  }

  void draw(syntax::DrawItem::Kind kind, std::vector<std::string> names, std::vector<ExprVector> path,
            std::vector<Expr> sizes = {}) {
    model.experiment.drawing.push_back({kind, std::move(path), std::move(sizes), std::move(names)});
  }
  ExprVector origin() const { return {model.system.context->number(0), model.system.context->number(0)}; }
};

}  // namespace

TEST_CASE("a coarse run is filled in: the rod keeps its length, the angle its motion") {
  Pendulum p(0.1, 63);
  p.draw(syntax::DrawItem::Kind::Line, {"O", "bob"}, {p.origin(), p.model.system.points[0].position});
  const auto drawing = evaluate_drawing(p.model, p.run);
  REQUIRE(drawing);
  REQUIRE(drawing->elements.size() == 2);  // the pivot of O, then the rod
  CHECK(drawing->elements[0].still);
  CHECK(drawing->times.size() >= 600);
  CHECK(drawing->times.back() == p.run.times.back());
  const auto& element = drawing->elements[1];
  CHECK(element.masses == std::vector<double>{0, 3});
  for (std::size_t f = 0; f < drawing->times.size(); ++f) {
    const double x = element.positions[4 * f + 2], y = element.positions[4 * f + 3];
    CHECK(std::hypot(x, y) == doctest::Approx(2).epsilon(1e-12));
    CHECK(std::atan2(x, -y) == doctest::Approx(std::cos(drawing->times[f])).epsilon(1e-6));
  }
  CHECK(drawing->gravity == std::vector<double>{0, -9});
}

TEST_CASE("a fine run is thinned to the frames asked for") {
  Pendulum p(0.001, 5001);
  p.draw(syntax::DrawItem::Kind::Trail, {"bob"}, {p.model.system.points[0].position});
  const auto drawing = evaluate_drawing(p.model, p.run, 1000);
  REQUIRE(drawing);
  CHECK(drawing->times.size() <= 1000);
  CHECK(drawing->times.size() > 500);
  const auto& positions = drawing->elements[0].positions;  // nothing else is drawn
  CHECK(positions[0] == doctest::Approx(2 * std::sin(1)));
  CHECK(positions.size() == 2 * drawing->times.size());
}

TEST_CASE("a box has its sizes and turns with its body") {
  Pendulum p(0.1, 63);
  Context& c = *p.model.system.context;
  const Expr theta = p.model.system.coordinates[0].q;
  Body body;
  body.name = "plate";
  body.position = p.model.system.points[0].position;
  body.rotation = {
      2, 2, {cos(c.number(4) * theta), -sin(c.number(4) * theta), sin(c.number(4) * theta), cos(c.number(4) * theta)}};
  p.model.system.bodies.push_back(body);
  p.draw(syntax::DrawItem::Kind::Box, {"plate"}, {body.position}, {p.model.system.parameters[0].symbol, c.number(1)});
  const auto drawing = evaluate_drawing(p.model, p.run);
  REQUIRE(drawing);
  const auto& element = drawing->elements[0];
  REQUIRE(element.kind == Drawing::Kind::Solid);
  for (std::size_t f = 0; f < drawing->times.size(); ++f) {
    const double* at = &element.positions[6 * f];
    const double angle = 4 * std::cos(drawing->times[f]);
    CHECK(at[2] - at[0] == doctest::Approx(1 * std::cos(angle)).epsilon(1e-5));  // half of the width l = 2
    CHECK(at[3] - at[1] == doctest::Approx(1 * std::sin(angle)).epsilon(1e-5));
    CHECK(at[4] - at[0] == doctest::Approx(-0.5 * std::sin(angle)).epsilon(1e-5));
  }
}

TEST_CASE("without a draw statement masses are marked and rods found; without points there is no drawing") {
  Pendulum p(0.1, 63);
  const auto drawing = evaluate_drawing(p.model, p.run);
  REQUIRE(drawing);
  int rods = 0, trails = 0;
  for (const auto& e : drawing->elements) {
    rods += e.kind == Drawing::Kind::Path && e.points == 2;
    trails += e.kind == Drawing::Kind::Trail;
  }
  CHECK(rods == 1);
  CHECK(trails == 1);
  p.model.system.points.clear();
  CHECK_FALSE(evaluate_drawing(p.model, p.run));
}

TEST_CASE("a trail shows its point where that has mass and nothing else does") {
  using Item = syntax::DrawItem::Kind;
  using Kind = Drawing::Kind;
  const auto kinds = [](const std::string& point, std::vector<Item> items) {
    Pendulum p(0.1, 63);
    const ExprVector place = p.model.system.points[0].position;
    p.model.system.points.push_back({"light", {}, place, {}});
    for (const Item item : items)
      p.draw(item, {point}, {place},
             item == Item::Circle ? std::vector{place[0].context().number(1)} : std::vector<Expr>{});
    std::vector<Kind> out;
    const auto drawing = evaluate_drawing(p.model, p.run);
    REQUIRE(drawing);
    for (const auto& e : drawing->elements) out.push_back(e.kind);
    return out;
  };
  CHECK(kinds("bob", {Item::Trail}) == std::vector{Kind::Trail, Kind::Path});
  CHECK(kinds("bob", {Item::Trail, Item::Label}) == std::vector{Kind::Trail, Kind::Path, Kind::Label});
  CHECK(kinds("bob", {Item::Trail, Item::Circle}) == std::vector{Kind::Trail, Kind::Solid});
  CHECK(kinds("light", {Item::Trail}) == std::vector{Kind::Trail});
}

TEST_CASE("no rows, one row") {
  Pendulum none(0.1, 0);
  CHECK_FALSE(evaluate_drawing(none.model, none.run));
  Pendulum one(0.1, 1);
  const auto drawing = evaluate_drawing(one.model, one.run);
  REQUIRE(drawing);
  CHECK(drawing->times.size() == 1);
}
