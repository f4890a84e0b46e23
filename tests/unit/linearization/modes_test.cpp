#include "support.hpp"

#include <numbers>

using namespace maupertuis;

TEST_CASE("Modes of the double pendulum have unit modal mass, and squares of frequencies as in Landau and Lifshitz") {
  Linearized m(R"(system double_pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord θ1, θ2 : angle
point A mass m at l (sin θ1, -cos θ1)
point B mass m at A + l (sin θ2, -cos θ2)
gravity (0, -g)
)");
  const ModalEntry e = m.here();
  CHECK(e.analysis.symmetric);
  const auto w = frequencies(e.analysis);
  REQUIRE(w.size() == 2);
  CHECK(near(w[0] * w[0], 9.81 * (2 - std::sqrt(2.0)), 1e-14));
  CHECK(near(w[1] * w[1], 9.81 * (2 + std::sqrt(2.0)), 1e-14));
  for (const Mode& mode : e.analysis.modes) {
    const auto& φ = mode.shape;
    const double modal_mass = (2.0 * std::norm(φ[0]) + 2 * (std::conj(φ[0]) * φ[1]).real() + std::norm(φ[1]));
    CHECK(near(modal_mass, 1, 1e-13));
  }
  CHECK(e.analysis.residual < 1e-14);
}

TEST_CASE("A molecule has a zero mode that is told as its translation") {
  Linearized m(R"(system molecule
dimensionless
param m = 1, M = 2.5, k = 3
coord x1, x2, x3 : number
T = m (x1'^2 + x3'^2)/2 + M x2'^2/2
V = k ((x2 - x1)^2 + (x3 - x2)^2)/2
)");
  const ModalEntry e = m.here();
  REQUIRE(e.analysis.modes.size() == 3);
  const Mode& zero = e.analysis.modes[0];
  CHECK(zero.kind == Mode::Kind::Zero);
  CHECK(zero.eigenvalue == 0.0);
  CHECK(zero.zeros == 2);
  CHECK(zero.cause == "translation along (x1, x2, x3)");
  CHECK(near(zero.shape[0].real(), 1 / std::sqrt(4.5), 1e-14));
  const auto w = frequencies(e.analysis);
  REQUIRE(w.size() == 2);
  CHECK(near(w[0] * w[0], 3, 1e-14));
  CHECK(near(w[1] * w[1], 5.4, 1e-14));
  CHECK(e.analysis.stability.verdict == Stability::Energetic);
}

TEST_CASE("Degenerate modes are told") {
  Linearized m(
      "system plane\nparam m = 1 kg, k = 4 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x^2 + y^2)\n");
  const ModalEntry e = m.here();
  REQUIRE(e.analysis.modes.size() == 2);
  CHECK(e.analysis.modes[0].multiplicity == 2);
  CHECK(near(e.analysis.modes[1].frequency(), 2, 1e-15));
}

TEST_CASE("A stiffness whose square is no double is no zero") {
  Linearized m("system stiff\ndimensionless\nparam k = 1e200\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 k x^2\n");
  const ModalEntry e = m.here();
  REQUIRE(e.analysis.modes.size() == 1);
  CHECK(near(e.analysis.modes[0].frequency(), 1e100, 1e-15));
  CHECK(e.analysis.stability.verdict == Stability::Energetic);
}

TEST_CASE("Damping ratios below and above the critical one") {
  const auto oscillator = [](double c) {
    return Linearized("system oscillator\nparam m = 2 kg, k = 8 N/m, c = " + std::to_string(c) +
                      " N s/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\n");
  };
  Linearized light = oscillator(0.8);  // ω0 = 2 rad/s, ζ = c / (2 m ω0) = 0.1
  const Mode damped = light.here().analysis.modes.at(0);
  CHECK(near(damped.damping_ratio(), 0.1, 1e-14));
  CHECK(near(damped.natural_frequency(), 2, 1e-14));
  CHECK(near(damped.frequency(), 2 * std::sqrt(0.99), 1e-14));
  Linearized heavy = oscillator(20);  // λ = −5 ± √21
  const ModalEntry over = heavy.here();
  REQUIRE(over.analysis.modes.size() == 2);
  CHECK(over.analysis.modes[0].kind == Mode::Kind::Decay);
  CHECK(near(over.analysis.modes[0].eigenvalue.real(), -5 + std::sqrt(21.0), 1e-13));
  CHECK(over.analysis.stability.verdict == Stability::Asymptotic);
}

