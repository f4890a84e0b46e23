#include "support.hpp"

#include <maupertuis/interrupt.hpp>

#include "analysis/orbits/verdict.hpp"

// Periods and multipliers that are known: elliptic integrals, Hill's determinant, Liouville, published digits.

using namespace maupertuis;

namespace {

const std::string pendulum =
    "system pendulum\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
    "gravity (0, -g)\nrun 10 s\n";

double period_of_pendulum(double amplitude) {
  return 4 * std::sqrt(2 / 9.81) * std::comp_ellint_1(std::sin(amplitude / 2));
}

/// x'' + (a − 2 q cos 2t) x = 0: the trace over π is 2 − 4 Δ(0) sin²(π√a/2) with Hill's determinant (Whittaker and
/// Watson, §19.42).
double trace_by_hill(double a, double q) {  // a < 0 as well: sin² becomes −sinh²
  constexpr int rows = 20000;
  // A tridiagonal determinant with unit diagonal, from the top: D_k = D_{k−1} − ξ_k ξ_{k−1} D_{k−2}.
  const auto xi = [&](int r) { return q / (4.0 * r * r - a); };
  double before = 1, now = 1;
  for (int r = -rows + 1; r <= rows; ++r) {
    const double next = now - xi(r) * xi(r - 1) * before;
    before = now;
    now = next;
  }
  const double half = std::numbers::pi * std::sqrt(std::abs(a)) / 2, s = a > 0 ? std::sin(half) : std::sinh(half);
  return 2 - 4 * now * std::copysign(s * s, a);
}

}  // namespace

TEST_CASE("the pendulum's period is found from its run, by the elliptic integral") {
  for (const double amplitude : {0.3, 1.0, 2.5}) {
    const FloquetResult r = floquet_of(ModelText(pendulum + "start θ = " + std::to_string(amplitude) + " rad\n"));
    CHECK(r.motion.period == doctest::Approx(period_of_pendulum(amplitude)).epsilon(1e-12));
    CHECK(r.motion.closure < 1e-13);
    CHECK(r.motion.moved < 1e-11);
    CHECK(r.trivial == 2);
    CHECK(r.multipliers.size() == 2);
    CHECK(*r.symplectic_residual < 1e-12);
    CHECK(r.stability == OrbitalStability::Neutral);
  }
}

TEST_CASE("a pendulum that runs over the top closes after a turn") {
  const FloquetResult r = floquet_of(ModelText(pendulum + "start θ' = 6 rad/s\n"));
  CHECK(r.motion.turns[0] == 1);
  const double k = 2 * std::sqrt(9.81 / 2) / 6;  // T = 2 k √(l/g) K(k) with k² = 4 g / (l θ'²)
  CHECK(r.motion.period == doctest::Approx(2 * k * std::sqrt(2 / 9.81) * std::comp_ellint_1(k)).epsilon(1e-12));
}

TEST_CASE("the Cartesian pendulum has the same period and no other multipliers") {
  const FloquetResult r = floquet_of(
      ModelText("system p\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\n"
                "gravity (0, -g)\nconstraint x^2 + y^2 = l^2\nstart x = 2 [m] sin(1), y = -2 [m] cos(1)\nrun 10 s\n"));
  CHECK(r.multipliers.size() == 2);
  CHECK(r.motion.period == doctest::Approx(period_of_pendulum(1)).epsilon(1e-11));
  CHECK(*r.symplectic_residual < 1e-11);
}

TEST_CASE("a double pendulum's orbit: coupled through cos(a - b), whose slope vanishes on the way, and yet neutral") {
  const FloquetResult r = floquet_of(ModelText(
      "system dp\ndimensionless\ncoord a, b : angle\n"
      "L = a'^2 + 1/2 b'^2 + a' b' cos(a - b) + 9.81 (2 cos a + cos b)\nstart a = 0.5875, b = 0.8307\nrun 10\n"));
  CHECK(r.stability == OrbitalStability::Neutral);
  CHECK(std::abs(r.largest - 1) < 1e-10);
  CHECK(*r.symplectic_residual < 1e-13);
  CHECK(*r.error < 1e-13);
}

