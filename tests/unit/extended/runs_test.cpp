#include "../under_sanitizers.hpp"
#include "decimal.hpp"

#include <atomic>
#include <fstream>
#include <sstream>

using namespace maupertuis;

namespace {

std::string text_of_model(const std::string& name) {
  std::ifstream in(std::string(PROJECT_DIR) + "/models/" + name + ".lag");
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

const std::string two_links =
    "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ1, θ2 : angle\npoint A mass m at l (sin θ1, -cos "
    "θ1)\n"
    "point B mass m at A + l (sin θ2, -cos θ2)\ngravity (0, -g)\nstart θ1 = 2.0 rad, θ2 = 2.5 rad\nrun 2 s\n";

std::string code_of(const std::string& model, const ExtendedSimulationOptions& options) {
  const ModelText m(model);
  Diagnostics diagnostics;
  CHECK_FALSE(simulate_extended(m.model, m.equations, options, diagnostics));
  REQUIRE(diagnostics.has_errors());
  return diagnostics.items().front().code;
}

}  // namespace

TEST_CASE("published: two equal links from 2.0 and 2.5 rad") {
  ExtendedSimulationOptions options;
  options.at = {1};
  const ExtendedResult r = run(ModelText(two_links), options);
  CHECK(std::abs(std::stod(r.at[0].q[0].text) - -0.08386042040500097) < 1e-14);
  CHECK(std::abs(std::stod(r.final.q[0].text) - -2.922032235907541) < 1e-14);
  CHECK(std::abs(std::stod(r.final.q[1].text) - 0.11738517220261478) < 1e-14);
}

TEST_CASE("three links with motors: the 24 digits of an extrapolation in 44-digit decimals") {
  const ModelText m(text_of_model("robot_arm"));
  ExtendedSimulationOptions options;
  options.duration = 1;
  const ExtendedResult r = run(m, options);
  // scripts/reference_values.py with a tolerance of 1e-24
  const Decimal reference[] = {Decimal("-1.0323914463327167700203943"), Decimal("-0.27531012138045755450412685"),
                               Decimal("-0.21217560882688708963972821")};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(r.final.q[i].digits > 30);
    CHECK(abs(Decimal(r.final.q[i].text) - reference[i]) < Decimal("3e-25"));
  }
}

TEST_CASE("quad and 100 digits agree on every digit that quad claims, and the motion loses some") {
  ExtendedSimulationOptions options;
  options.duration = under_sanitizers ? 3 : 6;
  const ExtendedResult quad = run(ModelText(two_links), options);
  options.precision = Precision::Digits100;
  options.tolerance = 1e-50;
  const ExtendedResult more = run(ModelText(two_links), options);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(quad.final.q[i].digits > 15);
    CHECK(quad.final.q[i].digits < 33);
    check_digits(quad.final.q[i], Decimal(more.final.q[i].text), 15);
    check_digits(quad.final.v[i], Decimal(more.final.v[i].text), 15);
  }
}

TEST_CASE("the gallery: what double computes, to its accuracy") {
  for (const char* const name :
       {"pendulum", "double_pendulum", "elastic_pendulum", "kepler", "cart_pendulum", "bead_on_hoop", "bead_on_wire",
        "cartesian_pendulum", "four_bar", "knife_edge", "rolling_disk", "satellite"}) {
    CAPTURE(name);
    const ModelText m(text_of_model(name));
    Diagnostics diagnostics;
    SimulationOptions in_double;
    in_double.duration = 1;
    const auto plain = simulate(m.model, m.equations, in_double, diagnostics);
    ExtendedSimulationOptions options;
    options.duration = 1;
    const ExtendedResult r = run(m, options);
    REQUIRE(plain);
    REQUIRE(r.ok());
    for (std::size_t i = 0; i < plain->final.q.size(); ++i) {
      const double size = std::max({1e-3, std::abs(plain->final.q[i]), std::abs(plain->final.v[i])});
      CHECK(std::abs(plain->final.q[i] - std::stod(r.final.q[i].text)) < 1e-12 * size);
      CHECK(std::abs(plain->final.v[i] - std::stod(r.final.v[i].text)) < 1e-12 * size);
    }
  }
}

