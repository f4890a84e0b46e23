#include "../model_text.hpp"

#include <maupertuis/invariants.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace {

struct Found {
  ModelText m;
  Invariants result;
  Diagnostics diagnostics;

  explicit Found(const std::string& text, int degree = 2) : m("dimensionless\n" + text) {
    InvariantsOptions options;
    options.velocity_degree = degree;
    auto found = find_invariants(m.model, m.equations, options, diagnostics);
    REQUIRE(found);
    result = std::move(*found);
    for (const ConservedFunction& i : result.integrals) CHECK(i.certificate.verdict == Verdict::Zero);
  }

  std::size_t count(const std::string& name) const {
    return static_cast<std::size_t>(
        std::count_if(result.integrals.begin(), result.integrals.end(),
                      [&](const ConservedFunction& i) { return i.name.find(name) != std::string::npos; }));
  }
  std::string text(const std::string& name) const {
    for (const ConservedFunction& i : result.integrals)
      if (i.name == name) return to_plain(i.readable, m.equations.order);
    return "";
  }
  std::size_t of_kind(IntegralKind kind) const {
    return static_cast<std::size_t>(std::count_if(result.integrals.begin(), result.integrals.end(),
                                                  [&](const ConservedFunction& i) { return i.kind == kind; }));
  }
};

const std::string kepler = R"(param m = 1, k = 1
coord x, y, z : number
T = 1/2 m (x'^2 + y'^2 + z'^2)
V = -k/sqrt(x^2 + y^2 + z^2)
)";

}  // namespace

TEST_CASE("a free particle in n dimensions has (n² + 3n + 6)/2 symmetries, and no more") {
  const std::string texts[] = {"param m = 1\ncoord x : number\nT = 1/2 m x'^2\n",
                               "param m = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\n",
                               "param m = 1\ncoord x, y, z : number\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"};
  for (std::size_t n = 1; n <= 3; ++n) {
    CAPTURE(n);
    const Found f(texts[n - 1]);
    CHECK(f.result.noether_symmetries == (n * n + 3 * n + 6) / 2);
    CHECK(f.result.symmetry_bound == f.result.noether_symmetries);
    CHECK(f.result.integrals.size() == f.result.noether_symmetries);
    CHECK(f.result.rank == 2 * n);
    CHECK(f.count("dilation") == 1);
    CHECK(f.count("conformal") == 1);
    CHECK(f.count("Galilei boost") == n);
  }
}

TEST_CASE("the harmonic oscillator has as many, with sines of the time") {
  const Found f("param m = 1, k = 1\ncoord x : number\nT = 1/2 m x'^2\nV = 1/2 k x^2\n");
  CHECK(f.result.noether_symmetries == 5);
  CHECK(f.result.symmetry_bound == 5);
  CHECK(f.count("energy") == 1);
}

TEST_CASE("Kepler in space: seven integrals, five independent, two relations") {
  const Found f(kepler);
  CHECK(f.result.integrals.size() == 7);
  CHECK(f.count("Laplace-Runge-Lenz") == 3);
  CHECK(f.result.rank == 5);
  REQUIRE(f.result.relations.size() == 2);
  CHECK(to_plain(f.result.relations[0].value, f.m.equations.order) == "I2 I5 + I3 I6 + I4 I7");
  CHECK(f.text("angular momentum about y") == "m z x' - m x z'");
  CHECK(f.text("Laplace-Runge-Lenz vector, x") ==
        "m^2 (x y'^2 + x z'^2 - y x' y' - z x' z') - m k x/sqrt(x^2 + y^2 + z^2)");
  CHECK(f.result.symmetry_bound == 4);
  CHECK(f.result.completely_integrable);
}

