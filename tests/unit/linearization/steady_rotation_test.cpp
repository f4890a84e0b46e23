#include "support.hpp"

using namespace maupertuis;

// Steady motions along rotations, against closed forms of textbooks and the same systems in angles.

namespace {

std::optional<Equilibrium> motion(Linearized& m) { return steady_rotation_near(m.at, m.start); }

ModalAnalysis modes_of(Linearized& m, const Equilibrium& x) {
  return modal_analysis(m.at, linearize(m.at, x.point).linearization, x.ways, &x);
}

std::string satellite(const char* start) {
  return std::string(
             "system satellite\nparam I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 2.5 kg m^2\n"
             "body sat inertia diag(I1, I2, I3) rotation quaternion\nstart sat.qw = 1, ") +
         start + "\n";
}

/// ω components on the body's axes at q = (1, 0, 0, 0): q̇ = ω / 2.
const char* const about[] = {"sat.qx' = 0.75 1/s", "sat.qy' = 0.75 1/s", "sat.qz' = 0.75 1/s"};

}  // namespace

TEST_CASE("A body that spins about a principal axis: Euler's closed form") {
  const double inertia[] = {1, 2, 2.5}, w = 1.5;
  for (std::size_t k = 0; k < 3; ++k) {
    Linearized m(satellite(about[k]));
    const auto found = motion(m);
    REQUIRE(found);
    CHECK(found->residual < 1e-13);
    CHECK(found->ways.size() == 1);
    // λ² = −ω² (I_k − I_i)(I_k − I_j) / (I_i I_j), and ±i ω of the axis, fixed in space, seen from the body.
    const double i = inertia[(k + 1) % 3], j = inertia[(k + 2) % 3], own = inertia[k];
    const double square = -w * w * (own - i) * (own - j) / (i * j);
    const ModalAnalysis modes = modes_of(m, *found);
    for (const double entry : linearize(m.at, found->point).linearization.damping.entries) CHECK(entry == 0);
    // The largest axis has the least energy of its momentum; at the smallest gyroscopic forces hold it.
    const Stability verdicts[] = {Stability::Undecided, Stability::Unstable, Stability::Energetic};
    CHECK(modes.stability.verdict == verdicts[k]);
    std::vector<double> expected{w};
    if (square < 0) expected.push_back(std::sqrt(-square));
    std::sort(expected.begin(), expected.end());
    const std::vector<double> got = frequencies(modes);
    REQUIRE(got.size() == expected.size());
    for (std::size_t f = 0; f < got.size(); ++f) CHECK(near(got[f], expected[f], 1e-12));
    if (square > 0) CHECK(near(modes.stability.growth_rate, std::sqrt(square), 1e-12));
  }
}

TEST_CASE("A body that spins about no principal axis does not move steadily") {
  Linearized m(satellite("sat.qy' = 0.75 1/s, sat.qz' = 0.4 1/s"));
  const auto found = motion(m);
  // Newton's method may go on to a motion that is one; the velocities that were asked for are not those.
  CHECK((!found || std::abs(found->point.v[3] - 0.4) > 0.01 || std::abs(found->point.v[2] - 0.75) > 0.01));
}

TEST_CASE("Regular precession of the heavy top, fast and slow, as in Euler's angles") {
  const double mgh = 0.1 * 0.03 * 9.81, axial = 6e-5, across = 5e-5 + 0.1 * 0.03 * 0.03, tilt = 0.4, spin = 200;
  for (const auto& [sign, off] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {1.0, 1e-6}, {-1.0, 1e-6}}) {
    // A Ω² cos θ − I3 ω3 Ω + m g h = 0
    const double a = across * std::cos(tilt), root = std::sqrt(axial * axial * spin * spin - 4 * a * mgh),
                 precession = (axial * spin + sign * root) / (2 * a);
    Linearized m(R"(system top
param m = 100 g, h = 3 cm, g = 9.81 m/s^2, I1 = 5e-5 kg m^2, I3 = 6e-5 kg m^2
frame spinning rotation quaternion
body top mass m inertia diag(I1, I1, I3) at (0, 0, h) in spinning
gravity (0, 0, -g)
)");
    const double c = std::cos(tilt / 2), s = std::sin(tilt / 2), y = precession * std::sin(tilt);
    m.start.q = {c, s, 0, 0};
    m.start.v = {0, 0, (c * y - s * spin) / 2, (c * spin + s * y) / 2};  // q ∘ (0, 0, ω2, ω3) / 2
    const double exact = m.start.v[2];
    m.start.v[2] *= 1 + off;  // Newton's method goes to a motion next to it
    const auto found = motion(m);
    REQUIRE(found);
    CHECK(found->residual < 1e-13);
    CHECK(near(found->point.v[2], exact, 1e-5));
    CHECK(found->ways.size() == 2);  // about the vertical and about the figure axis
    const double nutation =
        std::hypot(axial * spin / across - 2 * precession * std::cos(tilt), precession * std::sin(tilt));
    const ModalAnalysis modes = modes_of(m, *found);
    CHECK(modes.stability.verdict == Stability::Energetic);
    const std::vector<double> got = frequencies(modes);
    REQUIRE(got.size() == 1);
    CHECK(near(got.front(), nutation, std::max(1e-10, 30 * off)));
  }
}

