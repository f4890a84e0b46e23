#include "support.hpp"

#include <set>

using namespace maupertuis;

namespace {

const char* const double_pendulum = R"(system double_pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord θ1, θ2 : angle
point A mass m at l (sin θ1, -cos θ1)
point B mass m at A + l (sin θ2, -cos θ2)
gravity (0, -g)
)";

std::string hoop(const char* rate) {
  return std::string("system hoop\nparam m = 100 g, R = 30 cm, g = 9.81 m/s^2, Ω = ") + rate + R"(
coord θ : angle
let φ = Ω t
point bead mass m at R (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
)";
}

const char* const kepler = R"(system kepler
param m = 2 kg, k = 3 N m^2
coord r : length, φ : angle
T = 1/2 m (r'^2 + r^2 φ'^2)
V = -k/r
start r = 1.3 m, φ' = 0.7 rad/s
)";

double energy(const Linearized& m, const ModalEntry& e) {
  Bindings at = parameter_bindings(*m.system);
  for (std::size_t i = 0; i < m.start.q.size(); ++i) at[m.q(i)] = e.equilibrium.point.q[i], at[m.v(i)] = 0;
  return evaluate(expand_time_derivatives(m.equations.energy_function), at);
}

}  // namespace

TEST_CASE("A double pendulum has four equilibria; the lowest is stable, the others are not") {
  Linearized m(double_pendulum);
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() == 4);
  CHECK(study.translations.empty());
  CHECK(study.entries[0].equilibrium.point.q == std::vector<double>{0, 0});
  CHECK(study.entries[0].analysis.stability.verdict == Stability::Energetic);
  for (std::size_t i = 1; i < 4; ++i) {
    CHECK(energy(m, study.entries[i]) > energy(m, study.entries[i - 1]));
    CHECK(study.entries[i].analysis.stability.verdict == Stability::Unstable);
  }
  CHECK(point_text(*m.system, study.entries[3].equilibrium, {}) == "θ1 = π, θ2 = π");
}

TEST_CASE("The bead on the hoop leaves the lowest point above the critical rate") {
  const double critical = std::sqrt(9.81 / 0.3);
  Linearized slow(hoop("5 rad/s"));
  CHECK(slow.at.autonomous());  // t stands in the formulas and drops out of the equations
  const ModalStudy below = slow.study();
  REQUIRE(below.entries.size() == 2);
  CHECK(below.entries[0].equilibrium.point.q[0] == 0);
  CHECK(below.entries[0].analysis.stability.verdict == Stability::Energetic);
  Linearized fast(hoop("8 rad/s"));
  const ModalStudy above = fast.study();
  REQUIRE(above.entries.size() == 4);
  for (const ModalEntry& e : above.entries) {
    const double θ = e.equilibrium.point.q[0];
    const bool tilted = std::abs(std::sin(θ)) > 1e-9 && std::abs(θ) < 3;
    if (tilted) CHECK(near(std::cos(θ), critical * critical / 64, 1e-14));
    CHECK((e.analysis.stability.verdict == Stability::Energetic) == tilted);
  }
}

TEST_CASE("The circular orbit with the angular momentum of the start is a steady motion") {
  Linearized m(kepler);
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() == 1);
  const ModalEntry& e = study.entries[0];
  CHECK_FALSE(e.equilibrium.at_rest);
  REQUIRE(study.translations.size() == 1);
  CHECK(study.translations[0].conserved);
  const double momentum = 2 * 1.3 * 1.3 * 0.7, radius = momentum * momentum / (2 * 3);
  CHECK(near(e.equilibrium.point.q[0], radius, 1e-13));
  const double rate = momentum / (2 * radius * radius);
  CHECK(near(e.equilibrium.point.v[1], rate, 1e-13));
  // Perturbed Kepler orbits close: the radius swings as often as the planet goes round.
  const auto w = frequencies(e.analysis);
  REQUIRE(w.size() == 1);
  CHECK(near(w[0], rate, 1e-12));
  CHECK(e.analysis.stability.verdict == Stability::Energetic);
  CHECK(near(e.analysis.stability.hessian.front(), rate * rate, 1e-12));  // of the effective potential
}

