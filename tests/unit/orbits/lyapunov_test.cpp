#include "support.hpp"

using namespace maupertuis;

namespace {
const std::string one = "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n";
}

TEST_CASE("a saddle: exponents ±1, exactly") {
  LyapunovOptions options;
  options.transient = 16;  // until the directions have turned into those of the exponents, as e^(−2t)
  const LyapunovResult r = lyapunov_of(ModelText(one + "V = -1/2 x^2\nstart x = 1e-9\nrun 20\n"), options);
  REQUIRE(r.exponents.size() == 2);
  CHECK(r.exponents[0] == doctest::Approx(1).epsilon(1e-10));
  CHECK(r.exponents[1] == doctest::Approx(-1).epsilon(1e-10));
  CHECK(std::abs(r.sum) < 1e-12);
  CHECK(*r.expected_sum == 0);
}

TEST_CASE("damping: both exponents are −c/2, their sum is the divergence") {
  const LyapunovResult r = lyapunov_of(ModelText(one + "V = 1/2 x^2\nD = 0.15 x'^2\nstart x = 1\nrun 400\n"));
  CHECK(r.sum == doctest::Approx(-0.3).epsilon(1e-3));
  CHECK(*r.sum_rule_residual < 1e-12);
  CHECK(*r.expected_sum == doctest::Approx(-0.3).epsilon(1e-13));
  CHECK(r.exponents[0] == doctest::Approx(-0.15).epsilon(0.02));
  CHECK(std::abs(r.exponents[0] + 0.15) < 4 * r.errors[0] + 1e-3);
  CHECK_FALSE(r.kaplan_yorke.value_or(0) > 1);
}

TEST_CASE("where t stands in M the sum is the divergence in q and q', not the one in q and p") {
  const auto check_sum = [](const std::string& text, double divergence) {
    CAPTURE(text);
    const LyapunovResult r =
        lyapunov_of(ModelText("dimensionless\ncoord x : number\n" + text + "start x = 1\nrun 40\n"));
    REQUIRE(r.expected_sum);
    CHECK(r.sum == doctest::Approx(divergence).epsilon(1e-10));
    CHECK(*r.expected_sum == doctest::Approx(divergence).epsilon(1e-10));
    CHECK(*r.sum_rule_residual < 1e-12);
    CHECK(r.kaplan_yorke.value_or(1) == 0);  // everything comes to x = x' = 0
  };
  check_sum("L = exp(0.5 t) (1/2 x'^2 - x^2)\n", -0.5);  // x'' + x'/2 + 2 x = 0
  // Of X = x e^{t/5} there is no friction, and x shrinks beside it: X and X' keep their volume, (x, x') is e^{−2t/5} of
  // it.
  check_sum("let X = x exp(0.2 t)\nT = 1/2 X'^2\nV = X^2\n", -0.4);
  // The volume in p = x' e^{−t} shrinks by friction alone, that in x' by what is left of it: x'' + x' + x = 0.
  check_sum("L = exp(-t) (1/2 x'^2 - 1/2 x^2)\nD = exp(-t) x'^2\n", -1);
}

TEST_CASE("Hénon-Heiles at E = 1/6: pairs ±λ, two zeros, sum zero") {
  const LyapunovResult r =
      lyapunov_of(ModelText("system hh\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
                            "V = 1/2 (x^2 + y^2) + x^2 y - 1/3 y^3\nstart y = -0.1, x' = 0.5, y' = 0.05\nrun 2000\n"));
  REQUIRE(r.exponents.size() == 4);
  CHECK(r.dimension == 4);
  CHECK(std::abs(r.exponents[0] + r.exponents[3]) < 0.01);
  CHECK(std::abs(r.exponents[1] + r.exponents[2]) < 0.01);
  CHECK(std::abs(r.exponents[1]) < 0.02);
  CHECK(std::abs(r.sum) < 1e-10);
  CHECK(r.exponents[0] > 0.03);
  CHECK(r.chaos == Chaos::Shown);
}

