#include "support.hpp"

// What people write on paper and in other languages: each is told once, with carets below the whole of it, and with the
// text to write.

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

struct Habit {
  const char *line, *code, *marked, *says;
};

const std::string kHead =
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, ω = 2 rad/s, m1 = 2 kg\ncoord θ, θ1 : angle, x : length\n"
    "T = 1/2 m l^2 (θ'^2 + θ1'^2) + 1/2 m x'^2 + 1/2 m1 x'^2\nlet used = g ω\n";

}  // namespace

TEST_CASE("habits of paper are told with what to write") {
  for (const Habit& h : {
           // products run together
           Habit{"V = -mgl cos θ", "E0201", "mgl", "Write m g l."},
           Habit{"V = mgl(1 - cos θ)", "E0122", "mgl", "Write m g l (1 - cos θ)."},
           Habit{"let a = lsinθ", "E0201", "lsinθ", "Write l sin θ."},
           Habit{"let a = mtheta", "E0201", "mtheta", "Write m θ."},
           // functions
           Habit{"let a = sinθ", "E0201", "sinθ", "Write sin θ."},
           Habit{"let a = cosωt", "E0201", "cosωt", "Write cos(ω t)."},
           Habit{"let a = sin2θ", "E0201", "sin2θ", "Write sin 2θ."},
           Habit{"let a = ln(x/l)", "E0122", "ln", "Write log(x/l)."},
           Habit{"let a = arctan(x/l)", "E0122", "arctan", "Write atan(x/l)."},
           Habit{"let a = Sin(θ)", "E0122", "Sin", "Write sin(θ)."},
           Habit{"let a = log10(x/l)", "E0122", "log10", "log(x)/log(10)"},
           Habit{"let a = ln x", "E0201", "ln", "log(…)"},
           Habit{"let a = e^(-t/(1 [s]))", "E0201", "e^(-t/(1 [s]))", "Write exp(-t/(1 [s]))."},
           Habit{"let a = e^-θ", "E0201", "e^-θ", "Write exp(-θ)."},
           // derivatives
           Habit{"let a = θdot^2", "E0201", "θdot", "Write θ'."},
           Habit{"let a = theta_dot", "E0201", "theta_dot", "Write θ'."},
           Habit{"let a = thetadot", "E0201", "thetadot", "Write θ'."},
           Habit{"let a = thetadot1", "E0201", "thetadot1", "Write θ1'."},
           Habit{"let a = xddot", "E0201", "xddot", "Write x''."},
           Habit{"let a = d/dt θ", "E0201", "d/dt θ", "Write θ'."},
           Habit{"let a = m d/dt l θ", "E0201", "d/dt l", "Write l'."},
           Habit{"let a = d/dt (l θ)^2", "E0201", "d/dt (l θ)^2", "Write ((l θ)^2)'."},
           Habit{"let a = dθ/dt", "E0201", "dθ/dt", "Write θ'."},
           Habit{"let a = dtheta/dt", "E0201", "dtheta/dt", "Write θ'."},
           Habit{"let a = d^2θ/dt^2", "E0201", "d^2θ/dt^2", "Write θ''."},
           // units in formulas
           Habit{"let a = 9.81 m/s^2", "E0312", "9.81 m/s^2", "Write 9.81 [m/s^2]."},
           Habit{"let a = 3 N cos(ω t)", "E0312", "3 N", "Write 3 [N]."},
           Habit{"V = 1/2 (40 N/m) x^2", "E0312", "40 N/m", "Write 40 [N/m]."},
           // units
           Habit{"param a = 2 Nm", "E0301", "Nm", "Write N m"},
           Habit{"param a = 2 sec", "E0301", "sec", "Write s."},
           Habit{"param a = 2 kgm^2", "E0301", "kgm^2", "Write kg m"},
       }) {
    CAPTURE(h.line);
    const Elaborated e(kHead + h.line + "\n");
    INFO(e.messages());
    std::vector<Diagnostic> errors;
    for (const Diagnostic& d : e.diagnostics.items())
      if (d.severity == Severity::Error) errors.push_back(d);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == h.code);
    REQUIRE(errors[0].span);
    CHECK(e.source.slice(*errors[0].span) == h.marked);
    CHECK((errors[0].message + " " + errors[0].reason + " " + errors[0].help).find(h.says) != std::string::npos);
  }
}

TEST_CASE("a declared name is a name, whatever it looks like") {
  const Elaborated e(
      "dimensionless\nparam e = 2, d = 3, dt = 4, mgl = 5, ln = 6, xdot = 7\ncoord x : number\nT = 1/2 mgl x'^2\n"
      "V = e^x + d/dt x + ln x + xdot x\n");
  CHECK_MESSAGE(e.model.has_value(), e.messages());
}

TEST_CASE("d/dt of a bracket is the derivative of what stands in it") {
  for (const auto& [written, primes] : {std::pair("d/dt (l θ)", "(l θ)'"),
                                        {"m d/dt(l^2 θ)", "m (l^2 θ)'"},
                                        {"d/dt (θ x)/l", "(θ x)'/l"},
                                        {"d²/dt² (θ)", "θ''"},
                                        {"2 m d/dt (x) l", "2 m x' l"}}) {
    CAPTURE(written);
    const Elaborated e(kHead + "claim " + written + " = " + primes + "\n");
    CHECK_FALSE(e.diagnostics.has_errors());
    const auto* claim = std::get_if<expectation::Equation>(&e.model->experiment.expectations.at(0).kind);
    REQUIRE(claim);
    CHECK(claim->left == claim->right);
  }
  // The names are the model's where it has them.
  const Elaborated named(kHead + "param d = 2 m, dt = 3 m\nlet a = d/dt (l θ)\nclaim a = d l θ/dt\n");
  CHECK_FALSE(named.diagnostics.has_errors());
}