TEST_CASE("coefficients with sines of parameters, π and functions of numbers are found as those of parameters are") {
  const Found years("coord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = -4 pi^2/sqrt(x^2 + y^2)\n");
  CHECK(years.count("Laplace-Runge-Lenz") == 2);
  CHECK(years.result.autonomous_rank == 3);
  for (const char* slope : {"sin(α)", "exp(α)", "pi", "sin(0.3)", "tan(α)", "sqrt(α + 2)", "α^(1/3)", "(1 + sqrt(5))/2",
                            "2^α", "exp(pi)", "exp(pi/2)"}) {
    CAPTURE(slope);
    const Found incline("param m = 1, g = 9, α = 0.4\ncoord x : number\nT = 1/2 m x'^2\nV = -m g " +
                        std::string(slope) + " x\n");
    CHECK(incline.result.noether_symmetries == 5);
    CHECK(incline.result.symmetry_bound == 5);
  }
  // The stiffness under a root, in the phase of sines of the time.
  const Found tilted(
      "param k = 1, α = 0.4\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 k cos(α) (x^2 + y^2)\n");
  CHECK(tilted.count("Fradkin") >= 2);
  CHECK(tilted.result.noether_symmetries == 8);
  CHECK(tilted.text("energy") == "1/2 x'^2 + 1/2 y'^2 + 1/2 k cos α (x^2 + y^2)");
}

TEST_CASE("angles that are turned by parts of π stay what they are") {
  const Found f(
      "param m = 1, g = 9\ncoord x, φ : number\nT = 1/2 m (x'^2 + φ'^2) + m x' φ' sin(φ + pi/2)\n"
      "V = -pi m g x - m g sin(φ + pi/2)\n");
  CHECK(f.text("energy").find("pi/2") == std::string::npos);
  CHECK(f.count("energy") == 1);
}

TEST_CASE("a drive by cos w t gives its momentum sin w t") {
  const Found f("param A = 2, w = 0.5\ncoord x : number\nL = 1/2 x'^2 + A x cos(w t)\n");
  REQUIRE(f.result.integrals.size() >= 1);
  CHECK(to_plain(f.result.integrals[0].readable, f.m.equations.order) == "x' - A sin(w t)/w");
}

TEST_CASE("what is conserved because sin² + cos² is 1 is found as well") {
  const Found f(
      "param α = 0.4\ncoord x, y : number\nT = 1/2 (cos(α)^2 x'^2 + (1 - sin(α)^2) y'^2)\nV = (x^2 + y^2)^2\n");
  CHECK(f.count("angular momentum") == 1);
  CHECK(f.result.autonomous_rank == 2);
}

TEST_CASE("the brackets of angular momentum and of the Runge-Lenz vector") {
  const Found f(kepler);
  const auto bracket = [&](std::size_t i, std::size_t j) {
    for (const PoissonBracket& b : f.result.brackets)
      if (b.first == i && b.second == j) return to_plain(b.value, f.m.equations.order);
    return std::string("0");
  };
  CHECK(bracket(1, 2) == "I4");
  CHECK(bracket(0, 3) == "0");
  CHECK(bracket(1, 5) == "I7");
  CHECK(bracket(4, 5) == "-2 m I1 I4");
}

TEST_CASE("the symmetry of the Runge-Lenz vector depends on the velocities (Lévy-Leblond 1971)") {
  const Found f(kepler);
  const auto it = std::find_if(f.result.integrals.begin(), f.result.integrals.end(),
                               [](const ConservedFunction& i) { return i.name == "Laplace-Runge-Lenz vector, x"; });
  REQUIRE(it != f.result.integrals.end());
  REQUIRE(it->characteristic.size() == 3);
  // δr_i = m (2 v_i x − r_i v_x − (r·v) δ_ix), the published one times 2 m.
  Expr radial = f.m.q(0) * f.m.v(0) + f.m.q(1) * f.m.v(1) + f.m.q(2) * f.m.v(2);
  for (std::size_t i = 0; i < 3; ++i) {
    Expr published = Rational(2) * f.m.v(i) * f.m.q(0) - f.m.q(i) * f.m.v(0);
    if (i == 0) published = published - radial;
    CHECK(zero_test(it->characteristic[i] - f.m.p("m") * published).verdict == Verdict::Zero);
  }
}

TEST_CASE("the isotropic oscillator in space: Fradkin's tensor") {
  const Found f(
      "param m = 1, k = 1\ncoord x, y, z : number\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = 1/2 k (x^2 + y^2 + z^2)\n");
  CHECK(f.count("Fradkin") == 5);  // the sixth is the energy less two of them
  CHECK(f.text("Fradkin tensor, xy") == "1/2 m x' y' + 1/2 k x y");
  CHECK(f.result.noether_symmetries == 12);
  CHECK(f.result.autonomous_rank == 5);
}

