// Lagrangians that hold q'': equations of the fourth order and their motions, against closed forms.
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <maupertuis/higher_order.hpp>
#include <maupertuis/print.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

std::string messages_of(const Study& study) { return render(study.diagnostics(), study.texts()); }

Study study_of(const std::string& text) { return Study(SourceText("test.lag", "dimensionless\n" + text)); }

const std::string kPaisUhlenbeck =
    "param a = 1, b = 2\ncoord q : number\nL = 1/2 q''^2 - 1/2 (a^2 + b^2) q'^2 + 1/2 a^2 b^2 q^2\n";

State end_with(const std::string& text) {
  Study study = study_of(text);
  const auto result = study.motion();
  REQUIRE_MESSAGE(result, messages_of(study));
  REQUIRE(result->ok());
  return result->final;
}

}  // namespace

TEST_CASE("the equation, the momenta and the energy of a Lagrangian with q''") {
  Study study = study_of(kPaisUhlenbeck);
  const EquationsOfMotion* equations = study.equations();
  REQUIRE_MESSAGE(equations, messages_of(study));
  const HigherOrderForm form = higher_order_form(*equations);
  REQUIRE(form.residual.size() == 1);
  Context& context = *equations->system->context;
  const auto q = [&](int order) { return context.symbol("q", Role::Coordinate, order); };
  const Expr a = equations->system->find_parameter("a")->symbol, b = equations->system->find_parameter("b")->symbol;
  // R = d/dt ∂L/∂q' − ∂L/∂q − d²/dt² ∂L/∂q''
  const Expr row = -q(4) - (a * a + b * b) * q(2) - a * a * b * b * q(0);
  const Expr energy = -q(3) * q(1) + Rational(1, 2) * q(2) * q(2) - Rational(1, 2) * (a * a + b * b) * q(1) * q(1) -
                      Rational(1, 2) * a * a * b * b * q(0) * q(0);
  CHECK(zero_test(form.residual[0] - row).verdict == Verdict::Zero);
  CHECK(zero_test(form.energy_function - energy).verdict == Verdict::Zero);
  CHECK(form.acceleration_momenta[0] == q(2));
  const Certificate* certificate = study.certificate();
  REQUIRE_MESSAGE(certificate, messages_of(study));
  CHECK(certificate->passed());
  CHECK(certificate->checks.back().name == "higher_power");
  CHECK(study.degenerate()->motions == 4);
}

TEST_CASE("motions with q'' in L against closed forms") {
  // q'''' = q with q = cos t + sinh t
  const State mixed =
      end_with("coord q : number\nL = 1/2 q''^2 - 1/2 q^2\nstart q = 1, q' = 1, q'' = -1, q''' = 1\nrun 2\n");
  CHECK(mixed.q[0] == doctest::Approx(std::cos(2) + std::sinh(2)).epsilon(1e-14));
  CHECK(mixed.v[0] == doctest::Approx(-std::sin(2) + std::cosh(2)).epsilon(1e-14));
  // two frequencies: q = cos t + sin 2t
  const State two = end_with(kPaisUhlenbeck + "start q = 1, q' = 2, q'' = -1, q''' = -8\nrun 10\n");
  CHECK(two.q[0] == doctest::Approx(std::cos(10) + std::sin(20)).epsilon(1e-12));
  // explicit t and a force: q'''' = t + 2 from rest, q = t⁵/120 + t⁴/12
  const State driven = end_with("coord q : number\nL = 1/2 q''^2 - q t\nforce q = -2\nrun 3\nstart q = 0\n");
  CHECK(driven.q[0] == doctest::Approx(243.0 / 120 + 81.0 / 12).epsilon(1e-14));
  // two coordinates that q'' couples: u = x + y, w = x − y with 3/4 u'''' = u/2, 1/4 w'''' = w/2
  const State coupled = end_with(
      "coord x, y : number\nL = 1/2 (x''^2 + y''^2 + x'' y'') - 1/2 (3/2 x^2 + 3/2 y^2)\n"
      "start x = 1, y = 1, x'' = 1, y'' = 1\nrun 1\n");
  CHECK(coupled.q[0] == doctest::Approx(std::cosh(1)).epsilon(1e-14));
  CHECK(coupled.q[0] == doctest::Approx(coupled.q[1]).epsilon(1e-15));
}

