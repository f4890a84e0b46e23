#include "support.hpp"

#include <cmath>

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

namespace {

/// The message that `V = <formula>` gives, in a model with a few quantities; empty if it is an energy.
std::string message_of(const std::string& formula) {
  const Elaborated e(
      "param m = 1 kg, l = 2 m, g = 9.81 m/s^2, k = 3 N/m, τ = 1 s, f = 5 Hz, ω = 2 rad/s, n = 3, Q = 1 C\n"
      "coord x : length, θ : angle\nT = 1/2 m x'^2 + 1/2 m l^2 θ'^2\nV = " +
      formula + "\n");
  for (const Diagnostic& d : e.diagnostics.items())
    if (d.severity == Severity::Error) return d.code + " " + d.message;
  return "";
}

}  // namespace

TEST_CASE("formulas of one dimension pass") {
  for (const char* good : {"m g l cos θ",
                           "1/2 k x^2",
                           "k x l sin θ + 0",
                           "m g l (1 - cos θ) + 0 + k (x - l θ)^2",
                           "3 [J] cos 2θ",
                           "m (l/τ)^2 n",
                           "m g sqrt(x^2 + l^2)",
                           "k l^2 exp(-x/l)",
                           "k abs(x) l",
                           "k max(x, l)^2",
                           "piecewise(x < l : k x l, else : k l^2)",
                           "m g l atan2(x, l)",
                           "k l^2 (x/l)^n",
                           "m l^n g/l^2",
                           "k l^2 sin(2 pi f t)",
                           "k l^2 sin(ω t)",
                           "m (ω l)^2",
                           "k norm((x, l)) l",
                           "k dot((x, l), (x, l))",
                           "k cross((x, l), (l, x))",
                           "10 [N] x",
                           "2 [kcal] θ"})
    CHECK_MESSAGE(message_of(good) == "", good << ": " << message_of(good));
}

TEST_CASE("a name among units after a number is told where it is the time, or where it would fit") {
  const auto help_of = [](const std::string& line) {
    const Elaborated e("param m = 1 kg, k = 3 N/m, h = 1 m\ncoord x : length\nT = 1/2 m x'^2\n" + line + "\n");
    REQUIRE(e.codes() == "E0304");
    return e.diagnostics.items().front().help;
  };
  CHECK(help_of("force x = 5 t N/s") ==
        "`t N/s` was read as a unit, with `t` for a mass (kg). For the time write 5 [N/s] t.");
  CHECK(help_of("force x = -5 N t") ==
        "`N t` was read as a unit, with `t` for a mass (kg). For the time write 5 [N/s] t.");
  CHECK(help_of("force x = 5 N s^-2 t^2") ==
        "`N s^-2 t^2` was read as a unit, with `t` for a mass (kg). For the time write 5 [N/s^2] t^2.");
  CHECK(help_of("start x = 2 kg m") == "");  // no name makes a length of it
  CHECK(help_of("force x = 5 m") == "");
}

TEST_CASE("messages name both sides in words of physics") {
  CHECK(message_of("k x^2 + k x") == "E0302 this adds a force (N) to an energy (J)");
  CHECK(message_of("k x^2 - m g") == "E0302 this subtracts a force (N) from an energy (J)");
  CHECK(message_of("m g") == "E0304 the potential energy is an energy (J), this is a force (N)");
  CHECK(message_of("k x^2 cos x") == "E0303 the argument of cos is a length (m)");
  CHECK(message_of("k l^2 * 2^x") == "E0305 the exponent is a length (m)");
  CHECK(message_of("piecewise(x < τ : k x^2, else : 0)") == "E0302 this compares a length (m) with a time (s)");
  CHECK(message_of("k max(x, τ) x") == "E0302 a time (s) meets a length (m)");
  CHECK(message_of("k (x, τ)^2") == "E0302 this component is a time (s), the ones before it are a length (m)");
  CHECK(message_of("l (θ + f t) m g") == "E0306 a frequency in Hz meets an angular velocity in rad/s" + std::string());
}

TEST_CASE("dimensions of definitions are inferred, quantities converted exactly") {
  const Elaborated e(
      "param m = 2 g, v = 36 km/h, α = 180 deg, p = 1 bar, n = 60 rpm\ncoord x : length\nlet E = 1/2 m v^2, β = α/2\nT "
      "= 1/2 m x'^2\nV = E p x/(1 [Pa m])\nforce x = 1 [N] sin β\nstart x' = 1 cm/s\n"
      "expect x at n 1 [s^2/rad] = 3 mm ± 0.5\n");
  CHECK_MESSAGE(e.model.has_value(), e.messages());
  const MechanicalSystem& s = e.system();
  CHECK(s.find_parameter("m")->si_value == 0.002);
  CHECK(s.find_parameter("v")->si_value == 10);
  CHECK(s.find_parameter("v")->unit == "km/h");
  CHECK(s.find_parameter("α")->value == s.context->pi());
  CHECK(s.find_parameter("p")->si_value == 1e5);
  CHECK(s.find_parameter("n")->si_value == 2 * std::acos(-1.0));
  CHECK(physical_name(s.definitions[0].dimension) == "energy");
  CHECK(evaluate(e.experiment().start[0].value, e.at({0}, {0})) == 0.01);
  // a tolerance without a unit is in the unit of the value
  CHECK(evaluate(e.expected<expectation::ValueAt>(0).expected.tolerance.size, e.at({0}, {0})) == Approx(0.0005));
}