TEST_CASE("oscillators whose rates are in a ratio of whole numbers: each symmetry counts once") {
  // The energy, and two charges of each oscillator: four in all for p cos wt + m w q sin wt and its partner.
  for (const auto& [x, y] : {std::pair{1, 4}, {4, 9}, {2, 8}, {8, 2}, {2, 3}}) {
    CAPTURE(x);
    CAPTURE(y);
    const Found f("param m = 1, k = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\n" +
                  fmt::format("V = 1/2 k ({} x^2 + {} y^2)\n", x, y));
    CHECK(f.result.noether_symmetries == 5);
    CHECK(f.result.symmetry_bound == 5);
    const Found plain("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n" +
                      fmt::format("V = 1/2 ({} x^2 + {} y^2)\n", x, y));
    CHECK(plain.result.noether_symmetries == 5);
    CHECK(f.result.too_long == 0);
  }
}

TEST_CASE("the double pendulum: energy alone; without gravity its angular momentum too") {
  const std::string pendulum = R"(param m1 = 1, m2 = 1, l1 = 1, l2 = 1, g = 9.81
coord a, b : angle
point A mass m1 at l1 (sin a, -cos a)
point B mass m2 at A + l2 (sin b, -cos b)
)";
  const Found with(pendulum + "gravity (0, -g)\n");
  CHECK(with.result.integrals.size() == 1);
  CHECK(with.count("energy") == 1);
  CHECK(with.result.symmetry_bound == 1);
  CHECK_FALSE(with.result.completely_integrable);
  const Found without(pendulum);
  CHECK(without.result.integrals.size() == 2);
  CHECK(without.count("total angular momentum about z") == 1);
  CHECK(without.result.completely_integrable);
}

TEST_CASE("two bodies in space: the ten charges of the Galilei group") {
  const Found f(R"(param m1 = 1, m2 = 2, k = 1
coord x1, y1, z1, x2, y2, z2 : number
point A mass m1 at (x1, y1, z1)
point B mass m2 at (x2, y2, z2)
V = -k/norm(A - B)
)");
  CHECK(f.count("energy") == 1);
  CHECK(f.count("total momentum") == 3);
  CHECK(f.count("total angular momentum") == 3);
  CHECK(f.count("Galilei boost") == 3);
}

TEST_CASE("twelve bodies in a plane: no random point has a root for each of their 66 distances") {
  std::string model = "param k = 1\n";
  for (int i = 1; i <= 12; ++i) {
    const std::string n = std::to_string(i);
    model += "param m" + n + " = " + n + "/10\ncoord x" + n + ", y" + n + " : number\npoint P" + n + " mass m" + n +
             " at (x" + n + ", y" + n + ")\n";
    for (int j = 1; j < i; ++j)
      model += "V += -k m" + n + " m" + std::to_string(j) + "/norm(P" + n + " - P" + std::to_string(j) + ")\n";
  }
  const Found f(model);
  CHECK(f.result.integrals.size() == 6);
  CHECK(f.count("energy") == 1);
  CHECK(f.count("total momentum") == 2);
  CHECK(f.count("total angular momentum") == 1);
  CHECK(f.count("Galilei boost") == 2);
  for (const ConservedFunction& i : f.result.integrals) CHECK(i.certificate.error_bound < 1e-3);
}

TEST_CASE("up to gauge: the momenta that a homogeneous magnetic field leaves over") {
  const Found f(
      "param m = 1, q = 1, B = 1\ncoord x, y, z : number\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nU = -1/2 q B (x y' - y "
      "x')\n");
  CHECK(f.text("momentum along y, modified by the field") == "m y' + q B x");
  CHECK(f.text("momentum along z") == "m z'");
}

TEST_CASE("symmetries that need the time: Caldirola-Kanai, a rotating potential, a wave that travels") {
  const Found kanai("param m = 1, g = 0.3, w = 2\ncoord x : number\nL = exp(g t) (1/2 m x'^2 - 1/2 m w^2 x^2)\n");
  CHECK(kanai.text("Jacobi integral") == "1/2 m exp(g t) x'^2 + 1/2 m g x exp(g t) x' + 1/2 m w^2 x^2 exp(g t)");
  const Found rotating(
      "param m = 1, a = 0.7, W = 0.9\ncoord r : number, φ : angle\nT = 1/2 m (r'^2 + r^2 φ'^2)\n"
      "V = 1/2 r^2 + a r^2 cos(2 (φ - W t))\n");
  CHECK(rotating.count("Jacobi integral") == 1);
  const Found wave("param m = 1, k = 1, c = 2\ncoord x : number\nT = 1/2 m x'^2\nV = cos(k (x - c t))\n");
  CHECK(wave.text("Jacobi integral") == "1/2 m x'^2 - m c x' + cos(k x - k c t)");
}