TEST_CASE("Several coordinates that move together are one translation") {
  Linearized m(R"(system train
param m = 1 kg, k = 3 N/m
coord x1, x2, x3 : length
T = 1/2 m (x1'^2 + x2'^2 + x3'^2)
V = 1/2 k (x2 - x1)^2 + 1/2 k (x3 - x2)^2
)");
  const auto translations = m.at.translations();
  REQUIRE(translations.size() == 1);
  CHECK(translations[0].direction == std::vector<double>{1, 1, 1});
  CHECK(translations[0].conserved);
}

TEST_CASE("A motor runs steadily where friction takes what the supply gives") {
  Linearized m(R"(system motor
param Lm = 1 mH, R = 2 ohm, K = 0.05 N m/A, U = 12 V, J = 2e-5 kg m^2, b = 1e-4 N m s
coord q : charge, θ : angle
L = 1/2 Lm q'^2 + 1/2 J θ'^2 + K θ q'
D = 1/2 R q'^2 + 1/2 b θ'^2
force q = U
)");
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() == 1);
  const OperatingPoint& p = study.entries[0].equilibrium.point;
  CHECK(near(p.v[1], 0.05 * 12 / (2 * 1e-4 + 0.05 * 0.05), 1e-13));
  CHECK(near(p.v[0], 1e-4 * 12 / (2 * 1e-4 + 0.05 * 0.05), 1e-13));
  CHECK(study.entries[0].analysis.stability.verdict == Stability::Asymptotic);
}

TEST_CASE("Constrained equilibria with their multipliers") {
  Linearized m(cartesian_pendulum + "start x = 0.3 m, y = -0.6 m\n");
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() == 2);
  const ModalEntry& low = study.entries[0];
  CHECK(near(low.equilibrium.point.q[1], -0.7, 1e-14));
  CHECK(low.equilibrium.point.q[0] == 0);
  CHECK(near(low.equilibrium.point.multipliers[0], -2 * 9.81 / (2 * 0.7), 1e-13));  // m ÿ + m g = λ 2 y
  CHECK(low.linearization.independent == std::vector<std::size_t>{0});
  const auto w = frequencies(low.analysis);
  REQUIRE(w.size() == 1);
  CHECK(near(w[0], std::sqrt(9.81 / 0.7), 1e-13));
  CHECK(study.entries[1].analysis.stability.verdict == Stability::Unstable);
  CHECK(near(study.entries[1].analysis.stability.growth_rate, std::sqrt(9.81 / 0.7), 1e-13));
}

TEST_CASE("Angles that the equations tell apart are not one") {
  // A torsion spring winds up: θ and θ + 2π are different places.
  Linearized m(R"(system wound
param k = 1 N m, c = 8 N m, J = 1 kg m^2
coord θ : angle
T = 1/2 J θ'^2
V = 1/2 k θ^2 - c cos θ
)");
  CHECK_FALSE(m.at.periodic()[0]);
  const ModalStudy study = m.study();
  // θ = -8 sin θ has 0, ±π-ish and ±2π-ish roots: 5 of them.
  CHECK(study.entries.size() == 5);
  for (const ModalEntry& e : study.entries) {
    const double θ = e.equilibrium.point.q[0];
    CHECK(std::abs(θ + 8 * std::sin(θ)) < 1e-12);
  }
}

TEST_CASE("A translation that an input pushes along stays one while the input is zero") {
  const std::string free = "system puck\nparam m = 2 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n";
  Linearized pushed(free + "input u : [N] = 0\nforce x = u\n");
  const ModalStudy study = pushed.study();
  REQUIRE(study.translations.size() == 2);
  CHECK(study.translations[0].conserved);
  CHECK(study.translations[1].conserved);
  CHECK(study.entries.front().analysis.stability.verdict == Stability::Energetic);
  // The last is zero at all whole seconds.
  for (const char* const force : {"1 [N] sin(t/1 [s])", "1 [N]", "1 [N] sin(2 pi t/1 [s])"}) {
    CAPTURE(std::string(force));
    Linearized driven(free + "input u : [N] = " + force + "\nforce x = u\n");
    const auto translations = driven.at.translations({});
    REQUIRE(translations.size() == 2);
    CHECK_FALSE(translations[0].conserved);
    CHECK(translations[1].conserved);
  }
}