TEST_CASE("a word after a number is a unit or a name, whichever fits") {
  const Elaborated e(
      "param m = 1 kg, R = 2 m, s = 3 m\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = 1 [N/m] R^2 + s 1 "
      "[N]\nstart x = 2 m, y = 2 R, z = 2 s\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  const auto at = e.at({0, 0, 0}, {0, 0, 0});
  CHECK(evaluate(e.experiment().start[0].value, at) == 2);  // metres, since twice the mass is no length
  CHECK(evaluate(e.experiment().start[1].value, at) == 4);
  CHECK(evaluate(e.experiment().start[2].value, at) == 6);  // seconds are no length
}

TEST_CASE("numbers with units in formulas become anonymous constants, angles do not") {
  const Elaborated e("param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nV = 3 [J] cos(x/(2 [m]) + 30 [deg]) + 3 [J]\n");
  const MechanicalSystem& s = e.system();
  REQUIRE(s.parameters.size() == 3);
  CHECK(s.parameters[1].name == "3 J");
  CHECK(s.parameters[1].symbol.role() == Role::Constant);
  CHECK(s.parameters[2].name == "2 m");
  CHECK(value(s.potential_energy(), e.at({1}, {0})) == Approx(3 * std::cos(0.5 + std::acos(-1.0) / 6) + 3));
}

TEST_CASE("a bracket is measured by the product of its sides over an action") {
  const std::string model = "param m = 1 kg, k = 2 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n";
  for (const char* line :
       {"expect bracket (x, p_x) = 1", "expect bracket (p_x, x) = -1", "expect bracket (x^2, p_x) = 2 x",
        "expect bracket (p_x, k x^2) = -2 k x", "expect bracket (x, x) = 0"}) {
    const Elaborated e(model + line + "\n");
    CHECK_MESSAGE(e.codes() == "", line << ": " << e.messages());
    CHECK(e.experiment().expectations.size() == 1);
  }
  CHECK(Elaborated(model + "expect bracket (x, p_x) = x\n").codes() == "E0304");
  CHECK(Elaborated(model + "expect bracket (x^2, p_x) = 2\n").codes() == "E0304");
}

TEST_CASE("numbers may have 200 bytes") {
  const std::string model = "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nV = 1 [J/m] x * ";
  CHECK(Elaborated(model + "0." + std::string(198, '3') + "\n").codes() == "");
  CHECK(Elaborated(model + "0." + std::string(199, '3') + "\n").codes() == "E0101");
  CHECK(Elaborated(model + "1" + std::string(199, '0') + "\n").codes() == "");
}

TEST_CASE("dimensionless models have no units") {
  const Elaborated e(
      "dimensionless\nparam μ = 0.0123\ncoord x, y : length, θ : angle\nT = x'^2 + y' + y'^2 + θ'^2\nV = x + y^2 + sin "
      "x\nstart θ = 90 deg\n");
  CHECK_MESSAGE(!e.diagnostics.has_errors(), e.messages());
}

TEST_CASE("degrees that were written without a unit are asked for, in starts and in formulas") {
  const std::string model = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\n";
  CHECK(Elaborated(model + "V = m g l cos(θ + 30)\n").codes() == "W0310");
  CHECK(Elaborated(model + "V = m g l cos θ sin(30)\n").codes() == "W0310");
  CHECK(Elaborated(model + "V = m g l cos θ\nrun 1 s\nexpect θ at 0 s = 60 ± 1e-9\n").codes() == "W0310");
  CHECK(Elaborated(model + "V = m g l cos(θ + 30 [deg]) + m g l sin(1)\n").fine());
  CHECK(Elaborated(model + "V = m g l cos θ\nstart θ = 3.2\n").fine());
  const auto inclined = [&](const char* angle) {
    return Elaborated(model + "param α = " + angle + "\nV = m g l cos θ sin α\n").codes();
  };
  CHECK(inclined("30") == "W0310");
  for (const char* angle : {"30 deg", "30 rad", "0.5"}) CHECK(inclined(angle).empty());
}

TEST_CASE("values that no run could begin with") {
  const std::string model = "param m = 1 kg, a = 0 m, b = 2 m\ncoord x : length\nT = 1/2 m x'^2\n";
  CHECK(Elaborated(model + "let c = b/a\nV = 1 [J] c x/b\n").codes() == "E0218");
  CHECK(Elaborated(model + "start x = b^2/a\n").codes() == "E0218");
  CHECK(Elaborated(model + "V = 1 [J] sqrt(a - b) x/b^(3/2)\nstart x = sqrt(a - b) sqrt(b)\n").codes() == "E0218");
}

TEST_CASE("a unit that does not fit is told once, however many numbers it stands behind") {
  CHECK(Elaborated("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n"
                   "expect eigenvalues at x = 0 : (0, 1) 1/s rel 1e-9\n")
            .codes() == "E0308");
}