TEST_CASE("the verdict hears what the geometry says") {
  FloquetResult r;
  r.multipliers = {{0.9, 0}, {0.5, 0}, {1, 0}};
  r.trivial = 1;
  r.largest = 0.9;
  CHECK(orbits::stability_of(r) == OrbitalStability::Attracting);  // constraints between velocities: nothing to ask
  r.integrated_divergence = r.log_determinant = std::log(0.45);
  r.error = 1e-13;
  CHECK(orbits::stability_of(r) == OrbitalStability::Attracting);
  r.integrated_divergence = 0.0;  // volumes stay: nothing attracts
  CHECK(orbits::stability_of(r) == OrbitalStability::Undecided);
  r.integrated_divergence = 0.1;
  CHECK(orbits::stability_of(r) == OrbitalStability::Undecided);
  r.integrated_divergence = std::log(0.45);
  r.symplectic_residual = 1e-14;
  CHECK(orbits::stability_of(r) == OrbitalStability::Undecided);
  r.largest = 1 - 1e-7;  // a defective pair
  CHECK(orbits::stability_of(r) == OrbitalStability::Neutral);
  r.error = 1e-9;
  CHECK(orbits::stability_of(r) == OrbitalStability::Undecided);
  r.largest = 1.5;
  CHECK(orbits::stability_of(r) == OrbitalStability::Unstable);
  r.largest = 1 + 1e-4;  // within 10 √error
  CHECK(orbits::stability_of(r) == OrbitalStability::Undecided);
  Diagnostics diagnostics;
  orbits::warn_of_error(r, diagnostics);
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items().front().code == "W1402");
  r.error = 1e-11;
  orbits::warn_of_error(r, diagnostics);
  CHECK(diagnostics.items().size() == 1);
}

TEST_CASE("forces that could have been a potential let nothing attract either") {
  // Two equal oscillators by forces: dΦ has a defective pair beside it, whose rounding is √ε.
  const FloquetResult r = floquet_of(
      ModelText("system f\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
                "force x = -x - x (x^2 + y^2)\nforce y = -y - y (x^2 + y^2)\nstart x = 0.7, y' = 0.4\nrun 30\n"),
      {});
  CHECK_FALSE(r.symplectic_residual);
  CHECK(*r.integrated_divergence == 0);
  CHECK(r.stability == OrbitalStability::Neutral);
}

TEST_CASE("Mathieu's equation: the trace by Hill's determinant, stable and unstable") {
  for (const auto& [a, q, stable] :
       {std::tuple{2.0, 0.5, true}, std::tuple{1.0, 0.3, false}, std::tuple{6.5, 2.0, true}}) {
    const FloquetResult r = floquet_of(ModelText("system mathieu\ndimensionless\nparam a = " + std::to_string(a) +
                                                 ", q = " + std::to_string(q) +
                                                 "\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (a - 2 q cos(2 t)) x^2\n"));
    CHECK(r.motion.driven);
    CHECK(r.motion.period == doctest::Approx(std::numbers::pi).epsilon(1e-15));
    CHECK(r.trivial == 0);
    CHECK(r.trace == doctest::Approx(trace_by_hill(a, q)).epsilon(1e-9));
    CHECK((r.stability == OrbitalStability::Neutral) == stable);
    CHECK(std::abs(r.multipliers[0] * r.multipliers[1] - 1.0) < 1e-12);
  }
}

TEST_CASE("van der Pol's limit cycle: the published period, the multiplier by Liouville") {
  const FloquetResult r =
      floquet_of(ModelText("system vdp\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
                           "force x = (1 - x^2) x'\nstart x = 1.5\nrun 30\n"));
  CHECK(r.motion.period == doctest::Approx(6.663286859323130).epsilon(1e-12));
  CHECK(r.trivial == 1);
  CHECK(r.stability == OrbitalStability::Attracting);
  CHECK(std::log(r.largest) == doctest::Approx(*r.integrated_divergence).epsilon(1e-9));
  CHECK(*r.log_determinant == doctest::Approx(*r.integrated_divergence).epsilon(1e-9));
  CHECK_FALSE(r.symplectic_residual);
}