TEST_CASE("A spring is a spring however slowly it swings, and a translation is one however stiff what it carries") {
  for (const std::string stiffness : {"1", "1e-10", "1e-14", "1e-100", "1e-200", "1e-300"}) {
    CAPTURE(stiffness);
    const double k = std::stod(stiffness);
    Linearized m("system spring\nparam m = 1 kg, k = " + stiffness +
                 " N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\n");
    const ModalStudy study = m.study();
    REQUIRE(study.entries.size() == 1);
    CHECK(study.translations.empty());
    CHECK(study.entries[0].equilibrium.point.q[0] == 0);
    CHECK(near(study.entries[0].analysis.modes.at(0).frequency(), std::sqrt(k), 1e-14));
    CHECK(study.entries[0].analysis.stability.verdict == Stability::Energetic);
  }
  Linearized beside(
      "system beside\nparam m = 1 kg, k = 1 N/m, κ = 1e-11 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
      "V = 1/2 k x^2 + 1/2 κ y^2\nstart x = 1 m, y = 1 m\n");
  const ModalStudy both = beside.study();
  REQUIRE(both.entries.size() == 1);
  CHECK(both.translations.empty());
  CHECK(near(both.entries[0].analysis.modes.at(0).frequency(), std::sqrt(1e-11), 1e-12));
  Linearized pair(
      "system pair\nparam m = 1 kg, k = 1e12 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
      "V = 1/2 k (x - y)^2\nstart y = 1 m\n");
  CHECK(pair.study().translations.size() == 1);
  for (const std::string held : {"1e12", "1e14", "1e18"}) {  // the pair, on a spring that is rounding beside the other
    CAPTURE(held);
    Linearized ground("dimensionless\nparam K = " + held +
                      "\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 K (x - y)^2 - 1/2 x^2\nstart y = 1\n");
    const ModalStudy study = ground.study();
    CHECK(study.translations.empty());
    REQUIRE(study.entries.size() == 1);
    CHECK(study.entries[0].equilibrium.point.q == std::vector<double>{0, 0});
    const Mode& soft = study.entries[0].analysis.modes.at(0);
    const double K = std::stod(held);  // ω⁴ − (2 K + 1) ω² + K = 0
    CHECK(near(soft.frequency(), std::sqrt(2 * K / (2 * K + 1 + std::sqrt(4 * K * K + 1))), 1e-15));
    CHECK(study.entries[0].analysis.stability.verdict == Stability::Energetic);
  }
}

TEST_CASE("What has no equilibrium says so") {
  const auto first_code = [](Linearized& m, bool at) {
    Diagnostics told;
    const std::vector<StartValue> one{{0, 0, m.number(0.3), {}, {}}};
    const bool found =
        at ? modal_study_at(m.at, m.start, one, told).has_value() : modal_study(m.at, m.start, told).has_value();
    CHECK_FALSE(found);
    return told.items().empty() ? std::string() : told.items()[0].code;
  };
  Linearized fall("system fall\nparam m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n");
  CHECK(first_code(fall, false) == "E1301");
  Linearized driven(
      "system driven\nparam m = 1 kg, k = 1 N/m, F = 1 N, w = 2 rad/s\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k "
      "x^2\nforce x = F cos(w t)\n");
  CHECK(first_code(driven, false) == "E1303");
  Linearized pendulum(double_pendulum);
  CHECK(first_code(pendulum, true) == "E1302");
}

TEST_CASE("Places where coordinates fail are told, not linearized") {
  Linearized m(R"(system polar
param m = 1 kg, k = 1 N/m
coord r : length, φ : angle
T = 1/2 m (r'^2 + r^2 φ'^2)
V = 1/2 k r^2
)");
  Diagnostics told;
  const auto study = modal_study(m.at, m.start, told);
  REQUIRE(study);
  CHECK(study->entries.empty());
  REQUIRE_FALSE(told.items().empty());
  CHECK(told.items()[0].code == "W1301");
}

