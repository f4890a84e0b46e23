// Models whose independent variable is not the time, and models that hold an integral of their paths.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace variational_problems_test {
namespace {

const std::string brachistochrone =
    "system brachistochrone\nparam g = 9.81 m/s^2\nindependent x : length\ncoord y1 : length\n"
    "L = sqrt((1 + y1'^2)/(2 g y1))\nstart y1 = 1 m, y1' = 1/2\nrun 20 cm\n";
const std::string chain =
    "system chain\nparam l = 3 m\nindependent x : length\ncoord y : length\nL = y sqrt(1 + y'^2)\n"
    "constraint integral sqrt(1 + y'^2) = l name total\npath from 0 at -1 m to (free) at 1 m\n";

}  // namespace

TEST_CASE("derive with x in the place of t: primes, d/dx, and the cycloid's equation") {
  const Outcome steps = maup({"derive", "-", "--steps"}, brachistochrone);
  CHECK_MESSAGE(steps.code == 0, steps.err);
  CHECK(contains(steps.out, "d/dx ∂L/∂y1'"));
  CHECK(contains(steps.out, "y1'' = -y1'^2/(2 y1) - 1/(2 y1)"));
  CHECK(contains(steps.out, "Certificate: passed"));
  CHECK(!contains(steps.out, "d/dt"));
  const Outcome latex = maup({"derive", "-", "--steps", "--latex"}, brachistochrone);
  CHECK(contains(latex.out, "\\frac{\\mathrm{d}}{\\mathrm{d} x}"));
  CHECK(contains(latex.out, "y_1''"));
  CHECK(!contains(latex.out.substr(latex.out.find("\\begin{document}")), "dot"));
  const Outcome mathml = maup({"derive", "-", "--mathml"}, brachistochrone);
  CHECK(contains(mathml.out, "&#x2032;&#x2032;"));
  CHECK(!contains(mathml.out, "&#x00A8;"));
}

TEST_CASE("simulate with x in the place of t: the values, their units, and the first column") {
  const Folder folder;
  const std::string model = folder.write("b.lag", brachistochrone);
  const Outcome told = maup({"simulate", model, "--at", "0.1", "-o", folder.path("b.csv")});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "x = 0.1 m\n"));
  CHECK(!contains(told.out, "t ="));
  CHECK(read(folder.path("b.csv")).rfind("x [m],y1 [m],y1' [1],energy [s/m]\r\n", 0) == 0);
  // Beltrami: y (1 + y'^2) is constant along the cycloid.
  const Json state = json_of(maup({"simulate", model, "--json"}))["final"]["state"];
  const double y = state["y1"], slope = state["y1'"];
  CHECK(std::abs(y * (1 + slope * slope) - 1.25) < 1e-14);
  const Outcome precise = maup({"simulate", model, "--precision", "quad"});
  CHECK_MESSAGE(precise.code == 0, precise.err);
  CHECK(contains(precise.out, "x = 0.2 m"));
}

TEST_CASE("check names the independent variable, the path and what is held") {
  const Outcome told = maup({"check", "-"}, chain);
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "independent variable  x in m"));
  CHECK(contains(told.out, "from (0 m) at x = -1 m to (free) at x = 1 m"));
  CHECK(contains(told.out, "total: ∫ sqrt(y'^2 + 1) dx = 3 m"));
}

TEST_CASE("an integral that is held belongs to a path: commands about motions say so and point at action") {
  for (const char* command : {"derive", "simulate", "hamiltonian", "invariants", "modes", "reduce", "plot", "report"}) {
    CAPTURE(command);
    const Outcome told = maup({command, "-"}, chain);
    CHECK(told.code == 1);
    CHECK(contains(told.err, "E0244"));
    CHECK(contains(told.err, "`maup action`"));
    CHECK(told.out.empty());
  }
  const Outcome orbits = maup({"orbits", "-", "--floquet"}, chain);
  CHECK(contains(orbits.err, "E0244"));
}

TEST_CASE("frequencies and periods are those of motions in time") {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"modes", "-"}, {"orbits", "-", "--floquet"}}) {
    const Outcome told = maup(arguments, brachistochrone);
    CHECK(told.code == 1);
    CHECK(contains(told.err, "E0245"));
  }
}

TEST_CASE("reduce leaves out a path whose coordinates go, and says so") {
  const Outcome told = maup({"reduce", "-"},
                            "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at "
                            "(x, y)\ngravity (0, -g)\n"
                            "constraint x^2 + y^2 = l^2\nstart x = 0.6 m, y = -0.8 m\nrun 1 s\npath from (0.6 m, -0.8 "
                            "m) at 0 s to (-0.6 m, -0.8 m) at 1 s\n"
                            "expect action = 1 J s ± 1e-9\n");
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(!contains(told.out, "path from"));
  CHECK(!contains(told.out, "expect action"));
  CHECK(contains(told.err, "path from (0.6 m, -0.8 m) at 0 s to (-0.6 m, -0.8 m) at 1 s"));
}

}  // namespace variational_problems_test
