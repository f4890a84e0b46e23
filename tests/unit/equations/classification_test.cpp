#include "../model_text.hpp"

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/print.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

/// A model and what its constraints come to.
struct Analysed : ModelText {
  ConstraintAnalysis found;
  explicit Analysed(std::string text) : ModelText(std::move(text)), found(analyse_constraints(equations)) {}
  ConstraintClass class_of(std::size_t i) const { return found.constraints[i].constraint_class; }
  std::string integral(std::size_t i) const { return text(found.constraints[i].integral); }
  std::string text(const FirstIntegral& f) const { return f.found() ? to_plain(f.value, equations.order) : ""; }
};

constexpr auto holonomic = ConstraintClass::Holonomic, nonholonomic = ConstraintClass::Nonholonomic,
               integrable = ConstraintClass::Integrable, nonlinear = ConstraintClass::Nonlinear;
using Set = std::vector<std::size_t>;

/// dz-like forms: coordinates x, y, z without units and one constraint.
std::string space(const std::string& constraints) {
  return "dimensionless\nparam a = 2\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\n" + constraints;
}

}  // namespace

TEST_CASE("a rolling disk can reach every place and heading, in two directions at a time") {
  const Analysed m(R"(param m = 1 kg, R = 20 cm
coord x, y : length
coord φ, ψ : angle
T = 1/2 m (x'^2 + y'^2) + 1/4 m R^2 φ'^2 + 1/8 m R^2 ψ'^2
constraint x' = R φ' cos ψ
constraint y' = R φ' sin ψ
)");
  CHECK(m.class_of(0) == nonholonomic);
  CHECK(m.class_of(1) == nonholonomic);
  CHECK(m.found.constraints[0].scleronomic);
  CHECK(m.found.configuration_freedoms == 4);
  CHECK(m.found.instantaneous_freedoms == 2);
  CHECK(m.found.combinations.empty());
  CHECK_FALSE(m.found.redundant());
}

TEST_CASE("a disk that keeps its heading rolls holonomically") {
  const Analysed m(R"(param m = 1 kg, R = 20 cm
coord x : length, φ : angle
T = 1/2 m x'^2 + 1/4 m R^2 φ'^2
constraint x' = R φ' name roll
)");
  CHECK(m.class_of(0) == integrable);
  CHECK(m.integral(0) == "x - R φ");
  CHECK(m.found.configuration_freedoms == 1);
  CHECK(m.found.instantaneous_freedoms == 1);
}

TEST_CASE("forms in three variables") {
  CHECK(Analysed(space("constraint z' = y x'")).class_of(0) == nonholonomic);
  CHECK(Analysed(space("constraint z' = y x'")).found.configuration_freedoms == 3);
  const Analysed product(space("constraint y z' + z y' = 0"));
  CHECK(product.class_of(0) == integrable);
  CHECK(product.integral(0) == "y z");
  const Analysed quotient(space("constraint y z' = 2 z y'"));
  CHECK(quotient.class_of(0) == integrable);
  CHECK(quotient.found.constraints[0].integral.found());
  const Analysed sine(space("constraint z' = x' sin(a x) + y' x cos y + x' sin y"));
  CHECK(sine.integral(0) != "");
  // With y at rest z' = y x' is integrable: the distribution decides, not the row.
  const Analysed together(space("constraint z' = y x'\nconstraint y' = 0"));
  CHECK(together.class_of(0) == integrable);
  CHECK(together.integral(1) == "y");
  CHECK(together.found.configuration_freedoms == 1);
  const Analysed moving(space("constraint x' = a t"));
  CHECK(moving.class_of(0) == integrable);
  CHECK_FALSE(moving.found.constraints[0].scleronomic);
  CHECK(moving.found.configuration_freedoms == 2);
}