TEST_CASE("a driven damped pendulum: the sum is −c, the largest alone agrees with the whole spectrum") {
  const ModelText m(
      "system driven\ndimensionless\ncoord θ : angle\ninput u = 1.5 cos(2/3 t)\nT = 1/2 θ'^2\nV = -cos θ\nD = 1/4 "
      "θ'^2\n"
      "force θ = u\nstart θ = 0.2\nrun 1000\n");
  const LyapunovResult all = lyapunov_of(m);
  CHECK(all.sum == doctest::Approx(-0.5).epsilon(1e-9));
  CHECK(all.exponents[0] > 0.05);
  CHECK(all.exponents[0] < 0.25);
  CHECK(all.chaos == Chaos::Shown);
  CHECK(*all.kaplan_yorke == doctest::Approx(1 + all.exponents[0] / -all.exponents[1]).epsilon(1e-12));
  LyapunovOptions first;
  first.exponents = 1;
  const LyapunovResult one_alone = lyapunov_of(m, first);
  CHECK(one_alone.exponents.size() == 1);
  CHECK_FALSE(one_alone.expected_sum);
  CHECK(std::abs(one_alone.exponents[0] - all.exponents[0]) < 4 * (all.errors[0] + one_alone.errors[0]));
}

TEST_CASE("intervals may be any: directions that part too far are made orthonormal on the way") {
  const ModelText m(one + "V = -1/2 x^2\nstart x = 1e-30\nrun 60\n");
  for (const double interval : {1.0, 60.0}) {
    LyapunovOptions options;
    options.interval = interval;
    options.transient = 16;
    const LyapunovResult r = lyapunov_of(m, options);  // e^(2t) over 60 is 1e52
    CHECK(r.exponents[1] == doctest::Approx(-1).epsilon(1e-9));
    CHECK(*r.sum_rule_residual < 1e-12);
  }
}

TEST_CASE("the sum rule along a chaotic motion with damping that depends on the place") {
  const LyapunovResult r = lyapunov_of(ModelText(
      "system d\ndimensionless\ncoord a, b : angle\nL = a'^2 + 1/2 b'^2 + a' b' cos(a - b) + 9.81 (2 cos a + cos b)\n"
      "D = 1/2 (0.02 + 0.01 cos b) a'^2\ninput u = 9 cos(2 t)\nforce a = u\nstart a = 2.5, b = 2\nrun 100\n"));
  CHECK(r.exponents[0] > 0.1);  // another run of it would be another motion after some 30
  CHECK(*r.sum_rule_residual < 1e-11);
  CHECK(r.errors[3] >= *r.sum_rule_residual);
}

TEST_CASE("constraints: the spherical pendulum by its constraint has four exponents, all zero") {
  const LyapunovResult r = lyapunov_of(ModelText(
      "system sphere\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y, z : length\npoint P mass m at (x, y, z)\n"
      "gravity (0, 0, -g)\nconstraint x^2 + y^2 + z^2 = l^2\nstart x = 0.6 m, z = -0.8 m, y' = 2 m/s\nrun 200 s\n"));
  REQUIRE(r.exponents.size() == 4);
  for (const double x : r.exponents) CHECK(std::abs(x) < 0.05);  // log t / t
  CHECK(std::abs(r.sum) < 1e-2);  // the volume of the directions at the two ends, over 180 s
  CHECK(*r.sum_rule_residual < 1e-9);
}

TEST_CASE("regular motions: no chaos, and errors that cover the log t / t of neighbours that part like t") {
  const std::string hoop =
      "param m = 1 kg, R = 0.5 m, g = 9.81 m/s^2, Ω = 3 rad/s\ncoord θ : angle\n"
      "point P mass m at R (sin θ cos(Ω t), sin θ sin(Ω t), -cos θ)\ngravity (0, 0, -g)\nstart θ = 0.1 rad\nrun ";
  const std::string toda =
      "dimensionless\ncoord x, y, z : number\nL = 1/2 (x'^2 + y'^2 + z'^2) - exp(x - y) - exp(y - z) - exp(z - x)\n"
      "start x = 0.1, y' = 0.3, z' = -0.2\nrun ";
  const std::string pendulums =  // next to their separatrices, where neighbours part exponentially for a while
      "dimensionless\ncoord a, b : angle\nT = 1/2 (a'^2 + b'^2)\nV = -cos a - 2 cos b\n"
      "start a = 3.1415926, b = 3.1415926535\nrun ";
  const auto regular = [](const std::string& text, Chaos chaos) {
    const LyapunovResult r = lyapunov_of(ModelText(text));
    CAPTURE(text);
    CHECK(r.chaos == chaos);
    for (std::size_t j = 0; j < r.exponents.size(); ++j) {
      if (chaos == Chaos::Excluded || r.duration > 90) CHECK(std::abs(r.exponents[j]) < r.errors[j]);
      if (j > 0) CHECK(r.exponents[j] <= r.exponents[j - 1]);
    }
  };
  for (const char* run : {"20 s", "100 s", "1000 s"}) regular(hoop + run + "\n", Chaos::Excluded);
  for (const char* run : {"100", "300"}) regular(toda + run + "\n", Chaos::NotShown);
  for (const char* run : {"16", "500"}) regular(pendulums + run + "\n", Chaos::NotShown);
}