TEST_CASE("An equilibrium on a kink has the stiffness of each side, never one that is made up") {
  Linearized m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2 + 3/2 max(x, 0)^2\n");
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() == 2);
  CHECK(study.entries[0].side == "x > 0");
  CHECK(frequencies(study.entries[0].analysis) == std::vector<double>{2});
  CHECK(study.entries[1].side == "x < 0");
  CHECK(frequencies(study.entries[1].analysis) == std::vector<double>{1});
  // Pieces that agree to second order are one side; so does a kink elsewhere.
  for (const char* smooth :
       {"V = 1/2 x^2 + max(x, 0)^3", "V = 1/2 x^2 + max(x - 1, 0)", "V = 1/2 x^2\nD = abs(x')^3"}) {
    Linearized same(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\n") + smooth + "\n");
    const ModalStudy one = same.study();
    REQUIRE(one.entries.size() == 1);
    CHECK(one.entries[0].side.empty());
    CHECK(frequencies(one.entries[0].analysis) == std::vector<double>{1});
  }
}

TEST_CASE("Where all sides agree and the formula on the switch does not, the equations are those of the sides") {
  for (const char* damped : {"force x = -1/5 abs(x') sign(x')", "D = 1/10 sign(x)^2 x'^2"}) {
    Linearized m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 2 x^2\n") + damped + "\n");
    const ModalStudy study = m.study();
    REQUIRE(study.entries.size() == 1);
    CHECK(study.entries[0].side.empty());
    CHECK(study.entries[0].analysis.stability.verdict == Stability::Asymptotic);
    CHECK(study.entries[0].analysis.eigenvalues[0].real() == doctest::Approx(-0.1));
  }
}

TEST_CASE("Rest where a force jumps has no linearization") {
  for (const char* text :
       {"V = abs(x)", "V = 1/2 x^2 + abs(x)", "V = 1/2 x^2\nD = abs(x')", "V = 1/2 x^2\nforce x = -sign(x')"}) {
    Linearized m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\n") + text + "\n");
    Diagnostics diagnostics;
    CHECK_FALSE(modal_study(m.at, m.start, diagnostics));
    REQUIRE(diagnostics.items().size() == 1);
    CHECK(diagnostics.items()[0].code == "E1307");
  }
  // On one side alone: a ledge.
  Linearized ledge("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2 + max(x, 0)\n");
  const ModalStudy study = ledge.study();
  REQUIRE(study.entries.size() == 1);
  CHECK(study.entries[0].side == "x < 0");
  REQUIRE(study.kinks.size() == 1);
  CHECK(study.kinks[0].side == "x > 0");
}

TEST_CASE("Newton's method that runs away by 1e15 turns has found nothing: an arm has two places a link") {
  Linearized m(R"(system arm
param m1 = 4 kg, m2 = 3 kg, m3 = 1 kg, l1 = 50 cm, l2 = 40 cm, l3 = 20 cm, g = 9.81 m/s^2
coord θ1, θ2, θ3 : angle
frame shoulder at (0, 0) rotation angle θ1
frame elbow at (l1, 0) rotation angle θ2 in shoulder
frame wrist at (l2, 0) rotation angle θ3 in elbow
point A mass m1 at (l1/2, 0) in shoulder
point B mass m2 at (l2/2, 0) in elbow
point C mass m3 at (l3/2, 0) in wrist
force θ1 = -5 N m
force θ2 = 5 N m
gravity (0, -g)
start θ1 = -90 deg, θ2 = 30 deg, θ3 = 20 deg
)");
  const ModalStudy study = m.study();
  CHECK(study.entries.size() == 8);
  // Of the torque about each joint: what hangs beyond it.
  const double g = 9.81, first = 4 * 0.25 + 4 * 0.5, second = 3 * 0.2 + 1 * 0.4, third = 0.1;
  for (const ModalEntry& e : study.entries) {
    const std::vector<double>& q = e.equilibrium.point.q;
    const double a = g * first * std::cos(q[0]), b = g * second * std::cos(q[0] + q[1]),
                 c = g * third * std::cos(q[0] + q[1] + q[2]);
    CHECK(std::abs(c) < 1e-12);
    CHECK(std::abs(b + c - 5) < 1e-12);
    CHECK(std::abs(a + b + c + 5) < 1e-12);
  }
}