TEST_CASE("A Foucault pendulum turns one way faster than the other") {
  Linearized m(R"(system foucault
param w0 = 2 rad/s, W = 0.3 rad/s, m = 1 kg
coord x, y : length
T = 1/2 m (x'^2 + y'^2)
V = 1/2 m w0^2 (x^2 + y^2)
L = T - V + m W (x y' - y x')
)");
  const ModalEntry e = m.here();
  CHECK_FALSE(e.analysis.symmetric);
  const auto w = frequencies(e.analysis);
  REQUIRE(w.size() == 2);
  const double mean = std::sqrt(4 + 0.09);
  CHECK(near(w[0], mean - 0.3, 1e-13));
  CHECK(near(w[1], mean + 0.3, 1e-13));
  for (const Mode& mode : e.analysis.modes) {  // circles: y a quarter of a turn beside x
    CHECK(mode.eigenvalue.real() == 0);
    CHECK(near(std::abs(mode.shape[0]), std::abs(mode.shape[1]), 1e-12));
    CHECK(std::abs((mode.shape[1] / mode.shape[0]).real()) < 1e-12);
  }
  CHECK(e.analysis.stability.verdict == Stability::Energetic);
}

TEST_CASE("A charge in a magnetic field: gyration, and zeros that do not drift") {
  Linearized m(
      "system charge\nparam m = 2 kg, B = 6 kg/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nL = T + 1/2 B (x y' - "
      "y x')\n");
  const ModalEntry e = m.here();
  const auto w = frequencies(e.analysis);
  REQUIRE(w.size() == 1);
  CHECK(near(w[0], 3, 1e-14));
  std::size_t zeros = 0;
  for (const Mode& mode : e.analysis.modes) zeros += mode.zeros;
  CHECK(zeros == 2);
}

TEST_CASE("Follower forces: a skew stiffness flutters") {
  // Two equal oscillators coupled by a circulatory force ±p: ω² = k ± i p
  Linearized m(R"(system flutter
param m = 1 kg, k = 4 N/m, p = 1 N/m
coord x, y : length
T = 1/2 m (x'^2 + y'^2)
V = 1/2 k (x^2 + y^2)
force x = p y
force y = -p x
)");
  const ModalEntry e = m.here();
  CHECK_FALSE(m.at.energy_never_grows());
  CHECK(e.analysis.stability.verdict == Stability::Unstable);
  CHECK(near(e.analysis.stability.growth_rate, std::sqrt(std::complex<double>(-4, 1)).real(), 1e-13));
  CHECK(near(e.linearization.circulatory.at(0, 1), -1, 1e-15));
}

namespace {

/// A top with its tip fixed, upright: Cardan angles, which do not fail there. A = 2, C = 1, m g l = 3.
std::string upright_top(double spin) {
  return R"(system top
param A = 2 kg m^2, C = 1 kg m^2, h = 3 N m
coord α, β, ψ : angle
T = 1/2 A (α'^2 cos^2 β + β'^2) + 1/2 C (ψ' + α' sin β)^2
V = h cos α cos β
start ψ' = )" +
         std::to_string(spin) + " rad/s\n";
}

}  // namespace

TEST_CASE("A sleeping top stands above ω = 2 √(A m g l)/C and falls below") {
  const double threshold = 2 * std::sqrt(6.0);
  Linearized fast(upright_top(threshold * 1.1));
  const ModalEntry standing = fast.here({2});
  const double w3 = fast.start.v[2], root = std::sqrt(w3 * w3 - 24);
  const auto w = frequencies(standing.analysis);
  REQUIRE(w.size() == 2);
  CHECK(near(w[0], (w3 - root) / 4, 1e-12));
  CHECK(near(w[1], (w3 + root) / 4, 1e-12));
  CHECK(standing.analysis.stability.verdict == Stability::Undecided);  // gyroscopic forces alone
  CHECK(standing.analysis.stability.hessian.front() < 0);
  Linearized slow(upright_top(threshold * 0.9));
  const ModalEntry falling = slow.here({2});
  CHECK(falling.analysis.stability.verdict == Stability::Unstable);
  CHECK(near(falling.analysis.stability.growth_rate, std::sqrt(24 - slow.start.v[2] * slow.start.v[2]) / 4, 1e-11));
}

