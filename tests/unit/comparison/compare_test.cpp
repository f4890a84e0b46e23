#include "../model_text.hpp"
#include "models.hpp"

#include <maupertuis/comparison.hpp>

#include <cmath>

using namespace maupertuis;
using namespace models;

namespace {

struct Compared {
  Comparison result;
  Diagnostics diagnostics;
  std::string text;  // of the diagnostics
};

Compared compare_texts(const std::string& a_text, const std::string& b_text, const std::string& map_text = {}) {
  const ModelText a(a_text), b(b_text);
  const SourceText map_source("map", map_text);
  Compared out;
  if (const auto map = read_map(a.model, b.source, map_source, out.diagnostics)) {
    const auto equations =
        euler_lagrange(std::shared_ptr<const MechanicalSystem>(map->b, &map->b->system), out.diagnostics);
    REQUIRE(equations);
    out.result = compare(a.model, a.equations, *map, *equations, {}, out.diagnostics);
  }
  out.text = render(out.diagnostics, map_source);
  return out;
}

void check_same(const Compared& c, bool proved = true) {
  INFO(c.text, " ", c.result.reason);
  CHECK(c.result.verdict == Sameness::Same);
  if (proved) CHECK(c.result.ground.error_bound < 1e-6);
  CHECK(c.result.freedoms_a == c.result.freedoms_b);
  CHECK(c.result.run.ran);
  CHECK(c.result.run.difference < 1e-12);  // two integrations that share no equation
  CHECK_FALSE(c.result.disagreement);
}

void check_different(const Compared& c) {
  INFO(c.text, " ", c.result.reason);
  CHECK(c.result.verdict == Sameness::Different);
  CHECK_FALSE(c.result.reason.empty());
  REQUIRE(c.result.disagreement);
  CHECK(std::abs(c.result.disagreement->of_a - c.result.disagreement->of_b) > 1e-6);
  CHECK(c.result.run.difference > 1e-3);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

const std::string cart_of_points = R"(system cart
param M = 2 kg, m = 0.5 kg, l = 0.6 m, g = 9.81 m/s^2
coord x : length, θ : angle
point cart mass M at (x, 0)
point bob mass m at cart + l (sin θ, -cos θ)
gravity (0, -g)
start θ = 10 deg
run 2 s
)";
const std::string cart_by_hand = R"(system hand
param M = 2 kg, m = 0.5 kg, l = 0.6 m, g = 9.81 m/s^2
coord x : length, θ : angle
T = 1/2 (M + m) x'^2 + m l cos θ x' θ' + 1/2 m l^2 θ'^2
V = -m g l cos θ
start θ = 10 deg
run 2 s
)";

}  // namespace

TEST_CASE("the pendulum in x, y and in θ, both ways") {
  check_same(compare_texts(cartesian_pendulum, angle_pendulum, "x = l sin θ, y = -l cos θ"));
  const Compared back = compare_texts(angle_pendulum, cartesian_pendulum, "θ = atan2(x, -y)");
  check_same(back, false);
  CHECK(back.result.ground.error_bound == 1);  // points on the constraint: evidence
  CHECK(back.result.energies == EnergyRelation::Equal);
}

TEST_CASE("energies that are equal for the signs of the parameters") {
  const std::string a = "system A\nparam m = 1 kg, c = 3 m/s, k = 2 N/m\ncoord x : length\n",
                    b = "start x = 1 m\nrun 1 s\n";
  const Compared c = compare_texts(a + "L = -m c^2 sqrt(1 - x'^2/c^2) - 1/2 k x^2\n" + b,
                                   a + "L = -sqrt(m^2 c^4 - m^2 c^2 x'^2) - 1/2 k x^2\n" + b);
  check_same(c);
  CHECK(c.result.energies == EnergyRelation::Equal);
}

TEST_CASE("an inverse map of a pendulum that turns over: whole turns do not count, other branches do") {
  const std::string over =
      replaced(cartesian_pendulum, "start x = 1 m, y' = 0, y = -1.7320508075688772 m", "start y = -l, x' = 12 m/s");
  check_same(compare_texts(angle_pendulum, over, "θ = atan2(x, -y)"), false);
  const Compared half = compare_texts(angle_pendulum, over, "θ = asin(x/l)");  // right below, wrong above
  CHECK(half.result.verdict == Sameness::Undecided);
  CHECK(half.result.run.difference > 0.1);
}