TEST_CASE("Arenstorf's orbit: the published period, unstable, multipliers in a reciprocal pair") {
  const FloquetResult r =
      floquet_of(ModelText("system arenstorf\ndimensionless\nparam μ = 0.012277471\ncoord x, y : number\n"
                           "let r1 = sqrt((x + μ)^2 + y^2), r2 = sqrt((x - 1 + μ)^2 + y^2)\n"
                           "L = 1/2 (x'^2 + y'^2) + x y' - y x' + 1/2 (x^2 + y^2) + (1 - μ)/r1 + μ/r2\n"
                           "start x = 0.994, y' = -2.00158510637908252240537862224\n"),
                 {.period = 17.0652165601579625588917206249});
  CHECK(r.motion.period == doctest::Approx(17.0652165601579626).epsilon(1e-9));
  CHECK(r.trivial == 2);
  CHECK(r.stability == OrbitalStability::Unstable);
  CHECK(std::abs(r.multipliers[0] * r.multipliers[1] - 1.0) < 1e-6);
  CHECK(r.trace - 2 == doctest::Approx((r.multipliers[0] + r.multipliers[1]).real()).epsilon(1e-6));
}

TEST_CASE(
    "a resonantly driven damped oscillator: Newton finds the one periodic motion, its multipliers are those of the "
    "damping") {
  const FloquetResult r = floquet_of(
      ModelText("system driven\ndimensionless\nparam c = 0.2, w = 1.3\ncoord x : number\ninput u = cos(w t)\n"
                "T = 1/2 x'^2\nV = 1/2 x^2\nD = 1/2 c x'^2\nforce x = u\n"));
  // x = Re A e^{iwt}, A = 1/(1 − w² + i c w)
  const std::complex<double> amplitude = 1.0 / std::complex<double>(1 - 1.69, 0.26);
  CHECK(r.motion.start.q[0] == doctest::Approx(amplitude.real()).epsilon(1e-13));
  CHECK(r.motion.start.v[0] == doctest::Approx(-1.3 * amplitude.imag()).epsilon(1e-13));
  CHECK(r.largest == doctest::Approx(std::exp(-0.1 * r.motion.period)).epsilon(1e-13));
  CHECK(r.stability == OrbitalStability::Attracting);
}

TEST_CASE("Kapitza's pendulum: an equilibrium of a driven system has multipliers, by Hill's determinant") {
  const auto kapitza = [](const std::string& rest) {
    return ModelText(
        "system kapitza\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2, a = 0.1 m\ncoord θ : angle\n"
        "gravity (0, -g)\nrun 2 s\n" +
        rest);
  };
  const std::string point = "point P mass m at (l sin θ, a cos(Ω t) - l cos θ)\n";
  for (const double w : {100.0, 40.0})
    for (const bool up : {false, true}) {
      CAPTURE(w);
      CAPTURE(up);
      const FloquetResult r = floquet_of(
          kapitza("param Ω = " + std::to_string(w) + " rad/s\n" + point + "start θ = " + (up ? "pi" : "0") + "\n"));
      CHECK(r.motion.rests);
      CHECK(r.trace == doctest::Approx(trace_by_hill((up ? -4 : 4) * 9.81 / (w * w), 0.2))
                           .epsilon(1e-7));  // of the rows of the determinant
      CHECK(r.stability ==
            (up && w < 44 ? OrbitalStability::Unstable : OrbitalStability::Neutral));  // a Ω against √(2 g l)
    }
}

