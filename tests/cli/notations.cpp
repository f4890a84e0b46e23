// LaTeX that compiles, MathML that is well-formed, plain text that reads back.
#include "program.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace notations {
namespace {

const std::vector<std::string> models{"double_pendulum", "spherical_pendulum", "lagrange_top", "motor_link"};

std::string model_path(const std::string& name) { return std::string(PROJECT_DIR) + "/models/" + name + ".lag"; }

}  // namespace

TEST_CASE("the double pendulum prints its textbook form") {
  const Outcome outcome = maup({"derive", model_path("double_pendulum"), "--plain"});
  CHECK(outcome.out ==
        "(m1 + m2) l1^2 θ1'' + m2 l1 l2 cos(θ1 - θ2) θ2'' + m2 l1 l2 sin(θ1 - θ2) θ2'^2 + (m1 + m2) g l1 sin θ1 = 0\n"
        "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' - m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2 = 0\n");
}

TEST_CASE("LaTeX compiles, in every form") {
  const Folder folder;
  for (const std::string& model : models)
    for (const std::string options : {"", "--form matrix", "--steps"}) {
      CAPTURE(model);
      CAPTURE(options);
      const Outcome outcome = shell("\"$MAUP\" derive " + model_path(model) + " --latex " + options + " >" +
                                    folder.path("e.tex") + " && cd " + folder.path("") +
                                    " && timeout 60 pdflatex -interaction=nonstopmode -halt-on-error e.tex >e.out 2>&1 "
                                    "|| { grep -A3 '^!' e.out; exit 1; }");
      CHECK_MESSAGE(outcome.code == 0, outcome.out, outcome.err);
      CHECK(contains(read(folder.path("e.pdf")).substr(0, 5), "%PDF"));
    }
}

TEST_CASE("MathML is well-formed") {
  for (const std::string& model : models)
    for (const std::string options : {"", "--form matrix", "--form residual", "--steps"}) {
      CAPTURE(model);
      CAPTURE(options);
      const Outcome outcome =
          shell("\"$MAUP\" derive " + model_path(model) + " --mathml " + options + " | xmllint --noout -");
      CHECK_MESSAGE(outcome.code == 0, outcome.err);
    }
}

TEST_CASE("a plain equation is accepted as a claim about the same system") {
  for (const std::string form : {"standard", "solved"}) {
    const Outcome derived = maup({"derive", model_path("double_pendulum"), "--plain", "--form", form});
    REQUIRE(derived.code == 0);
    std::string model = read(model_path("double_pendulum"));
    std::string lines = derived.out;
    model += "expect equation " + lines.substr(0, lines.find('\n')) + "\n";
    const Outcome tested = maup({"test", "-"}, model);
    CHECK_MESSAGE(tested.code == 0, tested.out, tested.err);
  }
}

TEST_CASE("what is equal as it is written is not proved at 0 random points") {
  const Outcome outcome =
      maup({"test", "-", "--json"},
           std::string(pendulum) + "expect conserved 1/2 m l^2 θ'^2 - m g l cos θ\nexpect bracket (θ, p_θ) = 1\n");
  CHECK_MESSAGE(outcome.code == 0, outcome.out, outcome.err);
  CHECK(contains(outcome.out, "proved term by term"));
  CHECK(!contains(outcome.out, " 0 random points"));
}

TEST_CASE("check shows quantities as the text has them, and torques in N m") {
  const std::string model =
      "system motor\nparam J = 20 g cm^2, τ = 0.1 N m, k = 3 N m/rad\ncoord θ : angle\nT = 1/2 J θ'^2\nV = 1/2 k θ^2\n"
      "force θ = τ\nconstraint θ = 0.25 name hold\nstart θ = 0.25 rad, θ' = 0 rpm\n";
  const Outcome outcome = maup({"check", "-"}, model);
  for (const char* part : {"J = 20 g cm^2", "τ = 0.1 N m", "k = 3 N m/rad", "θ = 0.25 rad", "θ' = 0 rpm"})
    CHECK_MESSAGE(contains(outcome.out, part), part, outcome.out);
  CHECK(contains(maup({"check", "-"}, pendulum).out, "θ = 60 deg"));
  CHECK(contains(maup({"derive", "-", "--json"}, model).out, "\"unit\": \"N m\""));
}

TEST_CASE("multipliers are read as they are printed") {
  const std::string rod =
      "system rod\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g "
      "y\nconstraint x^2 + y^2 = l^2";
  CHECK(maup({"test", "-"}, rod + " name rod\nexpect equation m x'' = 2 x λ_rod\n").code == 0);
  CHECK(maup({"test", "-"}, rod + "\nexpect equation m x'' = 2 x λ\n").code == 0);
  CHECK(maup({"test", "-"}, rod + " name rod\nexpect equation m x'' = 3 x λ_rod\n").code == 4);
  CHECK(
      contains(maup({"check", "-"}, rod + " name rod\nV += λ_rod\n").err, "E0201"));  // of the motion, not of the model
}

TEST_CASE("every stage can be printed") {
  for (const char* stage : {"syntax", "system", "equations", "program", "jet"}) {
    CAPTURE(stage);
    const Outcome outcome = maup({"derive", "-", "--emit", stage}, pendulum);
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    CHECK(outcome.out.size() > 40);
  }
}

TEST_CASE("--steps names a rule on each line of the textbook path") {
  const Outcome outcome = maup({"derive", "-", "--steps"}, pendulum);
  for (const char* part : {"Coordinates", "chain rule", "∂L/∂θ'", "d/dt", "Euler-Lagrange",
                           "m l^2 θ'' + m g l sin θ = 0", "Certificate: passed"}) {
    CAPTURE(part);
    CHECK(contains(outcome.out, part));
  }
}

TEST_CASE("colors only where they are wanted") {
  const std::string escape = "\x1b[";
  const std::string wrong = std::string(pendulum) + "V = q\n";
  CHECK(!contains(maup({"check", "-"}, wrong).err, escape));
  CHECK(contains(maup({"check", "-", "--color", "always"}, wrong).err, escape));
  CHECK(!contains(shell("NO_COLOR=1 \"$MAUP\" check /none --color auto").err, escape));
}

}  // namespace notations