TEST_CASE("the wheels of an axle: the difference of their angles is a function of the heading") {
  const Analysed m(R"(param m = 1 kg, R = 20 cm, b = 30 cm
coord x, y : length
coord ψ, φ1, φ2 : angle
T = 1/2 m (x'^2 + y'^2) + 1/2 m b^2 ψ'^2 + 1/4 m R^2 (φ1'^2 + φ2'^2)
constraint y' cos ψ = x' sin ψ name blade
constraint x' cos ψ + y' sin ψ + b ψ' = R φ1' name left
constraint x' cos ψ + y' sin ψ - b ψ' = R φ2' name right
)");
  for (std::size_t i = 0; i < 3; ++i) CHECK(m.class_of(i) == nonholonomic);
  CHECK(m.found.configuration_freedoms == 4);
  CHECK(m.found.instantaneous_freedoms == 2);
  REQUIRE(m.found.combinations.size() == 1);
  CHECK(m.found.combinations[0].constraints == Set{1, 2});
  // R (φ1 − φ2) − 2 b ψ, up to a factor.
  REQUIRE(m.found.combinations[0].integral.found());
  const Expr f = m.found.combinations[0].integral.value;
  const Expr wanted = m.p("R") * (m.q(3) - m.q(4)) - m.p("b") * m.q(2) * Rational(2);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < i; ++j)
      CHECK(zero_test(differentiate(f, m.q(i)) * differentiate(wanted, m.q(j)) -
                      differentiate(f, m.q(j)) * differentiate(wanted, m.q(i)))
                .verdict == Verdict::Zero);
}

TEST_CASE("a combination names the constraints that it is made of, wherever they stand") {
  const std::string text =
      "param m = 1 kg, R = 20 cm, b = 30 cm\ncoord x, y : length\ncoord ψ, φ1, φ2 : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 m b^2 ψ'^2 + 1/4 m R^2 (φ1'^2 + φ2'^2)\n";
  const std::string blade = "constraint y' cos ψ = x' sin ψ\n",
                    left = "constraint x' cos ψ + y' sin ψ + b ψ' = R φ1'\n",
                    right = "constraint x' cos ψ + y' sin ψ - b ψ' = R φ2'\n";
  const auto named = [&](const std::string& constraints) {
    const Analysed m(text + constraints);
    REQUIRE(m.found.combinations.size() == 1);
    return m.found.combinations[0].constraints;
  };
  CHECK(named(left + right + blade) == Set{0, 1});
  CHECK(named(left + blade + right) == Set{0, 2});
}

TEST_CASE("gears: their constraints are holonomic, one freedom is left") {
  const Analysed m(R"(param Rs = 20 mm, Rp = 15 mm, I = 1e-5 kg m^2
coord φs, φp, φc, φr : angle
T = 1/2 I φs'^2 + 1/2 I φp'^2 + 1/2 I φc'^2
constraint Rs (φs - φc) = -Rp (φp - φc)
constraint (Rs + 2 Rp) (φr - φc) = Rp (φp - φc)
constraint φr = 0
)");
  for (std::size_t i = 0; i < 3; ++i) CHECK(m.class_of(i) == holonomic);
  CHECK(m.found.configuration_freedoms == 1);
  CHECK(m.found.instantaneous_freedoms == 1);
}

TEST_CASE("a blade, and the sleigh of Chaplygin") {
  for (const std::string offset : {"0", "a ψ'"}) {
    const Analysed m(
        "param m = 1 kg, a = 1 m\ncoord x, y : length\ncoord ψ : angle\n"
        "T = 1/2 m (x'^2 + y'^2) + 1/2 m a^2 ψ'^2\nconstraint y' cos ψ - x' sin ψ = " +
        offset + "\n");
    CHECK(m.class_of(0) == nonholonomic);
    CHECK(m.found.configuration_freedoms == 3);
    CHECK(m.found.instantaneous_freedoms == 2);
  }
}

