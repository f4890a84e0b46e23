#include "session.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

namespace maupertuis::studio {
namespace {

TEST_CASE("a dragged mechanism does not go through contacts, and slides along them") {
  // A ladder of 3 m in the corner: its foot is pulled below the floor and to the left, its top through the wall.
  Asked page(
      "system ladder\nparam m = 5 kg, l = 3 m, g = 9.81 m/s^2\ncoord x, y : length, θ : angle\n"
      "body rod mass m inertia m l^2/12 at (x, y) rotation angle θ\n"
      "point foot at (x, y) - l/2 (cos θ, sin θ)\npoint top at (x, y) + l/2 (cos θ, sin θ)\ngravity (0, -g)\n"
      "contact foot.y >= 0 name floor\ncontact -top.x >= 0 name wall\n"
      "start θ = 60 deg, x = -0.75 m, y = 1.299038105676658 m\nrun 1 s\ndraw foot - top\n");
  Json elements = page.ask("pose")["drawing"]["elements"];
  std::size_t element = 0;
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (elements[k]["kind"] == "path" && elements[k]["still"] == false) element = k;
  const auto corner = [](const Json& q) {
    const double x = q["x"], y = q["y"], c = std::cos(q["θ"].get<double>()), s = std::sin(q["θ"].get<double>());
    return std::array{x - 1.5 * c, y - 1.5 * s, x + 1.5 * c, y + 1.5 * s};
  };
  struct Pulled {
    int point;
    double x, y;
  };
  for (const Pulled& to : {Pulled{0, -2.2, -0.7}, {0, -0.4, -0.3}, {1, 0.9, 1.2}, {1, 0.5, 4.0}}) {
    CAPTURE(to.x);
    Json dragged =
        page.ask({{"do", "pose"}, {"drag", {{"element", element}, {"point", to.point}, {"to", {to.x, to.y}}}}});
    REQUIRE(dragged["ok"] == true);
    const auto at = corner(dragged["start"]);
    CHECK(at[1] >= -1e-15);
    CHECK(at[2] <= 1e-15);
    Json run = page.ask({{"do", "run"},
                         {"start",
                          {{"x", dragged["start"]["x"].dump() + " m"},
                           {"y", dragged["start"]["y"].dump() + " m"},
                           {"θ", dragged["start"]["θ"].dump() + " rad"}}}});
    CHECK(run["ok"] == true);
  }
  // The foot goes as far to the left as it is pulled, on the floor.
  Json aside = page.ask({{"do", "pose"}, {"drag", {{"element", element}, {"point", 0}, {"to", {-2.0, -0.5}}}}});
  CHECK(corner(aside["start"])[0] == doctest::Approx(-2).epsilon(0.01));
  CHECK(std::abs(corner(aside["start"])[1]) < 1e-5);
}

TEST_CASE("the velocities of a dragged start are those from before the drag, whatever way it took") {
  // A knife-edge: x' = 1 m/s, ψ' = 2 rad/s; the heading turns with the drag, ψ' does not change by it.
  const std::string cart =
      "system cart\nparam m = 2 kg, J = 0.1 kg m^2, a = 0.2 m\ncoord x, y : length, ψ : angle\n"
      "body cart mass m inertia J at (x + a cos ψ, y + a sin ψ) rotation angle ψ\n"
      "constraint y' cos ψ - x' sin ψ = 0 name wheels\nstart x' = 1 m/s, ψ' = 2 rad/s\nrun 5 s\n"
      "draw box cart 0.4 m by 0.2 m, trail cart\n";
  Asked page(cart);
  Json rest = page.ask("pose");
  std::size_t element = 0;
  for (std::size_t k = 0; k < rest["drawing"]["elements"].size(); ++k)
    if (rest["drawing"]["elements"][k]["kind"] == "solid") element = k;
  const auto dragged_by = [&](const std::vector<std::array<double, 2>>& way) {
    Json start = Json::object(), answer;
    for (const auto& to : way) {
      answer = page.ask({{"do", "pose"},
                         {"start", start},
                         {"drag",
                          {{"element", element},
                           {"point", 0},
                           {"to", {to[0], to[1]}},
                           {"velocities", {{"x'", rest["start"]["x'"]}, {"y'", rest["start"]["y'"]}, {"ψ'", 2.0}}}}}});
      REQUIRE(answer["ok"] == true);
      for (const auto& [name, value] : answer["start"].items())
        start[name] = value.dump() + (name == "ψ"           ? " rad"
                                      : name == "ψ'"        ? " rad/s"
                                      : name.back() == '\'' ? " m/s"
                                                            : " m");
    }
    return answer["start"];
  };
  std::vector<std::array<double, 2>> slowly;
  for (int k = 1; k <= 20; ++k) slowly.push_back({0.2 - 0.02 * k, 0.015 * k});
  Json end = dragged_by(slowly);
  // The least kinetic change that the constraint asks for at the place where it is let go.
  Json direct = page.ask({{"do", "pose"},
                          {"start",
                           {{"x", end["x"].dump() + " m"},
                            {"y", end["y"].dump() + " m"},
                            {"ψ", end["ψ"].dump() + " rad"},
                            {"x'", "0 m/s"},
                            {"y'", "0 m/s"},
                            {"ψ'", "0 rad/s"}}},
                          {"drag",
                           {{"element", element},
                            {"point", 0},
                            {"to", {slowly.back()[0], slowly.back()[1]}},
                            {"velocities", {{"x'", 1.0}, {"y'", 0.0}, {"ψ'", 2.0}}}}}});
  for (const char* name : {"x'", "y'", "ψ'"}) {
    CAPTURE(name);
    CHECK(end[name].get<double>() == doctest::Approx(direct["start"][name].get<double>()).epsilon(1e-3).scale(1));
  }
}

}  // namespace
}  // namespace maupertuis::studio