TEST_CASE("a time that cancels is no explicit time: the bead on a turning hoop") {
  const Found f(
      "param m = 1, R = 1, W = 2, g = 9.81\ncoord a : angle\n"
      "point bead mass m at R (sin a cos(W t), sin a sin(W t), -cos a)\ngravity (0, 0, -g)\n");
  REQUIRE(f.result.integrals.size() == 1);
  CHECK(f.count("Jacobi integral") == 1);
  CHECK_FALSE(f.result.integrals[0].explicit_time);
  CHECK(f.result.completely_integrable);
}

TEST_CASE("Poincaré's vector of a charge about a monopole has three components, and two relations") {
  const Found f(
      "param k = 1, g = 0.7\ncoord x, y, z : number\nlet r = sqrt(x^2 + y^2 + z^2)\n"
      "L = 1/2 (x'^2 + y'^2 + z'^2) + g z/r (x y' - y x')/(x^2 + y^2) + k/r - g^2/(2 r^2)\n");
  CHECK(f.result.integrals.size() == 7);
  CHECK(f.result.shown == 7);
  CHECK(f.result.rank == 5);
  CHECK(f.result.relations.size() == 2);
  for (const PoissonBracket& b : f.result.brackets) CHECK(b.value.value);  // none is a further function
}

TEST_CASE("the half-plane of constant curvature has three isometries, of which one is quadratic in x and y") {
  const Found half("coord x, y : number\nL = 1/2 (x'^2 + y'^2)/y^2\n");
  CHECK(half.result.noether_symmetries == 4);  // with the translation in time
  CHECK(half.result.symmetry_bound == 4);
}

TEST_CASE("helical symmetry") {
  const Found f(
      "param m = 1, b = 1, h = 2\ncoord x, y, z : number\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
      "V = b (x cos(z/h) + y sin(z/h))\n");
  CHECK(f.text("helical momentum about z") == "m (x y' - y x' + h z')");
}

TEST_CASE("a free relativistic particle: ξ depends on the position") {
  const Found f("param m = 1, c = 3\ncoord x, y : number\nL = -m c^2 sqrt(1 - (x'^2 + y'^2)/c^2)\n");
  CHECK(f.result.noether_symmetries == 6);
  CHECK(f.result.symmetry_bound == 6);
  CHECK(f.count("boost along") == 2);
}

TEST_CASE("the integrable Hénon-Heiles potentials of Ramani, Dorizzi and Grammaticos (1982)") {
  const auto potential = [](const std::string& quadratic, const std::string& c) {
    return "param A = 1, B = 2\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = " + quadratic + " + x^2 y + " + c +
           " y^3\n";
  };
  CHECK(Found(potential("1/2 (x^2 + y^2)", "-1/3")).result.integrals.size() == 1);
  CHECK(Found(potential("1/2 (x^2 + y^2)", "-1/3"), 4).result.integrals.size() == 1);
  CHECK(Found(potential("1/2 (A x^2 + B y^2)", "2")).result.completely_integrable);  // 1 : 6, any A, B
  CHECK(Found(potential("1/2 A (x^2 + y^2)", "1/3")).result.completely_integrable);  // 1 : 1
  CHECK_FALSE(Found(potential("1/2 A (x^2 + 16 y^2)", "16/3")).result.completely_integrable);
  CHECK(Found(potential("1/2 A (x^2 + 16 y^2)", "16/3"), 4).result.completely_integrable);  // 1 : 16, quartic
}

TEST_CASE("Toda's lattice of three: Hénon's cubic integral (1974)") {
  const std::string toda =
      "param m = 1\ncoord x1, x2, x3 : number\nT = 1/2 (x1'^2 + x2'^2 + x3'^2)\n"
      "V = exp(x1 - x2) + exp(x2 - x3) + exp(x3 - x1)\n";
  CHECK_FALSE(Found(toda).result.completely_integrable);
  CHECK(Found(toda, 3).result.completely_integrable);
}

