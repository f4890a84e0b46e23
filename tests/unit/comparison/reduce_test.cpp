#include "../model_text.hpp"
#include "models.hpp"

#include <maupertuis/comparison.hpp>

#include <cmath>

using namespace maupertuis;
using namespace models;

namespace {

struct Reduced {
  Reduction reduction;
  Diagnostics diagnostics;
};

Reduced reduce_text(const std::string& text) {
  const ModelText m(text);
  Diagnostics silent;
  Reduced out;
  const auto tree = syntax::parse(m.source, silent);
  out.reduction = reduce(m.model, m.equations, tree, m.source, out.diagnostics);
  INFO(render(out.diagnostics, m.source));
  return out;
}

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

/// A reduced model whose last coordinates stand at the same place as those of the full one: runs that share no
/// equation.
void check_reduced(const Reduced& r, std::size_t freedoms) {
  REQUIRE_FALSE(r.reduction.text.empty());
  INFO(r.reduction.text);
  REQUIRE(r.reduction.proof);
  CHECK(r.reduction.proof->verdict == Sameness::Same);
  CHECK(r.reduction.proof->run.difference < 1e-12);
  const ModelText small(r.reduction.text);
  CHECK(small.system->coordinates.size() == freedoms);
  CHECK(small.system->constraints.empty());
  CHECK(r.reduction.independent.size() == freedoms);
}

}  // namespace

TEST_CASE("the pendulum in x, y becomes the pendulum in θ, and its rod lives on") {
  const Reduced r = reduce_text(cartesian_pendulum);
  check_reduced(r, 1);
  CHECK(has_line(r.reduction.text, "coord θ : angle"));
  CHECK(has_line(r.reduction.text, "let x = l sin θ, y = -l cos θ"));
  CHECK(has_line(r.reduction.text, "reaction rod = release l"));
  CHECK(has_line(r.reduction.text, "start θ = 30 deg"));
  CHECK(has_line(r.reduction.text, "expect reaction rod at 0 s = 8.495709211125344 N rel 1e-12"));
}

TEST_CASE("a shifted centre, and an ellipse") {
  std::string text = cartesian_pendulum;
  text.replace(text.find("x^2 + y^2 = l^2"), 15, "(x - 3 [m])^2 + 2 y^2 = l^2");
  text.replace(text.find("start"), text.find("run") - text.find("start"), "start x = 4 m\n");
  text.resize(text.find("expect"));
  check_reduced(reduce_text(text), 1);
}

TEST_CASE("the sphere by two angles; T given in velocities of the old coordinates") {
  const Reduced r = reduce_text(spherical_cartesian);
  check_reduced(r, 2);
  CHECK(has_line(r.reduction.text, "let x = l sin θ cos φ, y = l sin θ sin φ, z = -l cos θ"));
  CHECK(has_line(r.reduction.text, "expect conserved m (x y' - y x')"));
}

TEST_CASE("a sphere that starts at its pole takes another axis") {
  std::string text = spherical_cartesian;
  text.replace(text.find("x = 0.6 m, y' = 1 m/s, z = -0.8 m"), 33, "x = 0, y' = 1 m/s, z = -1 m");
  check_reduced(reduce_text(text), 2);
}

TEST_CASE("Atwood's machine and the planetary gear: linear constraints") {
  const Reduced machine = reduce_text(atwood);
  check_reduced(machine, 1);
  CHECK(has_line(machine.reduction.text, "let y2 = -l - y1"));  // y1 has a start of its own
  const Reduced gear = reduce_text(planetary_gear);
  check_reduced(gear, 1);
  CHECK(has_line(gear.reduction.text, "force φs = τ"));
  CHECK(has_line(gear.reduction.text, "let φc = Rs φs/(Rs + Rr)"));  // φs (1 + Rr/Rs)⁻¹, as textbooks have it
}

TEST_CASE("a bead on a wire keeps the coordinate along it") {
  const Reduced r = reduce_text(bead_on_parabola);
  check_reduced(r, 1);
  CHECK(has_line(r.reduction.text, "let y = k x^2"));
  CHECK(has_line(r.reduction.text, "draw trail P"));  // the reaction of the wire is gone with it
}