TEST_CASE("chaos of any size beside an oscillation: dimensions do not depend on scales") {
  // The motion of Hénon and Heiles, 1/σ large, and z = cos t, in coordinates that mix the two.
  const auto beside = [](const std::string& sigma, const std::string& run) {
    return lyapunov_of(ModelText("dimensionless\nparam σ = " + sigma +
                                 "\ncoord a, b, c : number\nlet z = (a + b + c)/3, x = a - b, y = b - c\n"
                                 "L = 1/2 (z'^2 + x'^2 + y'^2) - 1/2 (x^2 + y^2) - σ*(x^2 y - 1/3 y^3) - 1/2*z^2\n"
                                 "start a = 1, b = 1, c = 1 + 0.1/σ, a' = 0.5/σ, c' = -0.05/σ\nrun " +
                                 run + "\n"));
  };
  for (const char* sigma : {"1e2", "1e6", "1e8", "1e10"}) {
    CAPTURE(sigma);
    const LyapunovResult r = beside(sigma, "2000");
    CHECK(r.exponents[0] > 3 * r.errors[0]);
    CHECK(r.chaos == Chaos::Shown);
    CHECK(beside(sigma, "100").chaos == Chaos::NotShown);
  }
  // The oscillation y on the ridge x = 0: what is beside the plane of y is rounding, which grows to 1e-8.
  const LyapunovResult ridge =
      lyapunov_of(ModelText("dimensionless\ncoord p, q : number\nlet x = (3 p - 4 q)/5, y = (4 p + 3 q)/5\n"
                            "L = 1/2 (p'^2 + q'^2) + 0.045 x^2 - 50 y^2\nstart p = 0.56, q = 0.42\nrun 60\n"));
  CHECK(ridge.exponents[0] == doctest::Approx(0.3).epsilon(0.01));
  CHECK(ridge.chaos == Chaos::NotShown);
}

TEST_CASE("linear motions part exponentially and are not chaotic") {
  CHECK(lyapunov_of(ModelText(one + "V = -1/2 x^2\nstart x = 1\nrun 50\n")).chaos == Chaos::Excluded);
  const LyapunovResult overflows = lyapunov_of(ModelText(one + "V = -1/2 x^2\nstart x = 1\nrun 5000\n"));
  CHECK_FALSE(overflows.ended.empty());
  CHECK_FALSE(overflows.sum_rule_residual);
  CHECK(overflows.exponents[0] == doctest::Approx(1).epsilon(1e-10));
  // Beside oscillations, a place on a hill where nothing moves.
  const std::string hill = "dimensionless\ncoord x, y, a : number\nT = 1/2 (x'^2 + y'^2 + a'^2)\n";
  for (const char* rest : {"V = 1/2 x^2 + y^2 - 1/2 a^2\nstart x = 1, y = 0.3\nrun 300\n",
                           "V = 1/2 x^2 + y^2 + cos a\nstart x = 1, y = 0.3\nrun 300\n"}) {
    const LyapunovResult r = lyapunov_of(ModelText(hill + rest));
    CHECK(r.exponents[0] == doctest::Approx(1).epsilon(0.01));
    CHECK(r.chaos == Chaos::NotShown);
  }
  // A fast oscillation, and a slow fall from a hill that it is on.
  const LyapunovResult falls =
      lyapunov_of(ModelText("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = -0.02205 x^2 + 50 y^2\n"
                            "start x = 1, y = 1\nrun 53\n"));
  CHECK(falls.exponents[0] == doctest::Approx(0.21).epsilon(0.02));
  CHECK(falls.chaos == Chaos::RunsAway);
}