TEST_CASE("a wrong sign is found, with the accelerations at a state") {
  const Compared c = compare_texts(cart_of_points, replaced(cart_by_hand, "+ m l cos θ", "- m l cos θ"));
  check_different(c);
  // (M + m) x'' + m l θ'' cos θ = 0 and l θ'' + x'' cos θ + g sin θ = 0 at rest, with θ = 10 deg.
  const double s = std::sin(std::acos(-1.0) / 18), k = std::cos(std::acos(-1.0) / 18);
  const double x = 0.5 * 9.81 * s * k / (2 + 0.5 * s * s);
  REQUIRE(c.result.disagreement);
  CHECK(c.result.disagreement->of_a == doctest::Approx(x).epsilon(1e-12));
  CHECK(c.result.disagreement->of_b == doctest::Approx(-x).epsilon(1e-12));
  check_same(compare_texts(cart_of_points, cart_by_hand));
  check_different(compare_texts(angle_pendulum, replaced(angle_pendulum, "V = -m", "V = m")));
  check_different(
      compare_texts(cartesian_pendulum, replaced(angle_pendulum, "1/2 m l^2", "m l^2"), "x = l sin θ, y = -l cos θ"));
}

TEST_CASE("a map off the constraints is no description") {
  const Compared c = compare_texts(cartesian_pendulum, angle_pendulum, "x = l sin θ, y = -2 l cos θ");
  CHECK(c.result.verdict == Sameness::Different);
  CHECK(c.result.reason.find("rod") != std::string::npos);
  CHECK_FALSE(c.result.run.ran);
}

TEST_CASE("a rotating description: a rheonomic map; the energy functions differ, the motion does not") {
  const std::string inertial = R"(system inertial
param m = 1 kg, k = 4 N/m
coord x, y : length
T = 1/2 m (x'^2 + y'^2)
V = 1/2 k (x^2 + y^2)
start x = 1 m
run 5 s
)";
  const std::string rotating = R"(system rotating
param m = 1 kg, k = 4 N/m, Ω = 3 rad/s
coord u, v : length
T = 1/2 m ((u' - Ω v)^2 + (v' + Ω u)^2)
V = 1/2 k (u^2 + v^2)
start u = 1 m
run 5 s
)";
  const std::string map = "x = u cos(Ω t) - v sin(Ω t), y = u sin(Ω t) + v cos(Ω t)";
  const Compared c = compare_texts(inertial, rotating, map);
  check_same(c);
  CHECK(c.result.energies == EnergyRelation::Different);
  check_different(compare_texts(inertial, replaced(rotating, "(u' - Ω v)", "(u' + Ω v)"), map));
}

TEST_CASE("Lagrangians that differ by a total derivative, by a constant, by a factor") {
  const std::string given = R"(system given
param m = 1 kg, l = 2 m, g = 9.81 m/s^2
coord θ : angle
L = 1/2 m l^2 θ'^2 + m g l cos θ
start θ = 30 deg
run 5 s
)";
  check_same(compare_texts(angle_pendulum, given));
  // d/dt (m g l t sin² θ)
  const std::string gauge = "m g l cos θ + m g l (2 t sin θ cos θ θ' + sin^2 θ)";
  const Compared with_gauge = compare_texts(angle_pendulum, replaced(given, "m g l cos θ", gauge));
  check_same(with_gauge);
  CHECK(with_gauge.result.energies == EnergyRelation::Different);
  check_different(compare_texts(angle_pendulum, replaced(given, "m g l cos θ", replaced(gauge, "2 t", "t"))));
  const Compared shifted = compare_texts(angle_pendulum, replaced(given, "m g l cos θ", "m g l (cos θ - 1)"));
  check_same(shifted);
  CHECK(shifted.result.energies == EnergyRelation::EqualButConstant);
  // Thrice L: the virtual work differs, the accelerations do not.
  check_same(compare_texts(
      angle_pendulum, replaced(given, "L = 1/2 m l^2 θ'^2 + m g l cos θ", "L = 3 (1/2 m l^2 θ'^2 + m g l cos θ)")));
}

TEST_CASE("constrained against constrained: λ of A is eliminated") {
  // The double pendulum in x, y against itself in coordinates of the centre of mass and the rod.
  const std::string relative = R"(system relative
param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2
coord x1, y1, u, v : length
point A mass m1 at (x1, y1)
point B mass m2 at A + (u, v)
gravity (0, -g)
constraint x1^2 + y1^2 = l1^2
constraint u^2 + v^2 = l2^2
start x1 = l1, v = -1 m
run 2 s
)";
  check_same(compare_texts(double_pendulum, relative, "x2 = x1 + u, y2 = y1 + v"), false);
  check_same(compare_texts(relative, double_pendulum, "u = x2 - x1, v = y2 - y1"), false);
  const Compared wrong = compare_texts(double_pendulum, replaced(relative, "gravity (0, -g)", "gravity (0, -2 g)"),
                                       "x2 = x1 + u, y2 = y1 + v");
  check_different(wrong);
}

