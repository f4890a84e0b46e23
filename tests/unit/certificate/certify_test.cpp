// Every derivation that is right passes; every one that is broken is caught by each check that can see the break, and
// passes those that are declared blind to it.
#include "../model_text.hpp"

#include <maupertuis/certificate.hpp>

#include <functional>
#include <set>

using namespace maupertuis;

namespace {

const char* double_pendulum = R"(system double_pendulum
param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2
coord θ1, θ2 : angle
point A mass m1 at l1 (sin θ1, -cos θ1)
point B mass m2 at A + l2 (sin θ2, -cos θ2)
gravity (0, -g)
)";

const char* driven_cart = R"(system cart_pendulum
param M = 2 kg, m = 500 g, l = 60 cm, g = 9.81 m/s^2
param b = 0.4 N s/m, c = 0.01 N m s, F0 = 3 N, omega = 2 rad/s
coord x : length, θ : angle
point cart mass M at (x, 0)
point bob mass m at cart + l (sin θ, -cos θ)
gravity (0, -g)
D = 1/2 b x'^2 + 1/2 c θ'^2
force on cart = (F0 cos(omega t), 0)
)";

const char* hoop = R"(system bead_on_hoop
param m = 100 g, R = 30 cm, Ω = 8 rad/s, g = 9.81 m/s^2
coord θ : angle
let φ = Ω t
point bead mass m at R (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
)";

const char* top = R"(system top
param m = 1 kg, h = 10 cm, I1 = 0.02 kg m^2, I3 = 0.01 kg m^2, g = 9.81 m/s^2
coord φ, θ, ψ : angle
body B mass m inertia diag(I1, I1, I3) at h (sin θ sin φ, -sin θ cos φ, cos θ) rotation euler zxz (φ, θ, ψ)
gravity (0, 0, -g)
)";

const char* spring_and_friction = R"(system spring_friction
param m = 1 kg, k = 20 N/m, l0 = 50 cm, c = 0.3 N s/m, f = 1 N, w = 1 m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
point W at (w, 0)
spring P - W stiffness k length l0
damper P - W coefficient c
V += f abs(x)
gravity (0, -g)
)";

const char* charge = R"(system charge
dimensionless
param m = 1, B = 2, E = 3
coord x, y : number
T = 1/2 m (x'^2 + y'^2)
U = -1/2 B (x y' - y x') - E x
)";

const char* power_law = R"(system power_law
dimensionless
param m = 1, k = 2, n = 3, a = 1
coord r, φ : number
T = 1/2 m (r'^2 + r^2 φ'^2)
V = k r^n + log(r) + exp(-a r) / sqrt(1 + r^2) + atan(r) + a max(r, φ)
)";

std::set<std::string> failed(const Certificate& certificate) {
  std::set<std::string> names;
  for (const CertificateCheck& check : certificate.checks)
    if (check.applies && check.verdict != Verdict::Zero) names.insert(check.name);
  return names;
}

void check_passes(const char* text, bool dalembert_applies) {
  const ModelText model(text);
  const Derivation readable = readable_derivation(model.equations, false);
  CertifyOptions full;
  full.full = true;
  const Certificate certificate = certify(model.equations, &readable, full);
  REQUIRE(certificate.checks.size() == 5);
  for (const CertificateCheck& check : certificate.checks) {
    CAPTURE(model.system->name);
    CAPTURE(check.name);
    CAPTURE(check.statement);
    CAPTURE(check.reason);
    if (check.name == "dalembert") CHECK(check.applies == dalembert_applies);
    if (!check.applies) continue;
    CHECK(check.verdict == Verdict::Zero);
    CHECK(check.points >= 3);
    CHECK(check.error_bound < 1e-6);
  }
  CHECK(certificate.passed());
}

using Names = std::set<std::string>;
using Break = std::function<void(EquationsOfMotion&)>;

/// Breaks a derivation and says which checks fail.
Names caught(const char* text, const Break& break_it) {
  ModelText model(text);
  const Derivation readable = readable_derivation(model.equations, false);
  break_it(model.equations);
  return failed(certify(model.equations, &readable));
}