TEST_CASE("A circular orbit in Cartesian coordinates: its epicyclic frequency") {
  for (const double p : {1.0, 0.5, -2.0}) {  // V = −μ m p / r^p; κ² = (2 − p) Ω²
    Linearized m("system orbit\nparam m = 2 kg, p = " + std::to_string(p) + R"(, μ = 1 m^2/s^2, l = 1 m
coord x, y, z : length
T = 1/2 m (x'^2 + y'^2 + z'^2)
V = -m μ p (l^2/(x^2 + y^2 + z^2))^(p/2)
start x = 1.3 m
)");
    const double rate = std::sqrt(p * p / std::pow(1.3, p + 2));
    m.start.v = {0, 1.3 * rate, 0};
    const auto found = motion(m);
    REQUIRE(found);
    CHECK(modes_of(m, *found).stability.verdict == Stability::Energetic);  // κ² > 0, with its angular momentum kept
    std::vector<double> expected{std::sqrt(2 - p) * rate, rate};           // in the plane; out of it
    std::sort(expected.begin(), expected.end());
    const std::vector<double> got = frequencies(modes_of(m, *found));
    REQUIRE(got.size() == 2);
    for (std::size_t f = 0; f < 2; ++f) CHECK(near(got[f], expected[f], 1e-11));
  }
}

TEST_CASE("An ion that circles in a magnetic field, where it could as well be moved along") {
  Linearized m(R"(system cyclotron
param m = 2 kg, b = 6 kg/s, k = 3 N/m
coord x, y, z : length
L = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 b (x y' - y x') - 1/2 k z^2
start x = 1 m
)");
  m.start.v = {0, -3, 0};  // b/m
  const auto found = motion(m);
  REQUIRE(found);
  CHECK(near(found->point.v[1], -3, 1e-12));
  const std::vector<double> got = frequencies(modes_of(m, *found));
  REQUIRE(!got.empty());
  CHECK(near(got.front(), std::sqrt(1.5), 1e-12));
  // Beside it a translation is one in a frame that turns: no zero.
  const ModalEntry entry = m.here({0, 1, 2});
  REQUIRE(entry.equilibrium.point.turning.rows == 3);
  for (const Mode& mode : entry.analysis.modes) CHECK(mode.cause.find("translation") == std::string::npos);
}

TEST_CASE("A circular orbit that falls in: κ² < 0 is growth") {
  Linearized m(R"(system orbit
param m = 2 kg, μ = 1 m^2/s^2, l = 1 m
coord x, y : length
T = 1/2 m (x'^2 + y'^2)
V = -3 m μ (l^2/(x^2 + y^2))^(3/2)
start x = 1.3 m
)");
  const double rate = 3 / std::pow(1.3, 2.5);
  m.start.v = {0, 1.3 * rate};
  const auto found = motion(m);
  REQUIRE(found);
  const ModalAnalysis modes = modes_of(m, *found);
  CHECK(modes.stability.verdict == Stability::Unstable);
  CHECK(near(modes.stability.growth_rate, rate, 1e-11));  // κ² = (2 − 3) Ω²
}

TEST_CASE("A ball that rolls along: a steady motion with velocity constraints") {
  Linearized m(R"(system ball
param m = 1 kg, r = 10 cm, I = 0.004 kg m^2
coord x, y : length
body ball mass m inertia diag(I, I, I) at (x, y, r) rotation quaternion
constraint x' - r ball.ω_world.y = 0
constraint y' + r ball.ω_world.x = 0
)");
  m.start.q[2] = 1;
  m.start.v = {1, 0, 0, 0, 5, 0};
  const auto found = motion(m);
  REQUIRE(found);
  const ModalAnalysis modes = modes_of(m, *found);
  CHECK(modes.stability.verdict != Stability::Unstable);
  CHECK(modes.stability.growth_rate == 0);
  m.start.v = {1, 0, 0, 0, 4, 0};  // slips
  const auto other = motion(m);
  CHECK((!other || std::abs(other->point.v[4] - 4) > 0.1 || std::abs(other->point.v[0] - 1) > 0.01));
}

TEST_CASE("What is measured beside a turning motion: rates of the body, not its place in space") {
  const ModelText text(satellite(about[2]));
  const Body& body = text.system->bodies.front();
  const Expr outputs[] = {body.angular_velocity[0], text.q(1)};
  const PointEquations at(text.equations, outputs);
  const auto found = steady_rotation_near(at, {0, {1, 0, 0, 0}, {0, 0, 0, 0.75}});
  REQUIRE(found);
  const Linearization l = linearize(at, found->point).linearization;
  for (std::size_t j = 0; j < l.measured.c.columns; ++j) CHECK(std::isfinite(l.measured.c.at(0, j)));
  CHECK(std::isnan(l.measured.c.at(1, 0)));  // qx of a neighbour swings in space
  // 2 q̄ q̇ at q = 1 + ε j, q̇ = ω k q / 2 is ω (k − 2 ε i); and 2 ε i at q = 1, q̇ = ω k / 2 + ε i.
  CHECK(l.independent == std::vector<std::size_t>{1, 2, 3});
  CHECK(near(l.measured.c.at(0, 1), -2 * 1.5, 1e-12));
  CHECK(near(l.measured.c.at(0, 3), 2, 1e-12));
}