TEST_CASE("non-holonomic constraints: the disk by its heading, and turned by a right angle") {
  check_same(compare_texts(rolling_disk, rolling_disk));
  const std::string turned =
      replaced(replaced(rolling_disk, "constraint x' = R φ' cos ψ", "constraint x' = -R φ' sin ψ"),
               "constraint y' = R φ' sin ψ", "constraint y' = R φ' cos ψ");
  check_same(compare_texts(rolling_disk, turned, "ψ = ψ + pi/2"), false);
  check_same(compare_texts(rolling_disk, turned, "x = y, y = -x"), false);
  const Compared wrong = compare_texts(rolling_disk, turned);
  CHECK(wrong.result.verdict == Sameness::Different);
  CHECK(wrong.result.freedoms_a == 4);
  CHECK(wrong.result.instantaneous_freedoms_a == 2);
}

TEST_CASE("a body by a quaternion and by Euler angles") {
  const std::string quaternion = R"(system by_quaternion
param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2
body sat inertia diag(I1, I2, I3) rotation quaternion
start sat.ω = (0.01, 2, 0.01) rad/s
run 3 s
)";
  const std::string euler = R"(system by_angles
param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2
coord φ, θ, ψ : angle
body sat inertia diag(I1, I2, I3) rotation euler zxz (φ, θ, ψ)
start θ = 1 rad, φ' = 1 rad/s, ψ' = 0.5 rad/s
run 3 s
)";
  const std::string map =
      "sat.qw = cos(θ/2) cos((φ + ψ)/2), sat.qx = sin(θ/2) cos((φ - ψ)/2), "
      "sat.qy = sin(θ/2) sin((φ - ψ)/2), sat.qz = cos(θ/2) sin((φ + ψ)/2)";
  check_same(compare_texts(quaternion, euler, map));
  check_different(compare_texts(quaternion, euler, replaced(map, "sat.qz = ", "sat.qz = -")));
  check_different(compare_texts(quaternion, replaced(euler, "diag(I1, I2, I3)", "diag(I2, I1, I3)"), map));
  // Back: the angles are singular where the quaternion starts, which is said; the runs begin elsewhere.
  const Compared back = compare_texts(
      euler, quaternion,
      "θ = 2 atan2(sqrt(sat.qx^2 + sat.qy^2), sqrt(sat.qw^2 + sat.qz^2)), "
      "φ = atan2(sat.qz, sat.qw) + atan2(sat.qy, sat.qx), ψ = atan2(sat.qz, sat.qw) - atan2(sat.qy, sat.qx)");
  check_same(back, false);
  CHECK(back.result.degenerate.rfind("sat.qw = 1", 0) == 0);
}

TEST_CASE("fewer freedoms: a part, not the same") {
  const std::string free = R"(system free
param m = 1 kg, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
start x = 1 m
run 1 s
)";
  const std::string fall = R"(system fall
param m = 1 kg, g = 9.81 m/s^2
coord h : length
T = 1/2 m h'^2
V = m g h
run 1 s
)";
  const Compared c = compare_texts(free, fall, "x = 0, y = h");
  CHECK(c.result.verdict == Sameness::Part);
  CHECK(c.result.freedoms_a == 2);
  CHECK(c.result.freedoms_b == 1);
  const Compared back = compare_texts(fall, free, "h = y");
  CHECK(back.result.verdict == Sameness::Part);
  CHECK(back.result.rank == 1);
}

TEST_CASE("parameters: by name, by the map, by value, or different") {
  const std::string heavy = replaced(replaced(angle_pendulum, "m = 1 kg", "M = 1 kg"), "T = 1/2 m l^2 θ'^2\nV = -m",
                                     "T = 1/2 M l^2 θ'^2\nV = -M");
  const Compared by_value = compare_texts(angle_pendulum, heavy);
  CHECK(by_value.text.find("N0826") != std::string::npos);
  CHECK(by_value.result.verdict == Sameness::Same);  // the mass cancels
  const Compared mapped = compare_texts(angle_pendulum, heavy, "m = M");
  CHECK(mapped.diagnostics.empty());
  check_same(mapped);
  const Compared different = compare_texts(angle_pendulum, replaced(angle_pendulum, "l = 2 m", "l = 1 m"));
  CHECK(different.text.find("E0825") != std::string::npos);
  CHECK(different.text.find("`l` differs: 2 in polar (first), 1 in polar (second)") != std::string::npos);
  const auto unnamed = [](const std::string& text) { return replaced(text, "system polar\n", ""); };
  CHECK(compare_texts(unnamed(angle_pendulum), unnamed(heavy)).text.find("`m` is no name of the second model") !=
        std::string::npos);
  CHECK(compare_texts(unnamed(angle_pendulum), unnamed(replaced(angle_pendulum, "l = 2 m", "l = 1 m")))
            .text.find("2 in the first model, 1 in the second model") != std::string::npos);
}