TEST_CASE("equilibria of a driven system are judged by multipliers, not by frozen frequencies") {
  const auto verdicts = [](double w, const std::string& more) {
    const ModelText m(
        "system kapitza\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2, a = 0.1 m\ncoord θ : angle\nparam Ω = " +
        std::to_string(w) + " rad/s\npoint P mass m at (l sin θ, a cos(Ω t) - l cos θ)\ngravity (0, -g)\n" + more);
    const PointEquations points(m.equations);
    Diagnostics told;
    auto study = modal_study(points, {0, {0.0}, {0.0}}, told);
    REQUIRE(study);
    REQUIRE(study->entries.size() == 2);
    const auto neighbours = settle_driven(*study, points, m.model, m.equations, nullptr);
    std::vector<Stability> out;
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(neighbours[i].has_value());
      CHECK(study->entries[i].analysis.modes.empty());
      out.push_back(study->entries[i].analysis.stability.verdict);
    }
    return out;  // hanging, upright
  };
  CHECK(verdicts(100, "") == std::vector{Stability::Undecided, Stability::Undecided});
  CHECK(verdicts(40, "") == std::vector{Stability::Undecided, Stability::Unstable});
  const std::string friction = "D = 0.1 [N m s] θ'^2\n";
  CHECK(verdicts(100, friction) == std::vector{Stability::Asymptotic, Stability::Asymptotic});
  CHECK(verdicts(40, friction) == std::vector{Stability::Asymptotic, Stability::Unstable});
}

TEST_CASE("along a sweep a driven system is judged by multipliers: the tongue of Mathieu's equation about a = 1") {
  const ModelText m(
      "dimensionless\nparam a = 1, ε = 0.5, c = 0\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (a + ε cos(2 t)) x^2\n"
      "D = 1/2 c x'^2\n");
  const auto sweep = [&](std::size_t parameter, double from, double to, std::size_t steps, const StopFlag* flag) {
    PointEquations points(m.equations);
    return parameter_locus(points, {0, {0.0}, {0.0}}, parameter, from, to, steps,
                           driven_neighbours(m.model, m.equations, parameter, flag));
  };
  // McLachlan 1947, §2.151, with q = ε/2: a₁ and b₁ = a₁(−q).
  const auto border = [](double q) {
    return 1 + q - q * q / 8 - std::pow(q, 3) / 64 - std::pow(q, 4) / 1536 + 11 * std::pow(q, 5) / 36864;
  };
  const Locus tongue = sweep(0, 0.5, 1.5, 9, nullptr);
  REQUIRE(tongue.branches.size() == 1);
  CHECK(tongue.driven);
  REQUIRE(tongue.changes.size() == 2);
  CHECK(tongue.changes[0].parameter == doctest::Approx(border(-0.25)).epsilon(1e-7));
  CHECK(tongue.changes[1].parameter == doctest::Approx(border(0.25)).epsilon(1e-7));
  CHECK(tongue.changes[0].after == Stability::Unstable);
  for (const LocusPoint& x : tongue.branches[0].points) {  // the exponents of a Lagrangian are opposite in pairs
    REQUIRE(x.eigenvalues.size() == 2);
    CHECK(std::abs(x.eigenvalues[0].real() + x.eigenvalues[1].real()) < 1e-12);
  }
  // One value of the sweep inside a range that is not decided has borders on both sides.
  const Locus gap = sweep(0, 1.2, -0.3, 3, nullptr);
  CHECK(gap.changes.size() == 2);
  // Narrower than the step: the tongue about a = 4, 4 − q²/12 … 4 + 5 q²/12 (§2.151), and that about a = 9, 0.0005
  // wide.
  const Locus narrow = sweep(0, 2.5, 11.5, 10, nullptr);
  REQUIRE(narrow.changes.size() == 4);
  const double q2 = 0.25 * 0.25, q4 = q2 * q2;
  CHECK(narrow.changes[0].parameter == doctest::Approx(4 - q2 / 12 + 5 * q4 / 13824).epsilon(1e-7));
  CHECK(narrow.changes[1].parameter == doctest::Approx(4 + 5 * q2 / 12 - 763 * q4 / 13824).epsilon(1e-6));
  for (const int side : {0, 1})
    CHECK(narrow.changes[static_cast<std::size_t>(2 + side)].parameter ==
          doctest::Approx(9 + q2 / 16 + (2 * side - 1) * 0.25 * q2 / 64 + 13 * q4 / 20480).epsilon(1e-7));
  CHECK(sweep(0, 4.2, 8.7, 6, nullptr).changes.empty());
  // At a = 1 damping c wins where it is above ε/2, nearly.
  const Locus damped = sweep(2, 0.01, 0.5, 5, nullptr);
  REQUIRE(damped.changes.size() == 1);
  CHECK(damped.changes[0].after == Stability::Asymptotic);
  CHECK(damped.changes[0].parameter == doctest::Approx(0.25).epsilon(0.02));
  const StopFlag stop(true);
  CHECK_THROWS_AS(sweep(0, 0.5, 1.5, 9, &stop), Interrupted);
}

