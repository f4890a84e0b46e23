// In which modes an integral holds, and which impacts keep it.
#include "../model_text.hpp"

#include <maupertuis/integrals_through_modes.hpp>

#include <algorithm>

using namespace maupertuis;

namespace {

using Holds = IntegralThroughModes::Holds;

IntegralThroughModes of(const ModelText& m, Expr integral) {
  return integrals_through_modes(m.model, m.equations, {integral}).front();
}

Holds in(const IntegralThroughModes& found, const std::string& mode) {
  const auto at = std::find_if(found.modes.begin(), found.modes.end(), [&](const auto& m) { return m.mode == mode; });
  REQUIRE(at != found.modes.end());
  return at->holds;
}

const std::string ball = "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\n";

}  // namespace

TEST_CASE("momentum along a floor, and energy, with and without friction and restitution") {
  const ModelText smooth(ball + "contact z >= 0 restitution 0.8 name floor\n");
  const auto momentum = of(smooth, smooth.p("m") * smooth.v(0));
  CHECK(momentum.everywhere());
  CHECK(momentum.modes.size() == 2);
  const auto energy = of(smooth, smooth.equations.energy_function);
  CHECK(in(energy, "free") == Holds::Yes);
  CHECK(in(energy, "floor") == Holds::Yes);
  CHECK(energy.impacts.at(0).kept == Holds::No);
  CHECK(energy.impacts.at(0).change > 0.01);

  const ModelText elastic(ball + "contact z >= 0 restitution 1 name floor\n");
  CHECK(of(elastic, elastic.equations.energy_function).everywhere());

  const ModelText rough(ball + "contact z >= 0 restitution 1 friction 0.3 slip x' name floor\n");
  const auto rubbed = of(rough, rough.equations.energy_function);
  CHECK(rubbed.modes.size() == 4);
  CHECK(in(rubbed, "floor sticking") == Holds::Yes);
  CHECK(in(rubbed, "floor sliding +") == Holds::No);
  CHECK(of(rough, rough.v(0)).impacts.at(0).kept == Holds::No);
}

TEST_CASE("two balls keep their momentum, and the wall takes it") {
  const ModelText m(
      "dimensionless\nparam M = 3\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 M y'^2\n"
      "contact x >= 0 restitution 1 name wall\ncontact y >= x restitution 1 name blocks\nstart x = 1, y = 2\n");
  const auto momentum = of(m, m.v(0) + m.p("M") * m.v(1));
  CHECK(momentum.impacts.at(0).kept == Holds::No);
  CHECK(momentum.impacts.at(1).kept == Holds::Yes);
  CHECK(in(momentum, "blocks") == Holds::Yes);
  CHECK(in(momentum, "wall") == Holds::Yes);
  CHECK(in(momentum, "wall, blocks") == Holds::Yes);
  CHECK(of(m, m.equations.energy_function).everywhere());
}
