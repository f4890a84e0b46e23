#include "support.hpp"

#include <string>

using namespace maupertuis;
using namespace maupertuis::test;

TEST_CASE("models that look suspicious and are not") {
  for (const char* text :
       {// Bateman is a warning, nothing more
        "param m = 1 kg, k = 2 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x - y)^2 + 3 [J]\n",
        // a gyroscopic term is linear in the velocities and no total derivative
        "param m = 1 kg, b = 2 kg/s\ncoord x, y : length\nL = 1/2 m (x'^2 + y'^2) + b (x y' - y x')\n",
        // relativistic: T is not quadratic
        "param m = 1 kg, c = 3 m/s\ncoord x : length\nL = -m c^2 sqrt(1 - x'^2/c^2)\n",
        // weight of a mass that no point carries
        "param m = 1 kg, M = 2 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (0, x)\ngravity (0, -g)\nT "
        "+= 1/2 M y'^2\nV += M g y\n",
        // a mass that the start puts where the square root is defined
        "param m = 1 kg, a = 1 m, k = 1 J\ncoord r : length\nT = 1/2 m r'^2\nV = k sqrt(r/a - 5)\nstart r = 20 m\n",
        // a true claim, also when written otherwise; the zero of V is free
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\ngravity (0, "
        "-g)\nT = 1/2 m (l θ')^2\nV = 2 m g l sin(θ/2)^2\n"})
    CHECK_MESSAGE(Elaborated(text).fine(), text << Elaborated(text).messages());
}

TEST_CASE("null vectors name the coordinates they move") {
  const Elaborated e(
      "param m = 1 kg, l = 2 m\ncoord x : length, θ : angle, y : length\npoint P mass m at (x + l θ, y)\n");
  CHECK(e.codes() == "E0417");
  CHECK(e.first_message() == "the masses cannot tell `x` and `θ` apart");
  CHECK(e.diagnostics.items()[0].reason.find("x' by -2 and θ' by 1") != std::string::npos);
}

TEST_CASE("many coordinates: the rank is found from differences of the momenta") {
  std::string text = "param m = 1 kg\ncoord ";
  for (int i = 0; i < 20; ++i) text += (i ? ", x" : "x") + std::to_string(i);
  text += " : length\nT = 1/2 m (";
  for (int i = 0; i < 20; ++i)
    text += (i ? " + (x" : "(x") + std::to_string(i) + "' - x" + std::to_string((i + 1) % 20) + "')^2";
  const Elaborated e(text + ")\n");  // a ring: moving all together costs nothing
  CHECK(e.codes() == "E0408");
}