TEST_CASE("windows of Meissner's equation, in the first and the last step of a sweep too") {
  // Over each half of the period a constant stiffness, p² and r² = a ± ε; at the borders the trace is ± 2.
  const ModelText m(
      "dimensionless\nparam a = 0.3, ε = 0.05\ncoord x : number\nT = 1/2 x'^2\n"
      "V = 1/2 (a + ε sign(sin t)) x^2\n");
  const auto trace = [](double a) {
    const double p = std::sqrt(a + 0.05), r = std::sqrt(a - 0.05), u = p * std::numbers::pi, v = r * std::numbers::pi;
    return 2 * std::cos(u) * std::cos(v) - (p / r + r / p) * std::sin(u) * std::sin(v);
  };
  const auto changes = [&](double from, double to, std::size_t steps) {
    PointEquations points(m.equations);
    return parameter_locus(points, {0, {0.0}, {0.0}}, 0, from, to, steps,
                           driven_neighbours(m.model, m.equations, 0, nullptr))
        .changes;
  };
  for (const auto& [from, to, steps] : {std::tuple(0.98, 1.6, 3), std::tuple(0.6, 1.03, 3), std::tuple(1.03, 0.6, 3)}) {
    CAPTURE(from);
    const auto found = changes(from, to, static_cast<std::size_t>(steps));
    REQUIRE(found.size() == 2);
    for (const StabilityChange& c : found) CHECK(trace(c.parameter) == doctest::Approx(2).epsilon(1e-11));
    CHECK(found[0].parameter == doctest::Approx(0.999375113).epsilon(1e-8));
    CHECK(found[1].parameter == doctest::Approx(1.001871).epsilon(1e-6));
  }
}

TEST_CASE("where a sweep takes the drive away the system is judged without it, and where it begins with it") {
  // Off resonance, damped: stable with and without the drive, also where the model itself has none.
  for (const char* strength : {"0", "0.3"}) {
    CAPTURE(strength);
    const ModelText m(std::string("dimensionless\nparam e = ") + strength +
                      "\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (0.7 + e cos t) x^2\nD = 1/2*0.1 x'^2\n");
    PointEquations points(m.equations);
    const Locus locus =
        parameter_locus(points, {0, {0.0}, {0.0}}, 0, 0, 0.2, 3, driven_neighbours(m.model, m.equations, 0, nullptr));
    REQUIRE(locus.branches.size() == 1);
    CHECK(locus.changes.empty());
    for (const LocusPoint& x : locus.branches[0].points) CHECK(x.stability.verdict == Stability::Asymptotic);
  }
  // In the tongue about ω² = 1/4 the drive makes it unstable, though the model has none.
  const ModelText m(
      "dimensionless\nparam e = 0\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (0.25 + e cos t) x^2\nD = 1/2*0.1 x'^2\n");
  PointEquations points(m.equations);
  const Locus locus =
      parameter_locus(points, {0, {0.0}, {0.0}}, 0, 0, 0.4, 5, driven_neighbours(m.model, m.equations, 0, nullptr));
  REQUIRE(locus.changes.size() == 1);
  CHECK(locus.changes[0].before == Stability::Asymptotic);
  CHECK(locus.changes[0].after == Stability::Unstable);
  CHECK(locus.changes[0].parameter == doctest::Approx(0.1).epsilon(0.03));  // e = 2 ω c, nearly
}

