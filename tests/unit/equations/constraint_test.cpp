#include "../model_text.hpp"

#include "equations/constraint_forms.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include <algorithm>

using namespace maupertuis;

namespace {

const char* const pendulum = R"(system pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
)";

const char* const rolling_disk = R"(system rolling_disk
param m = 1 kg, R = 20 cm
let I = 1/2 m R^2, J = 1/4 m R^2
coord x, y : length
coord φ, ψ : angle
T = 1/2 m (x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2
constraint x' = R φ' cos ψ
constraint y' = R φ' sin ψ
)";

const char* const planetary_gear = R"(system planetary_gear
param Rs = 20 mm, Rp = 15 mm, n = 3, mp = 50 g, τ = 0.1 N m
param Is = 1e-5 kg m^2, Ip = 4e-6 kg m^2, Ic = 8e-5 kg m^2
coord φs, φp, φc, φr : angle
let Rr = Rs + 2 Rp, a = Rs + Rp
T = 1/2 Is φs'^2 + n/2 Ip φp'^2 + 1/2 (Ic + n mp a^2) φc'^2
constraint Rs (φs - φc) = -Rp (φp - φc)
constraint Rr (φr - φc) =  Rp (φp - φc)
constraint φr = 0 name hold
force φs = τ
)";

bool zero(Expr e) { return zero_test(e).verdict == Verdict::Zero; }
bool equal(Expr a, Expr b) { return zero(a - b); }
Expr square(Expr e) { return pow(e, Rational(2)); }

std::vector<std::string> printed(const std::vector<ReadableForm>& rows, const ReadingOrder& order) {
  std::vector<std::string> out;
  for (const ReadableForm& row : rows) out.push_back(to_plain(row, order));
  return out;
}
using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("a pendulum in x and y prints as in a textbook") {
  const ModelText m(pendulum);
  const Derivation d = readable_derivation(m.equations, false);
  CHECK(printed(d.equations, m.equations.order) == Lines{"m x''", "m y'' + m g"});
  CHECK(printed(d.constraint_forces, m.equations.order) == Lines{"2 x λ_rod", "2 y λ_rod"});
  REQUIRE(d.constraints.size() == 1);
  CHECK(d.constraints[0].name == "rod");
  CHECK(to_plain(d.constraints[0].left, m.equations.order) == "x^2 + y^2");
  CHECK(to_plain(d.constraints[0].right, m.equations.order) == "l^2");
  CHECK(to_latex(d.constraint_forces[0], m.equations.order) == "2\\, x\\, \\lambda_{\\mathrm{rod}}");
}

