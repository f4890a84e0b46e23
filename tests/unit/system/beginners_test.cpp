// What beginners write: one message for each mistake, where it stands, with the words that lead on.
#include "support.hpp"

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

const std::string spring = "param m = 1 kg, k = 10 N/m, c = 1 N s/m, g = 9.81 m/s^2\ncoord x : length\n";
const std::string energies = "T = 1/2 m x'^2\nV = 1/2 k x^2\n";

/// "E0201 `v`: help" of the only message.
std::string told(const std::string& text) {
  const Elaborated e(text);
  REQUIRE_MESSAGE(e.diagnostics.items().size() == 1, e.messages());
  const Diagnostic& d = e.diagnostics.items().front();
  REQUIRE(d.span);
  return d.code + " `" + std::string(e.source.text().substr(d.span->begin, d.span->end - d.span->begin)) +
         "`: " + d.help;
}

}  // namespace

TEST_CASE("names of beginners") {
  CHECK(told(spring + "T = 1/2 M x'^2\nV = 1/2 k x^2\n") == "E0201 `M`: Did you mean `m`?");
  CHECK(told(spring + "T = 1/2 m v^2\nV = 1/2 k x^2\n") ==
        "E0201 `v`: The velocity of x is written x'; another quantity is declared, `param v = …`, `coord v : …` or "
        "`let v = …`.");
  CHECK(told("param m = 1 kg, l = 1 m\ncoord θ1 : angle\npoint A mass m at l (sin θ1, -cos θ1)\n"
             "point B mass m at A + l (sin θ2, -cos θ2)\n") ==
        "E0201 `θ2`: Declare it: `param θ2 = …`, `coord θ2 : …` or `let θ2 = …`. Did you mean `θ1`?");
}

TEST_CASE("numbers without their units") {
  CHECK(told(spring + energies + "start x = 0.3\n") == "E0304 `0.3`: A number has a unit here, such as 0.3 m.");
  CHECK(told(spring + energies + "start x' = -0.3\n") == "E0304 `-0.3`: A number has a unit here, such as -0.3 m/s.");
  CHECK(told(spring + "T = 1/2 m x'^2\nV = 3\n") == "E0304 `3`: A number has a unit here, such as 3 [J].");
  CHECK(told(spring + "point P mass m at (x, 0)\ngravity (0, -9.81)\n") ==
        "E0304 `(0, -9.81)`: A number has a unit here, such as (0, -9.81) m/s^2.");
  CHECK(told(spring + "point P mass m at (x, 0)\ngravity -g\n") == "E0210 `-g`: Write its components: (0, -g).");
  CHECK(told(spring + "point P mass m at (x, 0)\ngravity g\n") == "E0210 `g`: Write its components: (0, -g).");
}

TEST_CASE("the only parameter of a formula may have the wrong unit") {
  CHECK(told("param m = 1 kg, k = 10 N\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n") ==
        "E0304 `1/2 k x^2`: There is a length too many among its factors. Or the unit of `k`, N, is another than was "
        "meant.");
}

TEST_CASE("damping that was put into the potential") {
  CHECK(told(spring + "T = 1/2 m x'^2\nV = 1/2 k x^2 + c x'\n") ==
        "E0302 `c x'`: A force that grows with a velocity has no potential: for damping write D = 1/2 c x'^2.");
}

TEST_CASE("functions of the time, springs and expectations as one writes them elsewhere") {
  CHECK(told("param m = 1 kg\ncoord x(t) : length\nT = 1/2 m x'^2\n") ==
        "E0111 `(`: Coordinates are functions of the time as they stand: write x : length, or x : angle.");
  CHECK(told(spring + energies + "start x(0) = 1 m\n") ==
        "E0111 `(`: The start is the beginning of the run: write x = ….");
  CHECK(told(spring + energies + "start t = 5 s, x = 1 m\n") ==
        "E0201 `t`: The time of the start is 0, or written: start at 5 s.");
  CHECK(told(spring + "point A mass m at (x, 0)\nspring O A stiffness k\n") ==
        "E0111 `A`: Write spring A - B stiffness k.");
  CHECK(told(spring + energies + "expect x at 1 s = 0.3 m\n").rfind("E0127 `expect x at 1 s = 0.3 m`: Add ±", 0) == 0);
  CHECK(told(spring + energies + "force x = 5 N/s t\n") ==
        "E0118 `s t`: Write /(s t) if both belong below the slash, else put the second one before it. The time stands "
        "behind the brackets of a unit: 5 [N/s] t.");
}

TEST_CASE("what a statement without its word was meant to declare is not asked for again") {
  CHECK(told("Param m = 1 kg, k = 3 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n") ==
        "E0110 `Param`: Did you mean `param`?");
  CHECK(told("param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\ny = -l cos θ\nT = 1/2 m l^2 θ'^2\n"
             "V = m g y\n") ==
        "E0110 `y`: A definition is `let y = …`, a parameter `param y = …`, an initial value `start y = …`.");
}

TEST_CASE("a unit that is read as a name or as thousandths of another") {
  const std::string rod = "param m = 1 kg, g = 9.81 ms^-2\ncoord θ : angle\n";
  const auto says = [&](const std::string& line, const std::string& part) {
    const Elaborated e(rod + line);
    CHECK_MESSAGE(e.messages().find(part) != std::string::npos, e.messages());
  };
  says("point P mass m at 2 m (sin θ, -cos θ)\n",
       "Here `m` is the name of the model; with the unit it is written 2 [m].");
  says("point P mass m at 2 [m] (sin θ, -cos θ)\ngravity (0, -g)\n",
       "ms is a millisecond, and m s a metre times a second");
}