TEST_CASE("dry friction as a quotient has no value at rest, whatever else vanishes there") {
  Linearized m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nforce x = -0.3 x'/abs(x')\n");
  Diagnostics told;
  CHECK_FALSE(modal_study(m.at, m.start, told));
}

TEST_CASE("friction that pumps near the point alone keeps it from being called stable") {
  const auto verdict = [](const std::string& dissipation) {
    Linearized m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nD = " + dissipation + "\n");
    return m.here().analysis.stability.verdict;
  };
  CHECK(verdict("1/2 x^4 x'^2") == Stability::Energetic);
  for (const char* radius : {"1e-2", "1e-4", "1e-6", "1e-10"})
    CHECK(verdict(std::string("1/2 (x^4 - ") + radius + " x^2) x'^2") == Stability::Undecided);
  CHECK(verdict("-1/4 x'^4 sqrt(1e-6 - x^2)") == Stability::Undecided);  // real near the point alone
  CHECK(verdict("1/4 x'^4 sqrt(1e-6 - x^2)") == Stability::Energetic);
}

TEST_CASE("values that are given do not hide the family that a point belongs to") {
  Linearized sleigh(
      "dimensionless\ncoord x, y, ψ : number\nparam a = 0.3, I = 0.4, m = 2\n"
      "point C mass m at (x + a cos ψ, y + a sin ψ)\nT += 1/2 I ψ'^2\n"
      "constraint y' cos ψ - x' sin ψ = 0 name edge\nstart x' = 1\n");
  const ModalEntry e = sleigh.here({0});
  CHECK(e.equilibrium.family == 2);  // its direction and its speed
  CHECK(e.analysis.stability.verdict == Stability::Asymptotic);
  Linearized ring("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = (x^2 + y^2 - 1)^2\nstart x = 1\n");
  CHECK(ring.here().equilibrium.family == 1);
}

TEST_CASE("a coordinate that starts near zero is as large as the others of its dimension") {
  Linearized m(R"(dimensionless
coord x, y, u, v : number
point A mass 1 at (x, y)
point B mass 1 at (u, v)
gravity (0, -1)
constraint x^2 + y^2 = 1 name a
constraint (u-x)^2 + (v-y)^2 = 1 name b
start x = sin(2), y = -cos(2), u = sin(2)+sin(1), v = -cos(2)-cos(1)
)");
  std::vector<double> heights;
  for (const ModalEntry& e : m.study().entries) heights.push_back(e.equilibrium.point.q[3]);
  std::sort(heights.begin(), heights.end());
  REQUIRE(heights.size() == 4);  // hanging, twice folded, upright
  const double right[] = {-2, 0, 0, 2};
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(heights[i] - right[i]) < 1e-9);
}

TEST_CASE("Circular orbits in power potentials, of the momentum of the start: (k/φ')² = n + 2") {
  // V = ±k r^n: r^(n+2) = p²/(|n| m k), the frequency of r about it φ' sqrt(n + 2) (Goldstein, 3.6).
  for (const auto& [v, n] : {std::pair{"-k/sqrt(r)", -0.5},
                             {"-k/r^(3/2)", -1.5},
                             {"k r^(3/2)", 1.5},
                             {"k r^3", 3.0},
                             {"k r^4", 4.0},
                             {"-k/r", -1.0}}) {
    Linearized m(std::string("system k\ndimensionless\nparam m = 2, k = 3\ncoord r, φ : number\nT = 1/2 m (r'^2 + r^2 "
                             "φ'^2)\nV = ") +
                 v + "\nstart r = 1.1, φ' = 1\n");
    INFO(v);
    const ModalStudy study = m.study();
    REQUIRE(!study.entries.empty());
    const ModalEntry& first = study.entries.front();
    const double p = 2 * 1.1 * 1.1, r = std::pow(p * p / (std::abs(n) * 2 * 3), 1 / (n + 2));
    CHECK(near(first.equilibrium.point.q[0], r, 1e-9));
    CHECK(near(first.equilibrium.point.v[1], p / (2 * r * r), 1e-9));
    CHECK(first.analysis.stability.verdict == Stability::Energetic);
    CHECK(near(first.analysis.modes.back().frequency(), p / (2 * r * r) * std::sqrt(n + 2), 1e-9));
  }
}