TEST_CASE("a bead on a turning hoop has no drive: its equation has no t") {
  const std::string hoop =
      "param m = 1 kg, R = 0.5 m, g = 9.81 m/s^2, Ω = 3 rad/s\ncoord θ : angle\n"
      "point P mass m at R (sin θ cos(Ω t), sin θ sin(Ω t), -cos θ)\ngravity (0, 0, -g)\nstart θ = 1 rad\nrun 5 s\n";
  // θ'² = 2 (U(1) − U(θ)), U = −g/R cos θ − Ω²/2 sin²θ, with θ = sin φ; the trapezoidal rule converges exponentially.
  const auto potential = [](double θ) { return -19.62 * std::cos(θ) - 4.5 * std::sin(θ) * std::sin(θ); };
  double period = 0;
  constexpr int nodes = 200;
  for (int k = 0; k < nodes; ++k) {
    const double φ = (k + 0.5) * 2 * std::numbers::pi / nodes, θ = std::sin(φ);
    period += 2 * std::numbers::pi / nodes * std::abs(std::cos(φ)) / std::sqrt(2 * (potential(1) - potential(θ)));
  }
  const FloquetResult r = floquet_of(ModelText(hoop)), near = floquet_of(ModelText(hoop), {.period = 1.5});
  CHECK_FALSE(r.motion.driven);
  CHECK(r.trivial == 2);
  CHECK(r.motion.period == doctest::Approx(period).epsilon(1e-11));
  CHECK(near.motion.period == doctest::Approx(period).epsilon(1e-11));
}

TEST_CASE("a drive of no strength is none; a driven motion that has come to rest is an equilibrium") {
  const std::string text =
      "dimensionless\nparam F = 0, w = 3\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
      "force x = F cos(w t)\nstart x = 1\nrun 10\n";
  CHECK(floquet_of(ModelText(text)).motion.period == doctest::Approx(2 * std::numbers::pi).epsilon(1e-13));
  const FloquetResult r =
      floquet_of(ModelText("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (2 + cos(3 t)) x^2\nD = 0.1 x'^2\n"
                           "start x = 1\nrun 10\n"));
  CHECK(r.motion.driven);
  CHECK(r.motion.rests);
}

TEST_CASE("the period is the shortest after which a motion repeats") {
  // Of two oscillators with the frequencies 1 and √2 the pure one that lies next to the start.
  const FloquetResult pure =
      floquet_of(ModelText("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + 2 y^2)\nstart x = "
                           "0.5, y = 0.3\nrun 100\n"));
  CHECK(pure.motion.period == doctest::Approx(std::sqrt(2) * std::numbers::pi).epsilon(1e-12));
  CHECK(pure.multipliers[0].real() == doctest::Approx(std::cos(std::sqrt(2) * std::numbers::pi)).epsilon(1e-10));
  const FloquetResult driven = floquet_of(
      ModelText("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = x^2\nD = 0.1 x'^2\nforce x = sin(t)^2\nrun 10\n"));
  CHECK(driven.motion.period == doctest::Approx(std::numbers::pi).epsilon(1e-13));
  CHECK(driven.largest == doctest::Approx(std::exp(-0.1 * std::numbers::pi)).epsilon(1e-12));
}

TEST_CASE("next to the top a pendulum passes the other side of it before it returns: the elliptic integral") {
  for (const double degrees : {178.0, 179.0, 179.9, 179.99}) {
    const double start = degrees * std::numbers::pi / 180;
    const ModelText m(
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
        "gravity (0, -g)\nstart θ = " +
        std::to_string(degrees) + " deg\nrun 20 s\n");
    Diagnostics told;
    const auto r = floquet(m.model, m.equations, {}, told);
    REQUIRE(r);
    CHECK(r->motion.period ==
          doctest::Approx(4 / std::sqrt(9.81) * std::comp_ellint_1(std::sin(start / 2))).epsilon(1e-9));
  }
}