Expr replaced_sum(Expr a, Expr b) { return a + b; }

}  // namespace

TEST_CASE("right derivations pass") {
  check_passes(double_pendulum, true);
  check_passes(driven_cart, true);
  check_passes(hoop, true);
  check_passes(top, true);
  check_passes(spring_and_friction, true);
  check_passes(charge, false);
  check_passes(power_law, false);
}

TEST_CASE("a dropped ∂T/∂q") {
  const Names names = caught(double_pendulum, [](EquationsOfMotion& e) {
    const Expr q = e.system->coordinates[0].q;
    const Expr force = differentiate(expand_time_derivatives(e.system->kinetic_energy()), q);
    e.residual[0] = replaced_sum(e.residual[0], force);
  });
  CHECK(names == Names{"forms_agree", "jet_residual", "dalembert", "power_balance"});
}

TEST_CASE("a wrong sign of D") {
  const Names names = caught(driven_cart, [](EquationsOfMotion& e) {
    for (std::size_t i = 0; i < 2; ++i) {
      e.residual[i] = e.residual[i] - Rational(2) * e.dissipative_terms[i];
    }
  });
  CHECK(names == Names{"forms_agree", "jet_residual", "dalembert", "power_balance"});
}

TEST_CASE("a missing part of the total time derivative") {
  const Names names = caught(driven_cart, [](EquationsOfMotion& e) {
    // Ṁ q̇ in the first row: d/dt p without the part through q.
    ExprVector terms{e.residual[0]};
    for (const Coordinate& c : e.system->coordinates) terms.push_back(-(differentiate(e.momenta[0], c.q) * c.velocity));
    e.residual[0] = e.system->context->sum(terms);
  });
  CHECK(names == Names{"forms_agree", "jet_residual", "dalembert", "power_balance"});
}

TEST_CASE("a missing explicit time derivative of the momentum") {
  const Names names = caught(R"(system sliding
dimensionless
param m = 1
coord x : number
L = 1/2 m exp(t) x'^2
)",
                             [](EquationsOfMotion& e) {
                               e.residual[0] = e.residual[0] - differentiate(e.momenta[0], e.system->context->time());
                             });
  CHECK(names == Names{"forms_agree", "jet_residual", "power_balance"});
}

TEST_CASE("a wrong lever of a force") {
  const Names names = caught(driven_cart, [](EquationsOfMotion& e) {
    const Expr wrong = e.system->find_parameter("F0")->symbol * cos(e.system->coordinates[1].q);
    e.generalized_forces[1] = e.generalized_forces[1] + wrong;
    e.residual[1] = e.residual[1] - wrong;
    e.power = e.power + wrong * e.system->coordinates[1].velocity;
  });
  // The power balance takes Q as it is.
  CHECK(names == Names{"forms_agree", "jet_residual", "dalembert"});
}

TEST_CASE("wrong kinematics of one point are seen by d'Alembert's principle alone") {
  ModelText model(double_pendulum);
  auto broken = std::make_shared<MechanicalSystem>(*model.system);
  // T of B as if B hung from the origin.
  const Expr t = Rational(1, 2) * model.p("m2") * pow(model.p("l2") * model.v(1), Rational(2));
  broken->kinetic[1].value = t;
  Diagnostics diagnostics;
  const auto equations = euler_lagrange(broken, diagnostics);
  REQUIRE(equations);
  const Derivation readable = readable_derivation(*equations, false);
  CHECK(failed(certify(*equations, &readable)) == Names{"dalembert"});
}

TEST_CASE("a wrong angular velocity of a body is seen by d'Alembert's principle alone") {
  ModelText model(top);
  auto broken = std::make_shared<MechanicalSystem>(*model.system);
  for (EnergyTerm& term : broken->kinetic)
    if (term.origin == "rotation of body B") term.value = term.value + model.p("I3") * model.v(0) * model.v(2);
  Diagnostics diagnostics;
  const auto equations = euler_lagrange(broken, diagnostics);
  REQUIRE(equations);
  const Derivation readable = readable_derivation(*equations, false);
  CHECK(failed(certify(*equations, &readable)) == Names{"dalembert"});
}