TEST_CASE("a body that hangs by a quaternion has two families, below and above, and is stable below") {
  Linearized hanging(
      "param m = 1 kg, h = 100 mm, g = 9.81 m/s^2\nframe S rotation quaternion\n"
      "body B mass m inertia diag(0.02, 0.025, 0.01) kg m^2 at (0, 0, -h) in S\ngravity (0, 0, -g)\nstart S.qx = "
      "0.1\n");
  const ModalStudy study = hanging.study();
  REQUIRE(study.entries.size() == 2);
  for (const ModalEntry& e : study.entries) {
    CHECK(e.equilibrium.family == 1);  // the turn about the vertical
    const bool is_below = std::abs(e.equilibrium.point.q[1]) + std::abs(e.equilibrium.point.q[2]) < 1e-6;
    CHECK(e.analysis.stability.verdict == (is_below ? Stability::Energetic : Stability::Unstable));
  }
}

TEST_CASE("a wheel keeps its momentum where the body that carries it stops") {
  // p_γ = I (γ' + ω) with I = 2, ω = 10: γ' = 11 beside a body at rest, by angles and by a quaternion.
  for (const char* body : {"coord γ, θ : angle\nbody P mass 1 kg inertia 5 kg m^2 at (0, 0) rotation angle θ\n"
                           "body R mass 1 kg inertia 2 kg m^2 at (0, 0) rotation angle θ + γ\nV = 1/2 (1 [N m]) θ^2\n"
                           "start θ' = 10 rad/s, γ' = 1 rad/s\n",
                           "coord γ : angle\nbody P mass 1 kg inertia diag(100, 80, 50) kg m^2 rotation quaternion\n"
                           "body R mass 1 kg inertia diag(1, 1, 2) kg m^2 rotation axis (0, 0, 1) angle γ in P\n"
                           "V = 1/2 (1 [N m]) (P.qx^2 + P.qy^2 + P.qz^2)\nstart P.qz' = 5 [1/s], γ' = 1 rad/s\n"}) {
    Linearized m(body);
    const ModalStudy study = m.study();
    CHECK(std::any_of(study.entries.begin(), study.entries.end(), [](const ModalEntry& e) {
      return !e.equilibrium.at_rest && std::abs(e.equilibrium.point.v[0] - 11) < 1e-12;
    }));
  }
  Linearized still(
      "coord γ, θ : angle\nbody P mass 1 kg inertia 5 kg m^2 at (0, 0) rotation angle θ\n"
      "body R mass 1 kg inertia 2 kg m^2 at (0, 0) rotation angle θ + γ\nV = 1/2 (1 [N m]) θ^2\nstart θ' = 10 rad/s\n");
  CHECK(still.study().entries.size() == 2);  // at rest, and with γ' = 10
}

TEST_CASE("on a ring of rests a way across that only higher terms tell stays undecided") {
  const auto verdict = [](const std::string& rest) {
    Linearized ring("dimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\nV = (x^2 + y^2 - 1)^2 + " +
                    rest + "\nstart x = 1\n");
    return ring.here().analysis.stability.verdict;
  };
  CHECK(verdict("z^2") == Stability::Energetic);
  CHECK(verdict("-z^2") == Stability::Unstable);
  CHECK(verdict("-z^4") == Stability::Undecided);
  CHECK(verdict("z^4") == Stability::Undecided);
}