TEST_CASE("rods between points one after the other") {
  const Reduced r = reduce_text(double_pendulum);
  check_reduced(r, 2);
  CHECK(has_line(r.reduction.text, "let x2 = x1 + l2 sin θ2, y2 = y1 - l2 cos θ2"));
  CHECK(has_line(r.reduction.text, "reaction r2 = release l2"));
}

TEST_CASE("a repeated constraint goes; a driven coordinate shares its force out") {
  const Reduced r = reduce_text(R"(system wagon
param m = 1 kg, R = 1 m, F = 2 N, k = 3 N m
coord x : length, φ, ψ : angle
T = 1/2 m x'^2 + 1/4 m R^2 φ'^2 + 1/4 m R^2 ψ'^2
constraint x = R φ
constraint x = R ψ
constraint φ = ψ
force x = F
force φ = k cos ψ
start x = 1 m
run 2 s
)");
  check_reduced(r, 1);
  CHECK(r.reduction.text.find("force φ") == std::string::npos);
}

TEST_CASE("a force and a spring that are given as quantities: their units stand in brackets then") {
  const Reduced r = reduce_text(R"(system wheel
param m = 1 kg, R = 1 m
coord x : length, φ : angle
T = 1/2 m x'^2 + 1/4 m R^2 φ'^2
constraint φ = x/R
torsion spring φ stiffness 2 N m/rad rest -10 deg
force φ = -1.5 N m
start x = 1 m
run 2 s
)");
  check_reduced(r, 1);
  CHECK(r.reduction.text.find("[N m]") != std::string::npos);
}

TEST_CASE("a moving constraint: the reduced model is rheonomic") {
  check_reduced(reduce_text(R"(system driven
param m = 1 kg, l = 1 m, g = 9.81 m/s^2, b = 10 cm, w = 7 rad/s
coord x, y, X : length
point P mass m at (x, y)
point S mass m at (X, 0)
gravity (0, -g)
constraint (x - X)^2 + y^2 = l^2
constraint X = b cos(w t)
start x = 50 cm, y = -1 m
run 2 s
)"),
                1);
}

TEST_CASE("a rod that is turned: the distance along it") {
  const Reduced r = reduce_text(R"(system rod
param m = 50 g, Ω = 2 rad/s, r0 = 10 cm
coord x, y : length
point bead mass m at (x, y)
constraint y cos(Ω t) = x sin(Ω t)
start x = r0
run 1 s
)");
  check_reduced(r, 1);
  CHECK(has_line(r.reduction.text, "coord s : length"));
  // r = r0 cosh Ωt: Landau and Lifshitz §39.
  const ModelText small(r.reduction.text + "expect equation s'' = Ω^2 s\n");
  CHECK(small.model.experiment.expectations.size() == 1);
  const auto q = accelerations(small.equations);
  REQUIRE(q);
  CHECK(zero_test((*q)[0] - small.p("Ω") * small.p("Ω") * small.q(0)).verdict == Verdict::Zero);
}

TEST_CASE("velocity constraints stay; what is constant leaves a 0") {
  std::string text = rolling_disk;
  text.replace(text.find("coord x, y"), 10, "coord x, y, z");
  text.replace(text.find("y'^2)"), 5, "y'^2 + z'^2)");
  text += "constraint z = R\n";
  const Reduced r = reduce_text(text);
  REQUIRE_FALSE(r.reduction.text.empty());
  CHECK(r.reduction.proof->verdict == Sameness::Same);
  CHECK(r.reduction.dependent == std::vector<std::string>{"z"});
  const ModelText small(r.reduction.text);
  CHECK(small.system->constraints.size() == 2);
}

TEST_CASE("no closed form: the proposal and the reason") {
  const Reduced r = reduce_text(four_bar);
  CHECK(r.reduction.text.empty());
  CHECK(r.reduction.independent.size() == 1);
  CHECK(r.reduction.dependent.size() == 2);
  REQUIRE(r.diagnostics.has_errors());
  CHECK(r.diagnostics.items().back().code == "E0831");
  CHECK(r.diagnostics.items().back().help.find(r.reduction.independent[0]) != std::string::npos);
  CHECK(reduce_text(angle_pendulum).diagnostics.items()[0].code == "E0830");
  CHECK(reduce_text(rolling_disk).diagnostics.items()[0].code == "E0830");
}