TEST_CASE("rows: begin, steps of `every`, and the end") {
  ExtendedSimulationOptions options;
  options.rows = true;
  options.output_every = Rational(3, 10);
  const ExtendedResult r = run(ModelText(two_links), options);
  REQUIRE(r.rows.size() == 8);  // 0, 0.3, … 1.8, 2
  check_digits(r.rows[1].t, Decimal("0.3"), 33);
  check_digits(r.rows[7].t, 2, 33);
  CHECK(r.rows[7].q[0].text == r.final.q[0].text);
  const std::string csv = to_csv(r);
  CHECK(csv.rfind("t [s],θ1 [rad],θ2 [rad],θ1' [rad/s],θ2' [rad/s],A.x [m]", 0) == 0);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
  CHECK(csv.find(r.final.q[0].text) != std::string::npos);
}

TEST_CASE("a collision ends the run with its reason, and the check run stops there too") {
  const ModelText m("system fall\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\nrun 3\n");
  const ExtendedResult r = run(m, {});
  CHECK_FALSE(r.ok());
  CHECK(r.ending == Ending::StepUnderflow);
  CHECK(r.reached == doctest::Approx(1.1107207345395915).epsilon(1e-12));  // π / √8
}

TEST_CASE("where the check alone comes to an end, the run ends with its reason and without a state") {
  // 1 − 10⁻³⁶ is 1 in 113 bits: the check alone meets a force, which takes more steps than a run of one step may have.
  const ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "force y = -1e50 step(x - 1 + 1e-36) sign(y - 1e-30)\nstart x' = 1\n");
  ExtendedSimulationOptions options;
  options.duration = 1;
  const ExtendedResult r = run(m, options);
  CHECK(r.ending == Ending::TooManySteps);
  CHECK(r.reason == "the check in 192 bits that tells the digits ended: The run used up its steps.");
  CHECK_FALSE(r.ok());
  for (const AgreedNumber& number : {r.final.q[1], r.final.v[1]}) CHECK(number.digits == 0);

  const ModelText until(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x' = 1\n"
      "event far when x = 1 + 1e-36 : stop\nrun 1 + 1e-35\n");
  const ExtendedResult missed = run(until, {});
  CHECK(missed.ending == Ending::NoConvergence);
  CHECK(missed.reason ==
        "what ends it was met by the check in 192 bits that tells the digits, and not by the run: it is too near to "
        "being missed to be told");
}

TEST_CASE("interrupted, out of steps, and what is not possible") {
  std::atomic<bool> stop = true;
  ExtendedSimulationOptions options;
  options.interrupt = &stop;
  const ExtendedResult interrupted = run(ModelText(two_links), options);
  CHECK(interrupted.ending == Ending::Interrupted);
  CHECK_FALSE(interrupted.final.reached);
  CHECK(interrupted.reached == 0);

  options = {};
  options.maximum_steps = 3;
  const ExtendedResult cut = run(ModelText(two_links), options);
  CHECK(cut.ending == Ending::TooManySteps);
  CHECK(cut.reached > 0);
  CHECK(cut.final.q[0].digits > 25);

  options = {};
  options.method = StepMethod::Stiff;
  CHECK(code_of(two_links, options) == "E0725");
  options.method = StepMethod::Variational;
  CHECK(code_of(two_links, options) == "E0725");
  options = {};
  options.at = {-1};
  CHECK(code_of(two_links, options) == "E0706");
}

TEST_CASE("no digit is made up") {
  CHECK(agreed_number("1.2345678e0", "1.2345679e0", 30).text == "1.234568");
  CHECK(agreed_number("1.2345678e0", "1.2345679e0", 30).digits == 7);
  CHECK(agreed_number("-3e-40", "2e-40", 30).digits == 0);
  CHECK(agreed_number("1.2e0", "1.4e0", 30).digits == 1);
  CHECK(agreed_number("1.2e0", "1.4e0", 30).text == "1");
  CHECK(agreed_number("-9.61e3", "-9.64e3", 1).text == "-1e4");
  CHECK(agreed_number("9.61e-3", "9.64e-3", 1).text == "0.01");
  CHECK(agreed_number("-3e-40", "2e-40", 30).text == "0");
  CHECK(agreed_number("0", "0", 30).text == "0");
  CHECK(agreed_number("2.5e0", "2.5e0", 4).text == "2.500");
  CHECK(agreed_number("1.25e7", "1.25e7", 3).text == "1.25e7");
  CHECK(agreed_number("1.25e3", "1.25e3", 6).text == "1250.00");
  CHECK(agreed_number("-1.25e-3", "-1.25e-3", 3).text == "-0.00125");
  CHECK(agreed_number("9.999e0", "1.0001e1", 10).text == "10.00");
}