TEST_CASE("a body in the plane: its turn is checked by d'Alembert's principle, from its rotation matrix") {
  const char* const rod = R"(system rod
param m = 1 kg, J = 0.1 kg m^2, h = 30 cm, τ = 2 N m, g = 9.81 m/s^2
coord θ, φ : angle
body arm mass m inertia J at h (sin θ, -cos θ) rotation angle θ
body wheel mass m inertia 2 J at 2 h (sin θ, -cos θ) rotation angle φ - 2 θ
torque on wheel from arm = τ
gravity (0, -g)
)";
  check_passes(rod, true);
  for (const std::string body : {"arm", "wheel"}) {
    ModelText model(rod);
    auto broken = std::make_shared<MechanicalSystem>(*model.system);
    for (EnergyTerm& term : broken->kinetic)
      if (term.origin == "rotation of body " + body) term.value = term.value * Rational(2);
    Diagnostics diagnostics;
    const auto equations = euler_lagrange(broken, diagnostics);
    REQUIRE(equations);
    const Derivation readable = readable_derivation(*equations, false);
    CHECK(failed(certify(*equations, &readable)) == Names{"dalembert"});
  }
}

TEST_CASE("terms given to L beside particles belong to d'Alembert's principle") {
  const std::string text = "param m = 1 kg, b = 2 N s/m, k = 3 N/m\ncoord x, y : length\npoint P mass m at (x, y)\n";
  check_passes((text + "V = 1/2 k x^2\nU = b x y'\nL += 1/2 b (x y' - y x') - k x y\n").c_str(), true);
}

TEST_CASE("points at which nothing is defined are no evidence") {
  // A root that a prime field does not follow, and that no real point has.
  ModelText model("dimensionless\nparam m = 1\ncoord x : number\nT = 1/2 m x'^2\nV = x\n");
  Context& c = *model.system->context;
  const Expr nowhere = sqrt(-sqrt(c.number(3) + Rational(2) * sqrt(c.number(2))) - pow(model.q(0), Rational(2)));
  model.equations.residual[0] =
      model.equations.residual[0] + nowhere - nowhere * (c.number(1) + pow(model.q(0), Rational(2)));
  const Certificate certificate = certify(model.equations, nullptr);
  CHECK_FALSE(certificate.passed());
  for (const CertificateCheck& check : certificate.checks)
    if (check.name == "jet_residual") CHECK(check.verdict != Verdict::Zero);
}

TEST_CASE("a gyroscopic term of the wrong sign is invisible to the power balance") {
  const Names names = caught(charge, [](EquationsOfMotion& e) {
    const Expr b = e.system->find_parameter("B")->symbol;
    const Expr vx = e.system->coordinates[0].velocity, vy = e.system->coordinates[1].velocity;
    // B acts on y' in the row of x with −B y' and on x' in the row of y with +B x'.
    e.residual[0] = e.residual[0] + Rational(2) * b * vy;
    e.residual[1] = e.residual[1] - Rational(2) * b * vx;
  });
  CHECK(names == Names{"forms_agree", "jet_residual"});
}

TEST_CASE("a missing u' term") {
  // L with an input: its momentum x' u m changes with u.
  Context context;
  auto system = std::make_shared<MechanicalSystem>();
  system->context = std::shared_ptr<Context>(&context, [](Context*) {});
  Coordinate x;
  x.name = "x";
  x.q = context.symbol("x", Role::Coordinate);
  x.velocity = context.symbol("x", Role::Coordinate, 1);
  x.acceleration = context.symbol("x", Role::Coordinate, 2);
  system->coordinates.push_back(x);
  const Expr u = context.symbol("u", Role::Input), m = context.symbol("m", Role::Parameter);
  system->lagrangian_given =
      EnergyTerm{Rational(1, 2) * m * pow(x.velocity, Rational(2)) + x.velocity * sin(u) + x.q * u, "L", {}};
  Diagnostics diagnostics;
  auto equations = euler_lagrange(system, diagnostics);
  REQUIRE(equations);
  CHECK(failed(certify(*equations, nullptr)).empty());
  equations->residual[0] = equations->residual[0] - cos(u) * context.time_derivative(u);
  CHECK(failed(certify(*equations, nullptr)) == Names{"jet_residual", "power_balance"});
}