TEST_CASE("multipliers below rounding: by the divergence where it is one, else told to be lost") {
  const FloquetResult cycle =
      floquet_of(ModelText("dimensionless\nparam ε = 20\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
                           "force x = ε (1 - x^2) x'\nstart x = 2\nrun 500\n"));
  // ∫ ε (1 − x²) dt over one cycle, by the classical Runge-Kutta method from one maximum of x to the next.
  double x = 2.00779, v = 0, exponent = 0, t = 0;
  constexpr double h = 1e-4;
  for (double before = -1; t < 30 || !(before > 0 && v <= 0); t += h) {
    before = v;
    const auto slope = [](double x, double v) { return 20 * (1 - x * x) * v - x; };
    const double a1 = slope(x, v), v2 = v + h / 2 * a1, x2 = x + h / 2 * v, a2 = slope(x2, v2), v3 = v + h / 2 * a2,
                 x3 = x + h / 2 * v2, a3 = slope(x3, v3), v4 = v + h * a3, x4 = x + h * v3, a4 = slope(x4, v4);
    exponent += h / 6 * 20 * (6 - x * x - 2 * x2 * x2 - 2 * x3 * x3 - x4 * x4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4), v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  CHECK(cycle.motion.period == doctest::Approx(t).epsilon(1e-4));
  CHECK(cycle.log_smallest.value() == doctest::Approx(exponent).epsilon(1e-3));
  CHECK(cycle.multipliers[0] == 0.0);
  CHECK(cycle.stability == OrbitalStability::Attracting);
  // x'' + 40 x' + x = cos t: exponents −20 ± √399.
  const auto damped = [](const std::string& more) {
    return floquet_of(
        ModelText("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2)\n"
                  "D = 20 x'^2 + " +
                  more + " y'^2\nforce x = cos(t)\nrun 10\n"));
  };
  const double slow = 2 * std::numbers::pi * (-20 + std::sqrt(399)), fast = -80 * std::numbers::pi - slow;
  const FloquetResult single = damped("0.1"), two = damped("20");
  CHECK(single.log_smallest.value() == doctest::Approx(fast).epsilon(1e-10));
  CHECK(single.lost == 0);
  CHECK(two.lost == 2);
  CHECK(two.multipliers[3] == 0.0);
  CHECK(two.multipliers[0].real() == doctest::Approx(std::exp(slow)).epsilon(1e-10));
}

TEST_CASE("a square wave switches by the time alone: neighbours cross together, and multipliers are those without it") {
  const std::string text =
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = x^2\nD = 0.15 x'^2\n"
      "force x = sign(sin(t))\nstart x = 0.1\nrun 100\n";
  const FloquetResult r = floquet_of(ModelText(text));
  const double w = std::sqrt(2 - 0.0225), pi = std::numbers::pi;
  CHECK(r.motion.period == doctest::Approx(2 * pi).epsilon(1e-14));
  CHECK(r.multipliers[0].real() == doctest::Approx(std::exp(-0.3 * pi) * std::cos(2 * pi * w)).epsilon(1e-11));
  // Half a period turns the motion over: X(π) = −X(0) about the rest (1/2, 0) of the first half.
  const double e = std::exp(-0.15 * pi), c = std::cos(w * pi), s = std::sin(w * pi) / w;
  const double a = e * (c + 0.15 * s), b = e * s, d = -2 * e * s, f = e * (c - 0.15 * s);
  const double determinant = (1 + a) * (1 + f) - b * d, p = -0.5 * (1 - a), q = 0.5 * d;
  CHECK(r.motion.start.q[0] == doctest::Approx(((1 + f) * p - b * q) / determinant).epsilon(1e-11));
  CHECK(r.motion.start.v[0] == doctest::Approx(((1 + a) * q - d * p) / determinant).epsilon(1e-11));
  const ModelText other(text);
  CHECK(code_of([&](Diagnostics& told) { return floquet(other.model, other.equations, {.period = 1.0}, told); }) ==
        "E1404");
}

TEST_CASE("what has no Floquet multipliers is told") {
  const auto code = [](const std::string& text, FloquetOptions options = {}) {
    const ModelText m(text);
    return code_of([&](Diagnostics& d) { return floquet(m.model, m.equations, options, d); });
  };
  const std::string free = "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n";
  CHECK(code(free + "start x' = 1\nrun 10\n") == "E1401");
  CHECK(code(free + "V = 1/2 x^2\nrun 10\n") == "E1402");
  CHECK(code(free + "V = abs(x)\nstart x = 1\nrun 10\n") == "E1403");
  CHECK(code(free + "V = 1/2 x^2 exp(-t)\nstart x = 1\n") == "E1404");
  CHECK(code(free + "V = 1/2 (2 + cos t) x^2\nstart x = 1\n", {.period = 3.0}) == "E1404");
  CHECK(code(free + "V = 1/2 x^2\nstart x = 1\n") == "E1406");
  CHECK(code(free + "V = 1/2 x^2\nstart x = 1\n", {.period = 0.0}) == "E1406");
  CHECK(code(free + "V = -1/x\nstart x = 1\n", {.period = 3.0}) == "E1408");
  // The motion from this start goes on past the centre; the start that Newton's method tries next falls into it.
  CHECK(code("system kepler\ndimensionless\ncoord r : number, φ : angle\nT = 1/2 (r'^2 + r^2 φ'^2)\nV = -1/r\n"
             "start r = 1, φ' = 0.001\nrun 3\n") == "E1401");
}

TEST_CASE("the divergence is integrated as finely as it changes, also where the motion rests and steps are long") {
  const ModelText m(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (1 + 0.3 cos(t)^2) x^2\nD = 0.05 sin(t)^2 x'^2\n");
  const PointEquations points(m.equations);
  Diagnostics told;
  auto study = modal_study(points, {0, {0.0}, {0.0}}, told);
  REQUIRE(study);
  const auto neighbours = settle_driven(*study, points, m.model, m.equations, nullptr);
  REQUIRE(neighbours.at(0));
  CHECK(neighbours[0]->motion.period == doctest::Approx(std::numbers::pi).epsilon(1e-14));  // of the squares
  CHECK(*neighbours[0]->integrated_divergence == doctest::Approx(-0.05 * std::numbers::pi).epsilon(1e-12));
  CHECK(study->entries[0].analysis.stability.verdict == Stability::Asymptotic);
}

TEST_CASE("a body's orientation comes back with q or −q: the period is that of the body") {
  const auto spinning = [](const std::string& inertia, const std::string& rate, const std::string& more = "") {
    return floquet_of(ModelText("system s\nbody B mass 1 kg inertia diag(" + inertia +
                                ") kg m^2 rotation quaternion\n" + more + "start B.ω = (" + rate +
                                ") rad/s\nrun 30 s\n"));
  };
  const FloquetResult about_axis = spinning("2, 3, 4", "0, 0, 1");
  CHECK(about_axis.motion.period == doctest::Approx(2 * std::numbers::pi).epsilon(1e-12));
  CHECK(about_axis.motion.other_sign == std::vector<std::string>{"B"});
  // Neighbours nutate with √((C − A)(C − B)/(AB)) = 1/√3 in the body.
  const double cosine = std::cos(2 * std::numbers::pi / std::sqrt(3.0));
  const auto nutates = [&](const std::complex<double>& mu) { return std::abs(mu.real() - cosine) < 1e-9; };
  CHECK(std::count_if(about_axis.multipliers.begin(), about_axis.multipliers.end(), nutates) == 2);
  CHECK(*about_axis.symplectic_residual < 1e-11);
  // Of a spherical body every motion is a rotation about ω.
  const FloquetResult spherical = spinning("1, 1, 1", "0.6, 0, 0.8");
  CHECK(spherical.motion.period == doctest::Approx(2 * std::numbers::pi).epsilon(1e-12));
  CHECK(spherical.motion.other_sign.size() == 1);
  // V = −w of q = (w, …) tells q from −q: half the angle is a pendulum that runs over the top.
  const FloquetResult tells = spinning("1, 1, 1", "0, 0, 5", "V = -1 [J] B.qw\n");
  CHECK(tells.motion.other_sign.empty());
  CHECK(tells.motion.period == doctest::Approx(4 / 2.5 * std::comp_ellint_1(1 / 2.5)).epsilon(1e-12));
}