TEST_CASE("An upright rolling disc: λ² = (4 g/r − 12 Ω²)/5") {
  const auto disc = [](double spin) {
    return R"(system disc
param m = 1 kg, r = 1 m, g = 1 m/s^2
coord x, y : length, q1, q2, q3 : angle
let u1 = q2', u2 = q3' + q1' sin q2, u3 = q1' cos q2
let Z = r cos q2
T = m (x'^2 + y'^2 + Z'^2)/2 + m r^2 (u1^2 + 2 u2^2 + u3^2)/8
V = m g Z
constraint x' - r (u2 cos q1 + u1 sin q1 cos q2) = 0
constraint y' - r (u2 sin q1 - u1 cos q1 cos q2) = 0
start x' = )" +
           std::to_string(spin) + " m/s, q3' = " + std::to_string(spin) + " rad/s\n";
  };
  Linearized fast(disc(0.8));
  const ModalEntry rolling = fast.here({4});
  CHECK_FALSE(rolling.equilibrium.at_rest);
  CHECK_FALSE(rolling.linearization.second_order());
  const auto w = frequencies(rolling.analysis);
  REQUIRE(w.size() == 1);
  CHECK(near(w[0], std::sqrt((12 * 0.64 - 4) / 5), 1e-12));
  Linearized slow(disc(0.4));
  const ModalEntry falling = slow.here({4});
  CHECK(falling.analysis.stability.verdict == Stability::Unstable);
  CHECK(near(falling.analysis.stability.growth_rate, std::sqrt((4 - 12 * 0.16) / 5), 1e-12));
}

TEST_CASE("A long chain of masses: 2 √(k/m) sin(j π/(2n + 2))") {
  constexpr int n = 40;
  std::string text = "system chain\ndimensionless\nparam k = 1\ncoord ", t, v = "x1^2";
  for (int i = 1; i <= n; ++i) {
    text += (i > 1 ? ", x" : "x") + std::to_string(i);
    t += (i > 1 ? " + x" : "x") + std::to_string(i) + "'^2";
    v += i < n ? " + (x" + std::to_string(i + 1) + " - x" + std::to_string(i) + ")^2"
               : " + x" + std::to_string(n) + "^2";
  }
  Linearized m(text + " : number\nT = 1/2 (" + t + ")\nV = k/2 (" + v + ")\n");
  const auto w = frequencies(m.here().analysis);
  REQUIRE(w.size() == n);
  for (int j = 1; j <= n; ++j)
    CHECK(near(w[static_cast<std::size_t>(j - 1)], 2 * std::sin(j * std::numbers::pi / (2 * n + 2)), 1e-12));
}

TEST_CASE("Where the stiffness grows without bound there is no linearization") {
  for (const char* const potential :
       {"1/2*x^2 + abs(x)^1.9", "abs(x)^1.5", "1/2*x^2 + max(0, x)^1.5", "1/2*x^2 + 0.1*x^2*log(x^2)"}) {
    CAPTURE(potential);
    Linearized m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = ") + potential + "\nstart x = 0.1\n");
    const auto study = modal_study(m.at, m.start, m.diagnostics);
    const std::string told = render(m.diagnostics, m.source);
    CAPTURE(told);
    CHECK(told.find("stiffness grows without bound") != std::string::npos);
    for (const ModalEntry& e : study ? study->entries : std::vector<ModalEntry>())
      for (const Mode& mode : e.analysis.modes) CHECK(std::abs(mode.eigenvalue) < 2);
  }
  for (const char* const potential : {"1/2*x^2 + abs(x)^2.5", "1/2*x^2 + max(0, x)^2", "1 - cos(x)"}) {
    Linearized m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = ") + potential + "\nstart x = 0.1\n");
    CHECK(!m.study().entries.empty());
    CHECK(render(m.diagnostics, m.source).empty());
  }
}

TEST_CASE("a linear system that gyroscopic forces hold is decided by its eigenvalues") {
  const auto verdict = [](const std::string& text) {
    Linearized m("dimensionless\n" + text);
    return m.study().entries.front().analysis.stability.verdict;
  };
  const auto penning = [&](const std::string& field) {
    return verdict("param B = " + field + ", w = 1\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\n" +
                   "V = 1/2 w^2 (z^2 - x^2/2 - y^2/2)\nU = -B/2 (x y' - y x')\n");
  };
  CHECK(penning("3") == Stability::Linear);  // B² > 2 w²
  CHECK(penning("1.41421") == Stability::Unstable);
  CHECK(penning("1.4142135623730951") == Stability::Linear);  // the next numbers of 17 digits about the limit √2
  CHECK(penning("1.4142135623730950") == Stability::Unstable);
  CHECK(penning("sqrt(2)") == Stability::Unstable);  // both frequencies meet in a Jordan chain
  // The same from forces instead of L, and in coordinates that a linear constraint ties.
  CHECK(verdict("coord x, y : number\nL = 1/2 (x'^2 + y'^2) + 1/4 (x^2 + y^2)\nforce x = 3 y'\nforce y = -3 x'\n") ==
        Stability::Linear);
  CHECK(verdict("coord x, y, z : number\nL = 1/2 (x'^2 + y'^2) + 1/4 (x^2 + y^2) + 3 x y'\n"
                "constraint z = x + 2 y\n") == Stability::Linear);
  // Beside the linear terms others: that is not said then.
  CHECK(verdict("coord x, y : number\nL = 1/2 (x'^2 + y'^2) + 1/4 (x^2 + y^2) + 3 x y' - x^4\n") ==
        Stability::Undecided);
  // Two pairs with the same frequencies: their energies have the same sign at each, and no chain is possible.
  CHECK(verdict("coord x, y, u, v : number\nL = 1/2 (x'^2 + y'^2 + u'^2 + v'^2) + 1/4 (x^2 + y^2 + u^2 + v^2) + 3 x y'"
                " + 3 u v'\n") == Stability::Linear);
  // Energies of both signs at one frequency: rounding does not tell a chain from none.
  CHECK(verdict("coord x, y : number\nL = 1/2 (x'^2 - x^2) - 1/2 (y'^2 - y^2)\n") == Stability::Undecided);
}