TEST_CASE("Kovalevskaya's top at degree 4, on request") {
  const std::string top = R"(param J = 1, g = 1, a = 1, M = 1
coord φ, θ, ψ : angle
body top inertia diag(2 J, 2 J, J) rotation euler zxz (φ, θ, ψ)
V = M g a sin θ sin ψ
)";
  CHECK_FALSE(Found(top).result.completely_integrable);
  const Found f(top, 4);
  CHECK(f.of_kind(IntegralKind::Hidden) == 1);
  CHECK(f.result.completely_integrable);
}

TEST_CASE("with forces and velocity constraints, where Noether's theorem does not apply") {
  // A drag proportional to the velocity: m x' + c x; a particle on dz = y dx (Rosenberg).
  const Found drag("param m = 1, c = 1\ncoord x : number\nT = 1/2 m x'^2\nD = 1/2 c x'^2\n");
  REQUIRE(drag.result.integrals.size() >= 1);
  CHECK(drag.result.noether_symmetries == 0);
  CHECK(is_function_of(drag.m.p("m") * drag.m.v(0) + drag.m.p("c") * drag.m.q(0), drag.result, drag.m.equations));
  const Found rosenberg("param m = 1\ncoord x, y, z : number\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint z' = y x'\n");
  CHECK(rosenberg.count("energy") == 1);
  CHECK(is_function_of(rosenberg.m.v(1), rosenberg.result, rosenberg.m.equations));
  CHECK(is_function_of(rosenberg.m.v(0) * sqrt(rosenberg.m.q(1) * rosenberg.m.q(1) + 1), rosenberg.result,
                       rosenberg.m.equations));
  CHECK_FALSE(is_function_of(rosenberg.m.v(0), rosenberg.result, rosenberg.m.equations));
}

TEST_CASE("balance laws: the rate of a charge whose symmetry a force breaks") {
  const Found f(
      "param m = 1, M = 2, l = 1, g = 1, b = 1\ncoord x, a : number\npoint cart mass M at (x, 0)\n"
      "point bob mass m at cart + l (sin a, -cos a)\ngravity (0, -g)\nD = 1/2 b x'^2\n");
  REQUIRE(f.result.balance_laws.size() == 2);
  for (const BalanceLaw& law : f.result.balance_laws)
    CHECK(to_plain(law.rate, f.m.equations.order) == (law.name == "energy" ? "-b x'^2" : "-b x'"));
}