TEST_CASE("maps that cannot be read") {
  const auto code = [](const std::string& map, const std::string& expected, const std::string& place) {
    const Compared c = compare_texts(cartesian_pendulum, angle_pendulum, map);
    INFO(map, "\n", c.text);
    REQUIRE(c.diagnostics.items().size() == 1);
    CHECK(c.diagnostics.items()[0].code == expected);
    if (!place.empty()) {
      REQUIRE(c.diagnostics.items()[0].span);
      const Span span = *c.diagnostics.items()[0].span;
      CHECK(map.substr(span.begin, span.end - span.begin) == place);
    }
  };
  code("x = l sin θ", "E0820", "");
  code("x = l sin θ, y = -l cos θ, w = 3", "E0821", "w");
  code("x = l sin θ, y = -cos θ", "E0822", "-cos θ");
  code("x = l sin θ, x = l, y = 0", "E0823", "x");
  code("x = l sin θ, y = l θ'", "E0824", "l θ'");
  code("x = l sin θ, x' = l θ', y = 0", "E0824", "x'");
  code("x = l sin α, y = -l cos θ", "E0201", "α");
  code("x = l sin θ, y = -l cos(θ", "E0106", "(");
  code("x = (l, l), y = 0", "E0824", "(l, l)");
  code("x = l sin(abs(θ)), y = -l cos θ", "E0824", "l sin(abs(θ))");
}

namespace {

std::string particle(const std::string& rest) {
  return "system particle\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n" + rest +
         "\nstart x = 1\nrun 1\n";
}

}  // namespace

TEST_CASE("motions that part in a branch far from the start are told apart") {
  const std::string plain = particle("V = x");
  for (const char* other : {"V = x\nforce x = max(x - 5, 0)^2 step(y - 7)", "V = x + max(x - 5, 0)^2 max(y - 7, 0)^2",
                            "V = x + piecewise(x > 40 and y < -70 : (x - 40)^2 (y + 70)^2, else : 0)",
                            "V = x\nforce y = step(exp(-100 (x - 3)^2) - 0.5)",
                            "V = x\nforce y = max(x - 5, 0) max(y - 7, 0) max(t - 90, 0)"}) {
    for (const bool turned : {false, true}) {
      const Compared c = turned ? compare_texts(particle(other), plain) : compare_texts(plain, particle(other));
      INFO(other, c.result.reason);
      CHECK(c.result.verdict == Sameness::Different);
      CHECK(c.result.disagreement);
    }
  }
}

TEST_CASE("the same branches written otherwise are the same, proved") {
  const Compared c = compare_texts(particle("V = max(x, 0)^2 + abs(y)"),
                                   particle("V = piecewise(x > 0 : x^2, else : 0) + max(y, -y)"));
  CHECK(c.result.verdict == Sameness::Same);
  CHECK(c.result.proved());
}

TEST_CASE("compare knows where energies are defined") {
  const std::string both = particle("V = log(x^2)"), right = particle("V = 2 log(x)");
  for (const bool turned : {false, true}) {
    const Compared c = turned ? compare_texts(right, both) : compare_texts(both, right);
    CHECK(c.result.verdict == Sameness::Part);
    CHECK_FALSE(c.result.proved());
    CHECK(c.result.reason.find("is defined at x = -") != std::string::npos);
  }
  CHECK(compare_texts(both, particle("V = 2 log(abs(x))")).result.proved());
}

TEST_CASE("evidence is no proof") {
  const Compared back = compare_texts(angle_pendulum, cartesian_pendulum, "θ = atan2(x, -y)");
  CHECK(back.result.verdict == Sameness::Same);
  CHECK_FALSE(back.result.proved());
  CHECK(compare_texts(cartesian_pendulum, angle_pendulum, "x = l sin θ, y = -l cos θ").result.proved());
}