TEST_CASE("what comes to a slow saddle beside oscillations is not chaotic: nothing comes back") {
  // On the stable manifold, x = exp(−t √0.001), until rounding leads away from it.
  for (const char* run : {"400", "700", "1000"}) {
    const LyapunovResult r = lyapunov_of(
        ModelText("dimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\n"
                  "V = -0.0005 x^2 + 1/2 y^2 + z^2\nstart x = 1, x' = -0.03162277660168379332, y = 1, z = 1\nrun " +
                  std::string(run) + "\n"));
    CHECK(r.exponents[0] == doctest::Approx(std::sqrt(1e-3)).epsilon(0.02));
    CHECK(r.chaos == Chaos::NotShown);
  }
}

TEST_CASE("the dimension of a limit cycle is 1") {
  const LyapunovResult cycle =
      lyapunov_of(ModelText(one + "V = 1/2 x^2\nforce x = (1 - x^2) x'\nstart x = 2\nrun 500\n"));
  CHECK(cycle.kaplan_yorke.value() == 1);
  // Rates of x'' + 4 x' + 0.01 x = 0: −2 ± √3.99, of which this run does not tell the slow one, −0.0025, from 0.
  const LyapunovResult slow = lyapunov_of(ModelText(one + "V = 0.005 x^2\nD = 2 x'^2\nstart x' = 1\nrun 100\n"));
  CHECK_FALSE(slow.kaplan_yorke);
  CHECK(cycle.chaos == Chaos::Excluded);
}

TEST_CASE("exponents that cannot be had are told") {
  LyapunovOptions backwards;
  backwards.duration = -2;
  const auto code = [](const std::string& text, const LyapunovOptions& options = {}) {
    const ModelText m(text);
    return code_of([&](Diagnostics& d) { return lyapunov_exponents(m.model, m.equations, options, d); });
  };
  CHECK(code(one + "V = 1/2 x^2\nstart x = 1\n") == "E1406");
  CHECK(code(one + "V = 1/2 x^2\nstart x = 1\n", backwards) == "E1406");
  CHECK(code(one + "V = abs(x)\nstart x = 1\nrun 10\n") == "E1403");
  CHECK(code(one + "V = -1/x\nstart x = 1\nrun 100\n") == "E1408");
}

TEST_CASE("an interrupted transient has averages of its own, but for its first tenth") {
  const ModelText m(one + "V = -1/2 x^2\nstart x = 1e-9\n");
  StopFlag stop(false);
  std::size_t told = 0, at = 0;
  LyapunovOptions options;
  options.duration = 30;
  options.transient = 10;
  options.interval = 0.1;
  options.interrupt = &stop;
  options.progress = [&](double fraction) {
    CHECK(fraction == doctest::Approx(static_cast<double>(++told) / 400));
    stop = told == at;
  };
  at = 80;  // of 100
  const LyapunovResult r = lyapunov_of(m, options);
  CHECK(r.ended.find("before its transient was over") != std::string::npos);
  CHECK(r.duration == doctest::Approx(7.2));
  CHECK(r.times.back() == doctest::Approx(7.2));
  REQUIRE(r.exponents.size() == 2);
  CHECK(std::abs(r.exponents[0] - 1) < 0.1);
  CHECK(std::abs(r.exponents[1] + 1) < 0.1);
  CHECK(std::abs(r.sum) < 1e-12);
  CHECK_FALSE(r.expected_sum);
  // Later the average is the one that was asked for, so far; of a few intervals there is none.
  stop = false, told = 0, at = 300;
  const LyapunovResult later = lyapunov_of(m, options);
  CHECK(later.duration == doctest::Approx(20));
  CHECK(later.ended.find("transient") == std::string::npos);
  CHECK(later.expected_sum == 0);
  stop = false, told = 0, at = 10;
  Diagnostics unheard;
  CHECK_FALSE(lyapunov_exponents(m.model, m.equations, options, unheard));
}