TEST_CASE("a basis that would be too large is refused before it is computed") {
  const ModelText m(
      "dimensionless\nparam k = 1\ncoord x1, x2, x3, x4, x5, x6, x7, x8 : number\n"
      "T = 1/2 (x1'^2 + x2'^2 + x3'^2 + x4'^2 + x5'^2 + x6'^2 + x7'^2 + x8'^2)\n"
      "V = k (x1 x2 x3 x4 + x5 x6 x7 x8)\n");
  InvariantsOptions options;
  options.velocity_degree = 4;
  Diagnostics diagnostics;
  CHECK_FALSE(find_invariants(m.model, m.equations, options, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "E1001");
}

TEST_CASE("what cannot be searched is said") {
  const auto code_of = [](const std::string& text, bool drift) {
    const ModelText m("dimensionless\n" + text);
    InvariantsOptions options;
    options.drift = drift;
    Diagnostics diagnostics;
    find_invariants(m.model, m.equations, options, diagnostics);
    return diagnostics.items().size() == 1 ? diagnostics.items()[0].code : std::string("none or several");
  };
  CHECK(code_of("coord x, y : number\nT = 1/2 x'^2\nV = y^2 x\n", false) == "E1002");
  CHECK(code_of("coord x, y : number\nT = 1/2 (x'^2 + y'^2)\nconstraint x'^2 + y'^2 = 1\n", false) == "E1003");
  CHECK(code_of("coord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\nrun 10\n", true) ==
        "W1004");  // it falls into the centre
}

TEST_CASE("the drift of an integral along the model's run is at rounding level") {
  const Found f(kepler + "start x = 1, y' = 1.1, z' = 0.2\nrun 10\n");
  for (const ConservedFunction& i : f.result.integrals) {
    REQUIRE(i.drift);
    CHECK(*i.drift < 1e-13);
  }
}

TEST_CASE("degrees in the velocities") {
  const ModelText m("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n");
  CHECK(velocity_degree(m.q(0) * m.v(0) * m.v(1) + m.v(0), *m.system) == 2);
  CHECK(velocity_degree(sin(m.q(0)), *m.system) == 0);
  CHECK_FALSE(velocity_degree(sqrt(m.v(0) * m.v(0) + 1), *m.system));
}

TEST_CASE("no integral across a jump: what one side has is told apart") {
  const Found pushed("coord x : number\nT = 1/2 x'^2\nforce x = -step(x)\n");
  for (const ConservedFunction& i : pushed.result.integrals)
    for (const double x : {1e-12, -1e-12}) {
      const auto at = [&](double q) {
        return evaluate(i.value, {{pushed.m.q(0), q}, {pushed.m.v(0), 0.7}, {pushed.m.system->context->time(), 2}});
      };
      CHECK(std::abs(at(x) - at(-x)) < 1e-11);
    }
  CHECK(pushed.result.integrals.size() == 1);        // 1/2 x'^2 + x step(x)
  REQUIRE_FALSE(pushed.result.on_one_side.empty());  // x' + t step(x)
  CHECK(pushed.result.on_one_side[0].place == "x = 0");

  const Found meissner("coord x : number\nT = 1/2 x'^2\nV = 1/2 (2 + sign(cos(t))) x^2\n");
  CHECK(meissner.count("energy") == 0);
  CHECK_FALSE(meissner.result.on_one_side.empty());
  CHECK_FALSE(conserved_quantities(meissner.m.equations).energy_conserved);
  // An angle jumps by 2π at its cut, and goes on elsewhere on y = 0.
  const Found turned(
      "coord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2) - 1/20*atan2(y, x)\nstart x = 1, y' = 1\n");
  CHECK(turned.count("energy") == 0);
  CHECK_FALSE(conserved_quantities(turned.m.equations).energy_conserved);
  const Found kink("coord x : number\nT = 1/2 x'^2\nV = abs(x)\n");
  CHECK(kink.count("energy") == 1);
  CHECK(conserved_quantities(kink.m.equations).energy_conserved);
}

TEST_CASE("angles of which few primes have the order: an incline of 20 degrees, and others") {
  for (const char* angle : {"20 pi/180", "pi/7", "2 pi/7", "5 pi/18", "pi/23"}) {
    INFO(angle);
    const Found found(std::string("coord x : number\nparam k = 3\nT = 1/2 x'^2\nV = 1/2 k x^2 + x cos(") + angle +
                      ") - x sin(" + angle + ")\n");
    CHECK(found.count("energy") == 1);
  }
}

TEST_CASE("energies of oscillators whose rates are roots that are not met at random need no root") {
  for (const char* k : {"1.000000001", "2.0000001"}) {
    CAPTURE(k);
    const Found f("coord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + " + std::string(k) + " y^2)\n");
    CHECK(f.result.noether_symmetries >= 1);
    CHECK(f.result.completely_integrable);
    const auto untold = [](const std::string& basis) {
      return basis.find("polynomials") == 0 && basis.find("not searched") != std::string::npos;
    };
    CHECK(std::none_of(f.result.basis.begin(), f.result.basis.end(), untold));
  }
}

TEST_CASE("an integral whose coefficients hold roots of numbers is written with them") {
  // Hénon's integral of Toda's lattice: 24 √3 y'³ − 72 √3 x'² y' − … is conserved for √3 alone.
  const std::string toda =
      "coord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/24 (exp(2 x + 2 ROOT y) + exp(2 x - 2 ROOT y) + exp(-4 x))\n";
  const auto with = [&](const std::string& root) {
    std::string text = toda;
    for (std::size_t at; (at = text.find("ROOT")) != std::string::npos;) text.replace(at, 4, root);
    return text;
  };
  const Found henon(with("sqrt(3)"), 3);
  CHECK(henon.result.too_long == 0);
  CHECK(henon.result.completely_integrable);
  REQUIRE(henon.result.integrals.size() == 2);
  const Expr i = henon.result.integrals[1].value;  // its leading terms are those of Hénon (1974): y'³ − 3 x'² y'
  CHECK(henon.result.integrals[1].velocity_degree == 3);
  CHECK(to_plain(i, henon.m.equations.order).find("sqrt(3)") != std::string::npos);
  const Found other(with("sqrt(5)"), 3);
  CHECK(other.result.too_long == 0);
  CHECK_FALSE(other.result.completely_integrable);
}