TEST_CASE("a parallelogram with one crank too many moves, and the forces in it are not determined") {
  const std::string text = R"(param m = 1 kg, r = 1 m, a = 2 m
coord θ1, θ2, θ3, β : angle
T = 1/2 m r^2 (θ1'^2 + θ2'^2 + θ3'^2) + 1/2 m a^2 β'^2
constraint r cos θ1 + a cos β = a + r cos θ2 name far_x
constraint r sin θ1 + a sin β = r sin θ2 name far_y
constraint r cos θ1 + a/2 cos β = a/2 + r cos θ3 name middle_x
constraint r sin θ1 + a/2 sin β = r sin θ3 name middle_y
)";
  const ModelText plain(text);
  const MotionState start{0, {1, 1, 1, 0}, {0, 0, 0, 0}};
  const ConstraintAnalysis found = analyse_constraints(plain.equations, &start);
  CHECK(found.rank == 3);
  CHECK(found.start_rank == 3);
  CHECK(found.configuration_freedoms == 1);
  CHECK(found.instantaneous_freedoms == 1);
  CHECK(found.constraints[3].redundant);
  CHECK(found.constraints[3].depends_on == Set{0, 1, 2});
  CHECK(found.undetermined == Set{0, 1, 2, 3});
  // Where all bars lie on one line the branches meet.
  const MotionState flat{0, {0, 0, 0, 0}, {0, 0, 0, 0}};
  CHECK(analyse_constraints(plain.equations, &flat).singular_start());
}

TEST_CASE("a start is singular to rounding: cos 90° is 6e-17") {
  const ModelText m(R"(param m = 1 kg, r = 30 cm
coord φ : angle, s : length
T = 1/4 m r^2 φ'^2 + 1/2 m s'^2
constraint r^2 + s^2 - 2 r s cos φ = r^2 name rod
)");
  const double quarter = std::acos(0.0);
  const MotionState singular{0, {quarter, 0}, {0, 0}}, beside{0, {quarter - 1e-6, 0}, {0, 0}};
  CHECK(analyse_constraints(m.equations, &singular).singular_start());
  CHECK_FALSE(analyse_constraints(m.equations, &beside).singular_start());
}

TEST_CASE("redundant velocity constraints name the set that they depend on") {
  const Analysed m(space("constraint x' = y'\nconstraint z' = y x'\nconstraint z' = y y'\n"));
  CHECK(m.found.rank == 2);
  CHECK(m.found.constraints[2].redundant);
  CHECK(m.found.constraints[2].depends_on == Set{0, 1});
  CHECK(m.found.undetermined == Set{0, 1, 2});
  CHECK(m.found.configuration_freedoms == 1);
}

TEST_CASE("a ball on a turntable: rheonomic and non-holonomic") {
  const Analysed m(R"(param m = 1 kg, R = 20 cm, Ω = 1 rad/s
coord x, y : length
body ball mass m inertia diag(2/5 m R^2, 2/5 m R^2, 2/5 m R^2) at (x, y, 0) rotation quaternion
constraint x' - R ball.ω_world.y = -Ω y
constraint y' + R ball.ω_world.x = Ω x
)");
  CHECK(m.class_of(0) == nonholonomic);
  CHECK(m.class_of(1) == nonholonomic);
  CHECK_FALSE(m.found.constraints[0].scleronomic);
  CHECK(m.class_of(2) == holonomic);
  CHECK(m.found.constraints[2].scleronomic);
  CHECK(m.found.configuration_freedoms == 5);
  CHECK(m.found.instantaneous_freedoms == 3);
}

TEST_CASE("constraints that are not linear in the velocities are not classified") {
  const Analysed m(space("constraint x'^2 + y'^2 = z'^2"));
  CHECK(m.class_of(0) == nonlinear);
  CHECK(m.found.configuration_freedoms == 3);
  CHECK(m.found.instantaneous_freedoms == 2);
  // A common factor leaves a constraint affine.
  CHECK(Analysed(space("constraint x (x' - y') = 0")).class_of(0) == integrable);
}