TEST_CASE("where coordinates fail but for rounding there is no linearization") {
  // sin²π is 1.5e-32 in numbers: no inertia of φ. Both poles of a spherical pendulum fail alike.
  for (const char* start : {"170 deg", "10 deg"}) {
    Linearized m(
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ, φ : angle\n"
        "point P mass m at l (sin θ cos φ, sin θ sin φ, cos θ)\ngravity (0, 0, -g)\nstart θ = " +
        std::string(start) + "\nrun 1 s\n");
    const ModalStudy study = m.study();
    CHECK(study.entries.empty());
    CHECK(study.failing.size() == 2);
  }
  // Beside the pole they hold: with the axis across, ω² = g/l for both ways.
  Linearized across(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ, φ : angle\n"
      "point P mass m at l (cos θ, sin θ cos φ, sin θ sin φ)\ngravity (0, 0, -g)\n"
      "start θ = 80 deg, φ = -80 deg\nrun 1 s\n");
  const ModalStudy study = across.study();
  REQUIRE_FALSE(study.entries.empty());
  for (const Mode& mode : study.entries.front().analysis.modes)
    CHECK(std::abs(mode.eigenvalue.imag()) == doctest::Approx(std::sqrt(9.81)).epsilon(1e-12));
}

TEST_CASE("a place of polar or spherical coordinates that has two names is told once, by the positive one") {
  const auto told = [](const std::string& text) {
    Linearized m("dimensionless\n" + text);
    std::vector<std::vector<double>> out;
    for (const ModalEntry& e : m.study().entries) out.push_back(e.equilibrium.point.q);
    return out;
  };
  const std::string plane = "coord r : number, φ : angle\n", start = "start r = 1, φ' = 0.7\n";
  const auto circle = told(plane + "L = 1/2 (r'^2 + r^2 φ'^2) - 1/2 r^2\n" + start);
  REQUIRE(circle.size() == 1);
  CHECK(near(circle[0][0], std::sqrt(0.7), 1e-12));  // r⁴ = (r² φ')²
  CHECK(told(plane + "point P mass 1 at (r cos φ, r sin φ)\nV = 1/2 r^2\n" + start).size() == 1);
  const auto sphere = told(
      "coord r : number, θ, φ : angle\n"
      "L = 1/2 (r'^2 + r^2 θ'^2 + r^2 sin^2 θ φ'^2) - 1/2 r^2\nstart r = 1, θ = pi/2, φ' = 0.7\n");
  REQUIRE(sphere.size() == 1);
  CHECK(sphere[0][0] > 0);
  CHECK(near(sphere[0][1], std::acos(0.0), 1e-12));
  CHECK(told("coord θ, φ : angle\nL = 1/2 (θ'^2 + sin^2 θ φ'^2) + cos θ\nstart θ = 1, φ' = 2\n").size() == 1);
  // Around two centres the radii are two coordinates, of which each has a second name.
  CHECK(told("coord r, s : number, φ, ψ : angle\nL = 1/2 (r'^2 + r^2 φ'^2 + s'^2 + s^2 ψ'^2) - 1/2 (r^2 + 2 s^2)\n"
             "start r = 1, s = 1, φ' = 0.7, ψ' = 0.3\n")
            .size() == 1);
}

TEST_CASE("mirror images that are other motions are told both") {
  const auto count = [](const std::string& text) {
    return Linearized("dimensionless\n" + text).study().entries.size();
  };
  CHECK(count("coord x : number\nL = 1/2 x'^2 - 1/4 (x^2 - 1)^2\nstart x = 1\n") == 3);
  // Both halves of a double cone, by the place and by the length of r.
  CHECK(count("coord r : number, φ : angle\npoint P mass 1 at (r cos φ, r sin φ, r)\nV = 1/2 r^2\n"
              "start r = 1, φ' = 0.7\n") == 2);
  CHECK(count("coord r : number, φ : angle\nL = 1/2 (2 r'^2 + r^2 φ'^2) - 1/2 r^2\nstart r = 1, φ' = 0.7\n") == 2);
  // z = r³: as in a plane at r = 0, and yet another place.
  CHECK(count("coord r : number, φ : angle\npoint P mass 1 at (r cos φ, r sin φ, r^3)\nV = 1/2 r^2\n"
              "start r = 1, φ' = 0.7\n") == 2);
}