TEST_CASE("a term linear in q'' leaves an equation of the second order") {
  // x x'' is −x'^2 and a total derivative: L = −1/2 x'^2 and a free particle
  Study study = study_of("coord x : number\nL = 1/2 x'^2 + x x''\nstart x = 1, x' = 0.5\nrun 2\n");
  const auto result = study.motion();
  REQUIRE_MESSAGE(result, messages_of(study));
  CHECK(study.degenerate()->motions == 2);
  CHECK(result->final.q[0] == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("a start beside the text gives second and third derivatives as well; energies by parts and friction") {
  Study study =
      study_of("coord q : number\nT = 1/2 q'^2\nV = 1/2 q^2\nL += -1/2 q''^2\nD = 1/2 q'^2\nrun 1\nstart q = 1\n");
  study.override_with(OverrideKind::Start, "--start", "q'' = 2, q''' = -3");
  const auto result = study.motion();
  REQUIRE_MESSAGE(result, messages_of(study));
  CHECK(study.diagnostics().items().size() == 1);  // N0632
  // q'''' + q'' + q' + q = 0 by its power series
  double c[40] = {1, 0, 1, -0.5}, q = 0;
  for (int k = 0; k + 4 < 40; ++k)
    c[k + 4] = -((k + 2) * (k + 1) * c[k + 2] + (k + 1) * c[k + 1] + c[k]) / ((k + 4.0) * (k + 3) * (k + 2) * (k + 1));
  for (const double x : c) q += x;
  CHECK(result->final.q[0] == doctest::Approx(q).epsilon(1e-14));
}

TEST_CASE("expectations about fourth derivatives can fail") {
  const auto verdict = [](const std::string& line) {
    Study study = study_of(kPaisUhlenbeck + "start q = 1, q'' = -1\nrun 1\nexpect " + line + "\n");
    const auto result = study.verification();
    REQUIRE_MESSAGE(result, messages_of(study));
    return result->failed() == 0;
  };
  CHECK(verdict("equation q'''' + (a^2 + b^2) q'' + a^2 b^2 q = 0"));
  CHECK_FALSE(verdict("equation q'''' - (a^2 + b^2) q'' + a^2 b^2 q = 0"));
  CHECK_FALSE(verdict("equation q'''' + (a^2 + b^2) q'' - a^2 b^2 q = 0"));
  CHECK(verdict("q''' at 1 = 0.8414709848078965 ± 1e-13"));
  CHECK_FALSE(verdict("q''' at 1 = -0.8414709848078965 ± 1e-13"));
  CHECK(verdict("energy conserved"));
}

TEST_CASE("what a start of a degenerate Lagrangian does not give stays 0 where that fits") {
  // a = (x' + y')/2, the other constraints ask for velocities: a' = x − y
  const State fixed = end_with(
      "coord x, y, a : number\nL = 1/2 (x' - a)^2 + 1/2 (y' - a)^2 - 1/2 (x - y)^2\ngauge x = 0\nstart y = 1\nrun 3\n");
  CHECK(fixed.q[1] == doctest::Approx(std::cos(3 * std::sqrt(2.0))).epsilon(1e-11));
  // w has to be 1; y need not move, since y' = −1 does it.
  const State turned = end_with(
      "coord x, y, w : number\nL = 1/2 ((x' - w y)^2 + (y' + w x)^2) - 1/2 (x^2 + y^2)\ngauge w = 1 + t\n"
      "start x = 1, x' = 0.3\nrun 1\n");
  CHECK(turned.q[0] == doctest::Approx((std::cos(1.0) + 0.3 * std::sin(1.0)) * std::cos(1.5)).epsilon(1e-11));
}

TEST_CASE("degenerate motions go through states where other rows would be singular") {
  // A pendulum with its multiplier as a coordinate, through the horizontal: x = sin θ, y = −cos θ.
  const State pendulum = end_with(
      "coord x, y, l : number\nL = 1/2 (x'^2 + y'^2) - 9.81 y + l (x^2 + y^2 - 1)\n"
      "start x = 0.6, y = -0.8, x' = 4, y' = 3\nrun 2\n");
  const State angle =
      end_with("coord θ : angle\nT = 1/2 θ'^2\nV = -9.81 cos θ\nstart θ = asin(0.6) rad, θ' = 5 rad\nrun 2\n");
  CHECK(pendulum.q[0] == doctest::Approx(std::sin(angle.q[0])).epsilon(1e-11));
  CHECK(pendulum.q[1] == doctest::Approx(-std::cos(angle.q[0])).epsilon(1e-11));
  // Radial motion in a turned frame, r = cos t, through r = 0.
  const State radial = end_with(
      "coord x, y, w : number\nL = 1/2 ((x' - w y)^2 + (y' + w x)^2) - 1/2 (x^2 + y^2)\ngauge w = 1 + t\n"
      "start x = 1\nrun 3\n");
  CHECK(radial.q[0] == doctest::Approx(std::cos(3.0) * std::cos(7.5)).epsilon(1e-11));
  CHECK(radial.q[1] == doctest::Approx(-std::cos(3.0) * std::sin(7.5)).epsilon(1e-11));
}

TEST_CASE("a run whose chosen rows jump says so, and nothing of the motion") {
  Study study =
      study_of("coord x, y : number\nL = 1/2 (x y' - y x') - abs(x) - 1/2 y^2\nstart x = 0.3, y = 0.1\nrun 8\n");
  const auto result = study.motion();
  REQUIRE(result);
  CHECK_FALSE(result->ok());
  CHECK(result->reason.find("the motion itself may go on") != std::string::npos);
}
