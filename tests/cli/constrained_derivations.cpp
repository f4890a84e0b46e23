// Equations with multipliers, in every form and notation.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

const std::string rod_pendulum = R"(system pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
start x = 1 m
run 1 s
)";

const std::string rolling_disk = R"(system rolling_disk
param m = 1 kg, R = 20 cm
let I = 1/2 m R^2, J = 1/4 m R^2
coord x, y : length
coord φ, ψ : angle
T = 1/2 m (x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2
constraint x' = R φ' cos ψ
constraint y' = R φ' sin ψ
run 1 s
)";

}  // namespace

TEST_CASE("the forces of constraint stand on the right, the constraint below") {
  CHECK(maup({"derive", "-", "--plain"}, rod_pendulum).out ==
        "m x'' = 2 x λ_rod\nm y'' + m g = 2 y λ_rod\nx^2 + y^2 = l^2    # rod\n");
}

TEST_CASE("--eliminate shows equations without multipliers") {
  CHECK(maup({"derive", "-", "--plain", "--eliminate"}, rod_pendulum).out ==
        "m x y'' - m y x'' + m g x = 0\nx^2 + y^2 = l^2    # rod\n");
  const Outcome disk = maup({"derive", "-", "--plain", "--eliminate"}, rolling_disk);
  CHECK(disk.out.substr(0, disk.out.find("x'")) == "(m R^2 + I) φ'' = 0\nJ ψ'' = 0\n");
  CHECK(maup({"derive", "-", "--eliminate", "--form", "matrix"}, rod_pendulum).code == 2);
}

TEST_CASE("--form solved gives λ, --form matrix gives A and b") {
  CHECK(maup({"derive", "-", "--plain", "--form", "solved"}, rod_pendulum).out ==
        "x'' = 2 x λ_rod/m\ny'' = 2 y λ_rod/m - g\nλ_rod = m (g y - x'^2 - y'^2)/(2 (x^2 + y^2))\n");
  const Outcome matrix = maup({"derive", "-", "--plain", "--form", "matrix"}, rod_pendulum);
  CHECK(contains(matrix.out, "let A_rod_x = 2 x\nlet A_rod_y = 2 y\nlet b_rod = -2 x'^2 - 2 y'^2\n"));
}

TEST_CASE("what is too long is refused with its reason") {
  const std::string repeated = rod_pendulum + "constraint 2 x^2 + 2 y^2 = 2 l^2 name again\n";
  const Outcome eliminated = maup({"derive", "-", "--eliminate"}, repeated);
  CHECK(eliminated.code == 1);
  CHECK(contains(eliminated.err, "E0693"));
  CHECK(eliminated.out.empty());
  const Outcome solved = maup({"derive", "-", "--form", "solved"}, repeated);
  CHECK(contains(solved.err, "E0692"));
}

TEST_CASE("the textbook path names φ, A, λ and the reaction") {
  const Outcome outcome = maup({"derive", "-", "--steps"}, rod_pendulum);
  CHECK(contains(outcome.out, "2 − 1 = 1 freedom"));
  CHECK(contains(outcome.out, "∂φ_rod/∂x = 2 x"));
  CHECK(contains(outcome.out, "2 x x'' + 2 y y'' = -2 x'^2 - 2 y'^2"));
  CHECK(contains(outcome.out,
                 "reaction(rod) = -2 l λ_rod    (the tension in rod, positive when it pulls O and P together"));
  CHECK(contains(outcome.out, "constraint_rows"));
}

TEST_CASE("LaTeX compiles and MathML is well-formed, with multipliers") {
  const Folder folder;
  folder.write("pendulum.lag", rod_pendulum);
  folder.write("disk.lag", rolling_disk);
  for (const std::string model : {"pendulum", "disk"})
    for (const std::string options :
         {"", "--form matrix", "--form residual", "--form solved", "--eliminate", "--steps"}) {
      CAPTURE(model);
      CAPTURE(options);
      const std::string derive = "cd " + folder.path("") + " && \"$MAUP\" derive " + model + ".lag " + options;
      const Outcome latex =
          shell(derive +
                " --latex >e.tex && timeout 60 pdflatex -interaction=nonstopmode -halt-on-error e.tex "
                ">e.out 2>&1 || { grep -A3 '^!' e.out; exit 1; }");
      CHECK_MESSAGE(latex.code == 0, latex.out, latex.err);
      const Outcome mathml = shell(derive + " --mathml | xmllint --noout -");
      CHECK_MESSAGE(mathml.code == 0, mathml.err);
    }
}

TEST_CASE("derive --json with constraints") {
  const Json json = json_of(maup({"derive", "-", "--json"}, rod_pendulum));
  CHECK(json["multipliers"] == Json::array({"λ_rod"}));
  CHECK(json["constraints"][0]["name"] == "rod");
  CHECK(json["constraints"][0]["plain"] == "x^2 + y^2 = l^2");
  CHECK(json["constraint_matrix"] == Json::parse(R"([["2 x", "2 y"]])"));
  CHECK(json["constraint_bias"] == Json::array({"-2 x'^2 - 2 y'^2"}));
  CHECK(json["reactions"][0]["plain"] == "-2 l λ_rod");
  CHECK(json["reactions"][0]["unit"] == "N");
  CHECK(json["certificate"]["passed"] == true);
}

TEST_CASE("the jet of a constrained motion stays on the constraint") {
  const Outcome outcome = maup({"derive", "-", "--emit", "jet"}, rod_pendulum);
  CHECK(outcome.code == 0);
  // x = 1 m at rest: x'' = 0, y'' = −g, so that x has no term of second order and y has −g/2.
  CHECK(contains(outcome.out, "\n2  "));
  CHECK(contains(outcome.out, "-4.905"));
}