TEST_CASE("places of a closed chain that are told close it, and none is where its links lie in one line") {
  // Newton's method leaves for angles of 1e14 rad on the way, and next to the dead centre q1 = π, q2 = q3 = 0 forces of
  // 1e9 N in the links balance their weight.
  Linearized m(R"(system fivebar
param m = 0.5 kg, a = 0.2 m, b = 0.3 m, d = 0.2 m, g = 9.81 m/s^2
coord q1, q2, q3, q4 : angle
body A1 mass m inertia 1/12 m a^2 at a/2 (cos q1, sin q1) rotation angle q1
body B1 mass m inertia 1/12 m b^2 at a (cos q1, sin q1) + b/2 (cos q2, sin q2) rotation angle q2
body A2 mass m inertia 1/12 m a^2 at (d, 0) + a/2 (cos q3, sin q3) rotation angle q3
body B2 mass m inertia 1/12 m b^2 at (d, 0) + a (cos q3, sin q3) + b/2 (cos q4, sin q4) rotation angle q4
constraint a cos q1 + b cos q2 = d + a cos q3 + b cos q4
constraint a sin q1 + b sin q2 = a sin q3 + b sin q4
gravity (0, -g)
start q1 = 120 deg, q3 = 60 deg, q2 = 45 deg, q4 = 135 deg
)");
  const ModalStudy study = m.study();
  CHECK(study.failing.empty());
  REQUIRE(study.entries.size() >= 8);
  for (const ModalEntry& e : study.entries) {
    const std::vector<double>& q = e.equilibrium.point.q;
    CHECK(std::abs(0.2 * std::cos(q[0]) + 0.3 * std::cos(q[1]) - 0.2 - 0.2 * std::cos(q[2]) - 0.3 * std::cos(q[3])) <
          1e-14);
    CHECK(std::abs(0.2 * std::sin(q[0]) + 0.3 * std::sin(q[1]) - 0.2 * std::sin(q[2]) - 0.3 * std::sin(q[3])) < 1e-14);
    for (const double force : e.equilibrium.point.multipliers) CHECK(std::abs(force) < 10);
  }
}

TEST_CASE("an arm of six joints rests where all its links are upright, and each family is told once") {
  Linearized m(R"(system arm
param m = 2 kg, l = 0.4 m, g = 9.81 m/s^2, I1 = 0.01 kg m^2, I2 = 0.02 kg m^2
coord q1, q2, q3, q4, q5 : angle
frame F1 at (0, 0, 0) rotation axis (0, 0, 1) angle q1
frame F2 at (l, 0, 0) rotation axis (0, 1, 0) angle q2 in F1
frame F3 at (l, 0, 0) rotation axis (0, 1, 0) angle q3 in F2
frame F4 at (l, 0, 0) rotation axis (1, 0, 0) angle q4 in F3
frame F5 at (l, 0, 0) rotation axis (0, 1, 0) angle q5 in F4
body B1 mass m inertia diag(I1, I2, I2) at (l/2, 0, 0) rotation axis (1, 0, 0) angle 0 in F1
body B2 mass m inertia diag(I1, I2, I2) at (l/2, 0, 0) rotation axis (1, 0, 0) angle 0 in F2
body B3 mass m inertia diag(I1, I2, I2) at (l/2, 0, 0) rotation axis (1, 0, 0) angle 0 in F3
body B4 mass m inertia diag(I1, I2, I2) at (l/2, 0, 0) rotation axis (1, 0, 0) angle 0 in F4
body B5 mass m inertia diag(I1, I2, I2) at (l/2, 0, 0) rotation axis (1, 0, 0) angle 0 in F5
gravity (0, 0, -g)
start q2 = 0.3 rad
)");
  const ModalStudy study = m.study();
  std::set<std::vector<long>> folded;  // which of the links point upwards
  for (const ModalEntry& e : study.entries) {
    const std::vector<double>& q = e.equilibrium.point.q;
    CHECK(std::abs(std::cos(q[1])) < 1e-12);
    CHECK(std::abs(std::sin(q[2])) < 1e-12);
    CHECK(std::abs(std::sin(q[4])) < 1e-12);
    folded.insert({std::lround(std::sin(q[1])), std::lround(std::cos(q[2])), std::lround(std::cos(q[4]))});
  }
  CHECK(folded.size() == study.entries.size());
}