TEST_CASE("the row that fails is named") {
  ModelText model(double_pendulum);
  model.equations.residual[1] = model.equations.residual[1] + model.p("m1") * model.q(0);
  for (const CertificateCheck& check : certify(model.equations, nullptr).checks)
    if (check.name != "power_balance") CHECK(check.row == 1);
}

TEST_CASE("wrong momenta, energy function or power are seen") {
  CHECK(caught(driven_cart, [](EquationsOfMotion& e) {
          e.momenta[0] = e.momenta[0] * Rational(2);
        }).count("jet_residual"));
  CHECK(caught(driven_cart, [](EquationsOfMotion& e) { e.energy_function = e.energy_function * Rational(2); }) ==
        Names{"power_balance"});
  CHECK(caught(driven_cart, [](EquationsOfMotion& e) { e.power = -e.power; }) == Names{"power_balance"});
}

TEST_CASE("what a prime field cannot follow is compared to 60 digits, and said so") {
  // A nested root whose sign only the real line knows.
  const ModelText model(R"(system nested
dimensionless
param m = 1
coord x : number
T = 1/2 m x'^2
V = sqrt(3 + 2 sqrt(2)) x
)");
  ModelText copy = model;
  Context& c = *copy.system->context;
  copy.equations.residual[0] = c.time_derivative(copy.p("m") * copy.v(0)) + c.number(1) + sqrt(c.number(2));
  const Certificate certificate = certify(copy.equations, nullptr);
  for (const CertificateCheck& check : certificate.checks)
    if (check.name == "jet_residual") {
      CHECK(check.verdict == Verdict::Zero);
      const bool exact = check.error_bound < 1;
      CHECK((exact || check.statement.find("60 digits") != std::string::npos));
    }
}

TEST_CASE("many bodies: more distances than a point modulo a prime has roots for are proved all the same") {
  std::string text = "dimensionless\nparam k = 1\n";
  for (int i = 1; i <= 12; ++i) {
    const std::string n = std::to_string(i);
    text += "coord x" + n + ", y" + n + " : number\npoint P" + n + " mass " + n + " at (x" + n + ", y" + n + ")\n";
    for (int j = 1; j < i; ++j) text += "V += -k/norm(P" + n + " - P" + std::to_string(j) + ")\n";
  }
  const ModelText model(text);
  const Derivation readable = readable_derivation(model.equations, false);
  for (const CertificateCheck& check : certify(model.equations, &readable).checks) {
    CAPTURE(check.name);
    CHECK(check.verdict == Verdict::Zero);
    CHECK(check.error_bound < 1e-6);
    CHECK(check.statement.find("digits") == std::string::npos);
  }
  // A wrong force between two of them is seen, and by which equation.
  const Names names = caught(text.c_str(), [](EquationsOfMotion& e) {
    const auto& q = e.system->coordinates;
    const Expr square = pow(q[0].q - q[2].q, Rational(2)) + pow(q[1].q - q[3].q, Rational(2));
    e.residual[0] = e.residual[0] + Rational(1, 1000) * (q[0].q - q[2].q) * pow(square, Rational(-3, 2));
  });
  CHECK(names == Names{"forms_agree", "jet_residual", "dalembert", "power_balance"});
}

TEST_CASE("derivatives of derivatives are followed as far as they are written") {
  ModelText model("dimensionless\nparam m = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\nV = x y\n");
  Context& c = *model.system->context;
  const Expr x = model.q(0), v = model.v(0);
  // d²/dt² and d³/dt³ of x, as nested d/dt and written out, where x'' + y = 0 is no help.
  Expr nested = sin(x), plain = nested;
  for (const int depth : {1, 2, 3}) {
    CAPTURE(depth);
    nested = c.time_derivative(nested);
    plain = total_time_derivative(plain);
    EquationsOfMotion equations = model.equations;
    equations.residual[1] = equations.residual[1] + (nested - plain) * v;
    CHECK(failed(certify(equations, nullptr)).empty());
    equations.residual[1] = equations.residual[1] + plain;
    CHECK(failed(certify(equations, nullptr)).count("jet_residual"));
  }
}