TEST_CASE("a lever from a place to a point beyond it is printed without the place") {
  // x − (x + d cos ψ) in the text, as in v + ω × (contact − centre); the root keeps A from being multiplied out.
  const ModelText m(R"(system lever
param m = 1 kg, a = 20 cm
coord x, y : length
coord ψ : angle
let d = sqrt(x^2 + a^2)
T = 1/2 m (x'^2 + y'^2 + a^2 ψ'^2)
constraint y' + ψ' (x - (x + d cos ψ)) = 0
)");
  const std::vector<ReadableForm> forces = readable_derivation(m.equations, false).constraint_forces;
  CHECK(to_plain(forces.at(2), m.equations.order) == "-sqrt(a^2 + x^2) cos ψ λ");
  const ConstraintEquation row = constraint_equation(m.equations, 0);
  CHECK(to_plain(row.left, m.equations.order) == "y'");
  CHECK(to_plain(row.right, m.equations.order) == "sqrt(a^2 + x^2) cos ψ ψ'");
}

TEST_CASE("A and b of the bordered system") {
  const ModelText m(pendulum);
  const ExprMatrix a = constraint_matrix(m.equations);
  CHECK(equal(a.at(0, 0), Rational(2) * m.q(0)));
  CHECK(equal(a.at(0, 1), Rational(2) * m.q(1)));
  CHECK(equal(constraint_bias(m.equations)[0], Rational(-2) * (square(m.v(0)) + square(m.v(1)))));
  CHECK(m.equations.power.is_zero());
}

TEST_CASE("a driven rod does work: the power is −λ ∂φ/∂t") {
  const ModelText m(
      "system s\nparam m = 1 kg, l = 1 m, v = 1 m/s\ncoord x, y : length\npoint P mass m at (x, y)\n"
      "constraint x^2 + y^2 = (l + v t)^2 name rod\n");
  const Expr length = m.p("l") + m.p("v") * m.system->context->time();
  CHECK(equal(m.equations.power, Rational(2) * m.equations.multipliers[0] * length * m.p("v")));
  CHECK_FALSE(conserved_quantities(m.equations).energy_conserved);
}

TEST_CASE("a momentum is conserved only where no constraint acts") {
  const ModelText rolling(rolling_disk);
  const ConservedQuantities c = conserved_quantities(rolling.equations);
  CHECK(c.cyclic.size() == 4);
  CHECK(c.conserved_momenta == std::vector<std::size_t>{3});
  CHECK(c.energy_conserved);
}

TEST_CASE("velocity constraints of any degree in the velocities do no work, affine ones do") {
  const std::string head =
      "system s\nparam m = 1 kg, c = 2 m/s\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n";
  CHECK(conserved_quantities(ModelText(head + "constraint x'^2 + y'^2 = z'^2\n").equations).energy_conserved);
  CHECK(conserved_quantities(ModelText(head + "constraint x' = y'\n").equations).energy_conserved);
  CHECK_FALSE(conserved_quantities(ModelText(head + "constraint x'^2 + y'^2 = c^2\n").equations).energy_conserved);
  CHECK_FALSE(conserved_quantities(ModelText(head + "constraint x' = c\n").equations).energy_conserved);
}

TEST_CASE("accelerations and multipliers solve the bordered system, also where M is singular") {
  for (const char* text : {pendulum, rolling_disk, planetary_gear}) {
    const ModelText m(text);
    const auto motion = accelerations_and_multipliers(m.equations);
    REQUIRE(motion);
    ExprMap solution;
    for (std::size_t i = 0; i < motion->accelerations.size(); ++i) solution.emplace(m.a(i), motion->accelerations[i]);
    for (std::size_t k = 0; k < motion->multipliers.size(); ++k)
      solution.emplace(m.equations.multipliers[k], motion->multipliers[k]);
    ExprVector rows = m.equations.balance();
    rows.insert(rows.end(), m.equations.constraint_accelerations.begin(), m.equations.constraint_accelerations.end());
    CHECK(zero_test(substitute(expand_time_derivatives(rows), solution)).verdict == Verdict::Zero);
  }
}

TEST_CASE("a planetary gear speeds up as its reduced inertia says") {
  const ModelText m(planetary_gear);
  const auto motion = accelerations_and_multipliers(m.equations);
  REQUIRE(motion);
  Bindings at;
  for (const Parameter& p : m.system->parameters) at[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < 4; ++i) at[m.q(i)] = 0.1 * static_cast<double>(i), at[m.v(i)] = 0.3;
  // Ring held: φs' = (1 + Rr/Rs) φc', φp' = (1 − Rr/Rp) φc'.
  const double rs = 0.02, rp = 0.015, rr = rs + 2 * rp, a = rs + rp, sun = 1 + rr / rs, planet = 1 - rr / rp;
  const double inertia = 1e-5 * sun * sun + 3 * 4e-6 * planet * planet + 8e-5 + 3 * 0.05 * a * a;
  CHECK(evaluate(motion->accelerations[2], at) == doctest::Approx(0.1 * sun / inertia).epsilon(1e-12));
  CHECK(std::abs(evaluate(motion->accelerations[3], at)) < 1e-9);
}

TEST_CASE("redundant constraints have no unique multipliers") {
  const ModelText m(
      "system s\nparam m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
      "constraint x = y name a\nconstraint 2 x = 2 y name b\n");
  CHECK_FALSE(accelerations_and_multipliers(m.equations));
  CHECK_FALSE(eliminate_multipliers(m.equations));
}

TEST_CASE("multipliers eliminated") {
  const ModelText disk(rolling_disk);
  const auto rolling = eliminate_multipliers(disk.equations.shown());
  REQUIRE(rolling);
  CHECK(printed(rolling->rows, disk.equations.order) == Lines{"(m R^2 + I) φ''", "J ψ''"});
  CHECK(rolling->dependent == std::vector<std::size_t>{0, 1});

  const ModelText plane(pendulum);
  const auto swinging = eliminate_multipliers(plane.equations);
  REQUIRE(swinging);
  CHECK(printed(swinging->rows, plane.equations.order) == Lines{"m x y'' - m y x'' + m g x"});
}

TEST_CASE("a denominator that a whole row of A shares is left out") {
  const ModelText m(
      "system s\nparam m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint norm(P) = l name "
      "rod\n");
  const Derivation d = readable_derivation(m.equations, false);
  CHECK(to_plain(d.constraint_forces[0], m.equations.order) == "x λ_rod/sqrt(x^2 + y^2)");
  const auto eliminated = eliminate_multipliers(m.equations);
  REQUIRE(eliminated);
  CHECK(printed(eliminated->rows, m.equations.order) == Lines{"m x y'' - m y x''"});
}

TEST_CASE("the multiplier written out: the pendulum") {
  const ModelText m(pendulum);
  const auto solved = solved_multipliers(m.equations);
  REQUIRE(solved.size() == 1);
  CHECK(to_plain(solved[0], m.equations.order) == "m (g y - x'^2 - y'^2)/(2 (x^2 + y^2))");
}

TEST_CASE("the multipliers of a chain of two rods are what the bordered system gives") {
  const ModelText m(R"(system s
param m1 = 1 kg, m2 = 2 kg, a = 1 m, b = 2 m, g = 9.81 m/s^2
coord x1, y1, x2, y2 : length
point A mass m1 at (x1, y1)
point B mass m2 at (x2, y2)
gravity (0, -g)
constraint x1^2 + y1^2 = a^2 name upper
constraint (x2 - x1)^2 + (y2 - y1)^2 = b^2 name lower
)");
  const auto solved = solved_multipliers(m.equations);
  const auto motion = accelerations_and_multipliers(m.equations);
  REQUIRE(solved.size() == 2);
  REQUIRE(motion);
  for (std::size_t k = 0; k < 2; ++k) CHECK(equal(solved[k].value, motion->multipliers[k]));
}

namespace {

EquationsOfMotion in_mode(const ModelText& m, const std::string& name) {
  std::string trouble;
  const auto mode = read_mode(m.model.system, name, trouble);
  INFO(trouble);
  REQUIRE(mode);
  Diagnostics diagnostics;
  auto equations =
      euler_lagrange(std::make_shared<const MechanicalSystem>(system_in_mode(m.model.system, *mode)), diagnostics);
  REQUIRE(equations);
  return std::move(*equations);
}

/// q̈ and λ as they are written out: put into the equations and the constraints they leave nothing.
ExprMap written_out(const EquationsOfMotion& equations) {
  ExprMap multipliers, motion;
  const auto solved = solved_multipliers(equations);
  REQUIRE(solved.size() == equations.multipliers.size());
  for (std::size_t k = 0; k < solved.size(); ++k) multipliers.emplace(equations.multipliers[k], solved[k].value);
  for (const SolvedAcceleration& a : solved_accelerations(equations))
    motion.emplace(equations.system->coordinates[a.coordinate].acceleration, substitute(a.right.value, multipliers));
  for (const auto& entry : multipliers) motion.insert(entry);
  return motion;
}

}  // namespace

TEST_CASE("friction of a contact that slides goes with its multiplier, written out and eliminated") {
  const ModelText block(
      "dimensionless\nparam m = 1, g = 10, μ = 0.3\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact y >= 0 friction μ slip x' name floor\nstart x' = 1\n");
  const EquationsOfMotion slides = in_mode(block, "floor sliding +");
  CHECK(to_plain(solved_multipliers(slides).at(0), slides.order) == "m g");
  const auto rows = eliminate_multipliers(slides);
  REQUIRE(rows);
  CHECK(printed(rows->rows, slides.order) == Lines{"m x'' + m g μ"});

  const ModelText wedge(
      "dimensionless\nparam m = 1, M = 2, g = 10, μ = 0.3, c = 0.6, s = 0.8\ncoord X, x, y : length\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 M X'^2\nV = m g y\n"
      "contact c y - s (x - X) >= 0 friction μ slip c (x' - X') + s y' name face\nstart X = 0\n");
  const ModelText corner(
      "dimensionless\nparam m = 1, g = 10, μ = 0.3, u = 0.2, I = 3\ncoord x, y, a : length\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 I a'^2\nV = m g (y + x)\n"
      "contact y >= 0 friction μ slip x' + a' name floor\ncontact x >= 0 friction u slip y' - a' name wall\n"
      "start x = 0\n");
  for (const auto& [model, mode] : {std::pair(&wedge, "face sliding -"), std::pair(&wedge, "face sliding +"),
                                    std::pair(&corner, "floor sliding +, wall sliding -")}) {
    CAPTURE(std::string(mode));
    const EquationsOfMotion equations = in_mode(*model, mode);
    const ExprMap motion = written_out(equations);
    ExprVector left = equations.balance();
    left.insert(left.end(), equations.constraint_accelerations.begin(), equations.constraint_accelerations.end());
    const auto eliminated = eliminate_multipliers(equations);
    REQUIRE(eliminated);
    CHECK(eliminated->rows.size() + equations.multipliers.size() == equations.system->coordinates.size());
    for (const ReadableForm& row : eliminated->rows) {
      for (const Expr& symbol : symbols_of({&row.value, 1})) CHECK(symbol.role() != Role::Multiplier);
      left.push_back(row.value);
    }
    for (const Expr& e : left)
      CHECK(zero_test(substitute(expand_time_derivatives(e), motion)).verdict == Verdict::Zero);
  }
}

TEST_CASE("the textbook path with multipliers") {
  const ModelText m(rolling_disk);
  const Derivation d = readable_derivation(m.equations, true);
  const auto find = [&](const std::string& left) {
    for (const DerivationStep& step : d.steps)
      if (to_plain(step.left) == left && step.right) return to_plain(step.right, m.equations.order);
    return std::string("missing");
  };
  CHECK(d.steps.front().sentence.find("2 of the velocities can be chosen freely") != std::string::npos);
  CHECK(find("∂ψ_1/∂φ'") == "-R cos ψ");
  CHECK(find("I φ''") == "-R cos ψ λ1 - R sin ψ λ2");
  CHECK(find("x'' - R cos ψ φ''") == "-R sin ψ φ' ψ'");
  CHECK(find("(m R^2 + I) φ''") == "0");
  CHECK(find("λ1") == "-m R sin ψ φ' ψ'");
  CHECK(find("constraint 1") == "λ1");
}

TEST_CASE("Chetaev's rule is told where velocities stand in A, and only there") {
  const auto told = [](const char* text) {
    const ModelText m(text);
    const Derivation d = readable_derivation(m.equations, true);
    return std::any_of(d.steps.begin(), d.steps.end(),
                       [](const DerivationStep& step) { return step.rule == "Chetaev's rule"; });
  };
  CHECK(
      told("param m = 1 kg, a = 2\ncoord x, y, z : length\npoint P mass m at (x, y, z)\nconstraint sqrt(x'^2 + y'^2) = "
           "a z'\n"));
  CHECK_FALSE(told(rolling_disk));
  CHECK_FALSE(told(pendulum));
}

TEST_CASE("parameters are bound to their values in SI units, t to 0") {
  const ModelText model(planetary_gear);
  const Bindings bound = parameter_bindings(*model.system);
  CHECK(bound.size() == model.system->parameters.size() + 1);
  CHECK(bound.at(model.p("Rs")) == 0.02);
  CHECK(bound.at(model.system->context->time()) == 0);
}