TEST_CASE("constraints that exclude each other are named, and no more than these") {
  const Analysed m(space("constraint x + y = 1\nconstraint z = 0\nconstraint x + y = 2"));
  CHECK(m.found.clashing == Set{0, 2});
  // Together at t = 0 only.
  const ModelText later(space("constraint x = t^2\nconstraint x = 2 t^2\nconstraint y = z"));
  const MotionState start{0, {0, 0, 0}, {0, 0, 0}};
  CHECK(analyse_constraints(later.equations, &start).clashing == Set{0, 1});
}

TEST_CASE("integrals are certified: their differential is a multiple of the form") {
  const std::string forms[] = {
      "x y' = a y x'",   "x' cos x = y' sin y",       "z' = x' x sin x + y' exp(a y)", "(x^2 + y^2) z' = x' x + y' y",
      "x' / x = y' / y", "x' x / sqrt(x^2 + 1) = z'", "x' sin y + x y' cos y = z' z",  "x' = a t y'^1 * 0 + a t"};
  for (const std::string& form : forms) {
    CAPTURE(form);
    const Analysed m(space("constraint " + form));
    CHECK(m.class_of(0) == integrable);
    REQUIRE(m.found.constraints[0].integral.found());
    const Expr f = m.found.constraints[0].integral.value, psi = m.system->constraints[0].value;
    const Expr rate = total_time_derivative(f);
    // F' vanishes where ψ does: F' ∂ψ/∂x' = ψ ∂F'/∂x'.
    CHECK(zero_test(rate * differentiate(psi, m.v(0)) - psi * differentiate(rate, m.v(0))).verdict == Verdict::Zero);
  }
}

TEST_CASE("integrals are written without logarithms of lengths") {
  CHECK(Analysed(space("constraint x y' = y x'")).integral(0) == "x/y");
  CHECK(Analysed(space("constraint y' = a y x'")).class_of(0) == integrable);
  CHECK(Analysed("param m = 1 kg, k = 1 [1/m]\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint y' = k y x'\n")
            .integral(0) == "y exp(-k x)");
}

TEST_CASE("a car with three trailers goes everywhere, by brackets of brackets of brackets") {
  std::string text =
      "param m = 1 kg, a = 1 m\ncoord x, y : length\ncoord δ, θ0, θ1, θ2, θ3 : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 m a^2 (δ'^2 + θ0'^2 + θ1'^2 + θ2'^2 + θ3'^2)\n"
      "constraint x' sin(θ0 + δ) - y' cos(θ0 + δ) - a θ0' cos δ = 0\n";
  for (int i = 0; i < 4; ++i) {  // no wheel slips sideways
    const std::string own = "θ" + std::to_string(i);
    text += "constraint y' cos " + own + " - x' sin " + own;
    for (int k = 1; k <= i; ++k)
      text += " - a θ" + std::to_string(k) + "' cos(θ" + std::to_string(k) + " - " + own + ")";
    text += " = 0\n";
  }
  const Analysed m(text);
  for (std::size_t i = 0; i < 5; ++i) CHECK(m.class_of(i) == nonholonomic);
  CHECK(m.found.configuration_freedoms == 7);
  CHECK(m.found.instantaneous_freedoms == 2);
}

TEST_CASE("a fast spin about one axis does not forbid the rate 0 about another") {
  const ModelText m(R"(param J = 1 kg m^2
body top inertia diag(J, J, J) rotation quaternion
)");
  const MechanicalSystem& s = *m.system;
  const ConstraintManifold manifold(m.equations, {s.bodies[0].angular_velocity[0], s.bodies[0].angular_velocity[1],
                                                  s.bodies[0].angular_velocity[2] - s.context->number(Rational(200))});
  MotionState state{0, {std::cos(0.3), std::sin(0.3), 0, 0}, {0, 0, 0, 0}};
  REQUIRE(manifold.move_velocities(state, std::vector<bool>(4, false)));
  // q' = ½ q ω
  CHECK(state.v[2] == doctest::Approx(-100 * std::sin(0.3)).epsilon(1e-13));
  CHECK(state.v[3] == doctest::Approx(100 * std::cos(0.3)).epsilon(1e-13));
}