namespace {

/// A particle in a potential of straight pieces, V' = 1, 2, 3, 1, 2, … on x < 1, x < 2, …
std::string table(int pieces) {
  std::string text = "dimensionless\nparam m = 1\ncoord x : number\npoint P mass m at (x, 0)\nV = piecewise(";
  int sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const std::string piece = std::to_string(i % 3 + 1) + " (x - " + std::to_string(i) + ") + " + std::to_string(sum);
    text += i + 1 < pieces ? "x < " + std::to_string(i + 1) + " : " + piece + ", " : "else : " + piece + ")\n";
    sum += i % 3 + 1;
  }
  return text;
}

/// 1 on piece k of that table, else 0, in its conditions.
Expr on_piece(const EquationsOfMotion& e, int k, int pieces) {
  Context& c = *e.system->context;
  const Expr x = e.system->coordinates[0].q;
  std::vector<Expr> arguments;
  for (int i = 0; i < pieces; ++i) {
    if (i + 1 < pieces) arguments.push_back(c.function(Kind::Less, std::array{x, c.number(i + 1)}));
    arguments.push_back(c.number(i == k ? 1 : 0));
  }
  return c.function(Kind::Piecewise, arguments);
}

}  // namespace

TEST_CASE("every piece of a table is proved") {
  for (const int pieces : {30, 600}) {
    const ModelText model(table(pieces).c_str());
    for (const CertificateCheck& check : certify(model.equations, nullptr).checks) {
      CAPTURE(check.name);
      CHECK(check.verdict == Verdict::Zero);
      CHECK(check.error_bound < 1e-12);
    }
  }
}

TEST_CASE("one wrong piece far away is seen, which no random signs meet") {
  for (const auto& [k, pieces] : {std::pair{29, 30}, std::pair{17, 30}, std::pair{487, 600}}) {
    CAPTURE(k);
    const ModelText model(table(pieces).c_str());
    EquationsOfMotion wrong = model.equations;
    wrong.residual[0] = wrong.residual[0] + Rational(1, 1000) * on_piece(wrong, k, pieces);
    CHECK(failed(certify(wrong, nullptr)) == Names{"jet_residual", "dalembert", "power_balance"});
    for (const CertificateCheck& check : certify(wrong, nullptr).checks) CHECK(check.verdict == Verdict::Nonzero);
    wrong = model.equations;
    wrong.energy_function = wrong.energy_function + wrong.system->coordinates[0].q * on_piece(wrong, k, pieces);
    CHECK(failed(certify(wrong, nullptr)) == Names{"power_balance"});
  }
}

TEST_CASE("pieces that are multiplied with each other are tried on all their sides") {
  // The force 3 x' of the product is missing where both of its factors are 1.
  ModelText model(R"(system product
dimensionless
param m = 1
coord x, y : number
point P mass m at (x, y)
force on P = (x' step(x - 7) step(y - 70), 0)
)");
  CHECK(certify(model.equations, nullptr).passed());
  Context& c = *model.system->context;
  const Expr both = c.function(Kind::Step, std::array{model.q(0) - c.number(7)}) *
                    c.function(Kind::Step, std::array{model.q(1) - c.number(70)});
  model.equations.residual[0] = model.equations.residual[0] + both * model.v(0);
  CHECK(failed(certify(model.equations, nullptr)) == Names{"jet_residual", "dalembert", "power_balance"});
}

TEST_CASE("formulas that agree on their side alone pass: x/√(x²) where x > 0") {
  ModelText model("dimensionless\nparam m = 1\ncoord x : number\npoint P mass m at (x, 0)\nV = abs(x)\n");
  Context& c = *model.system->context;
  const Expr x = model.q(0), sign = c.function(Kind::Sign, std::array{x});
  model.equations.residual[0] = model.equations.residual[0] - sign + x * pow(pow(x, Rational(2)), Rational(-1, 2));
  const Certificate certificate = certify(model.equations, nullptr);
  CHECK(certificate.passed());
  for (const CertificateCheck& check : certificate.checks) CHECK(check.error_bound < 1e-6);
}
