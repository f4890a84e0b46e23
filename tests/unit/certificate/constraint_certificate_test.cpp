// Constrained derivations that are right pass; each piece broken on purpose is caught.
#include "../model_text.hpp"

#include <maupertuis/certificate.hpp>

#include <functional>
#include <set>

using namespace maupertuis;

namespace constraint_certificate_test {
namespace {

const char* const pendulum = R"(system pendulum
param m = 1 kg, l = 1 m, w = 3 rad/s, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint (x - l sin(w t))^2 + y^2 = l^2 name rod
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

const char* const appell = R"(system appell
param m = 1 kg, a = 2, c = 1 m/s, w = 1 rad/s
coord x, y, z : length
point P mass m at (x, y, z)
constraint sqrt(x'^2 + y'^2) = a z' + c sin(w t) name edge
)";

using Names = std::set<std::string>;
using Break = std::function<void(EquationsOfMotion&)>;

Names failed(const Certificate& certificate) {
  Names names;
  for (const CertificateCheck& check : certificate.checks)
    if (check.applies && check.verdict != Verdict::Zero) names.insert(check.name);
  return names;
}

Names caught(const char* text, const Break& break_it) {
  ModelText model(text);
  const Derivation readable = readable_derivation(model.equations, false);
  break_it(model.equations);
  return failed(certify(model.equations, &readable));
}

}  // namespace

TEST_CASE("right constrained derivations pass, with a bound") {
  for (const char* text : {pendulum, rolling_disk, appell}) {
    const ModelText model(text);
    const Derivation readable = readable_derivation(model.equations, false);
    const Certificate certificate = certify(model.equations, &readable);
    bool asked = false;
    for (const CertificateCheck& check : certificate.checks) {
      CAPTURE(model.system->name);
      CAPTURE(check.name);
      CAPTURE(check.reason);
      if (check.applies) CHECK(check.verdict == Verdict::Zero);
      if (check.name != "constraint_rows") continue;
      asked = true;
      CHECK(check.points >= 3);
      CHECK(check.error_bound < 1e-6);
    }
    CHECK(asked);
  }
}

TEST_CASE("a system without constraints has no such check") {
  const ModelText model("system s\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n");
  for (const CertificateCheck& check : certify(model.equations, nullptr).checks) CHECK(check.name != "constraint_rows");
}

TEST_CASE("a wrong sign of λ") {
  const Names names = caught(pendulum, [](EquationsOfMotion& e) {
    for (Expr& force : e.constraint_forces) force = -force;
  });
  CHECK(names == Names{"forms_agree", "constraint_rows", "dalembert", "power_balance"});
}

TEST_CASE("one wrong force of constraint is named by its coordinate") {
  ModelText model(pendulum);
  model.equations.constraint_forces[1] = model.equations.constraint_forces[1] * Rational(2);
  for (const CertificateCheck& check : certify(model.equations, nullptr).checks)
    if (check.name == "constraint_rows" || check.name == "dalembert") {
      CHECK(check.verdict == Verdict::Nonzero);
      CHECK(check.row == 1);
    }
}

TEST_CASE("vakonomic equations in the place of d'Alembert's") {
  const Names names = caught(rolling_disk, [](EquationsOfMotion& e) {
    // δ∫λψ dt: d/dt(λ ∂ψ/∂q̇) − λ ∂ψ/∂q, here with constant λ.
    ExprVector q, terms;
    for (const Coordinate& c : e.system->coordinates) q.push_back(c.q);
    for (const Constraint& c : e.system->constraints) terms.push_back(c.multiplier * c.value);
    e.constraint_forces = expand_time_derivatives(variational_residual(e.system->context->sum(terms), q));
  });
  CHECK(names.count("constraint_rows"));
  CHECK(names.count("forms_agree"));
}

TEST_CASE("A q'' − b without its velocity terms") {
  for (const char* text : {pendulum, rolling_disk, appell}) {
    const Names names = caught(text, [](EquationsOfMotion& e) {
      const ExprMatrix a = constraint_matrix(e);
      for (std::size_t k = 0; k < a.rows; ++k) {
        ExprVector terms;
        for (std::size_t j = 0; j < a.columns; ++j) terms.push_back(a.at(k, j) * e.system->coordinates[j].acceleration);
        e.constraint_accelerations[k] = e.system->context->sum(terms);
      }
    });
    CHECK(names == Names{"constraint_rows"});
  }
}

TEST_CASE("a rate without its explicit time derivative") {
  const Names names = caught(pendulum, [](EquationsOfMotion& e) {
    const Expr phi = e.system->constraints[0].value;
    e.constraint_rates[0] = e.constraint_rates[0] - differentiate(phi, phi.context().time());
  });
  CHECK(names == Names{"constraint_rows"});
}

TEST_CASE("the row of a constraint's own failure is no coordinate") {
  ModelText model(pendulum);
  model.equations.constraint_rates[0] = model.equations.constraint_rates[0] * Rational(2);
  for (const CertificateCheck& check : certify(model.equations, nullptr).checks)
    if (check.name == "constraint_rows") CHECK(check.row == 2);
}

TEST_CASE("a power without the work of a driven constraint") {
  CHECK(caught(pendulum, [](EquationsOfMotion& e) { e.power = e.power.context().number(0); }) ==
        Names{"power_balance"});
  CHECK(caught(appell, [](EquationsOfMotion& e) { e.power = -e.power; }) == Names{"power_balance"});
}

TEST_CASE("a velocity constraint declared as one of positions") {
  ModelText model(rolling_disk);
  auto broken = std::make_shared<MechanicalSystem>(*model.system);
  broken->written = nullptr;
  broken->constraints[0].level = Constraint::Level::Position;
  Diagnostics diagnostics;
  const auto equations = euler_lagrange(broken, diagnostics);
  REQUIRE(equations);
  CHECK(failed(certify(*equations, nullptr)).count("constraint_rows"));
}

TEST_CASE("a body turned by a unit quaternion obeys d'Alembert's principle on the sphere of its norm") {
  const ModelText model(R"(system satellite
param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2, τ = 1 N m, m = 1 kg, g = 9.81 m/s^2, a = 1 m
body sat mass m inertia diag(I1, I2, I3) at (0, 0, 0) rotation quaternion
point tip mass m at (a, 0, 0) in sat
gravity (0, 0, -g)
torque on sat = (τ, 0, 0)
)");
  const auto check = [&](const EquationsOfMotion& equations) {
    for (const CertificateCheck& c : certify(equations, nullptr).checks)
      if (c.name == "dalembert") return c;
    return CertificateCheck{};
  };
  CHECK(check(model.equations).verdict == Verdict::Zero);
  CHECK(certify(model.equations, nullptr).passed());
  // A wrong moment of inertia, and a wrong lever of the torque.
  auto broken = std::make_shared<MechanicalSystem>(*model.system);
  for (EnergyTerm& term : broken->kinetic)
    if (term.origin == "rotation of body sat") term.value = term.value * Rational(2);
  Diagnostics diagnostics;
  CHECK(check(*euler_lagrange(broken, diagnostics)).verdict == Verdict::Nonzero);
  EquationsOfMotion wrong = model.equations;
  wrong.residual[1] = wrong.residual[1] + model.p("τ");
  CHECK(check(wrong).verdict == Verdict::Nonzero);
}

TEST_CASE("the norm of a quaternion in another form") {
  for (const std::string norm :
       {"2 w^2 + 2 x^2 + 2 y^2 + 2 z^2 = 2", "sqrt(w^2 + x^2 + y^2 + z^2) = 1", "1 = w^2 + x^2 + y^2 + z^2"}) {
    CAPTURE(norm);
    const ModelText model(
        "system s\nparam I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2\ncoord w, x, y, z : number\n"
        "body B inertia diag(I1, I2, I3) rotation quaternion (w, x, y, z)\nconstraint " +
        norm + "\n");
    CHECK(certify(model.equations, nullptr).passed());
  }
}

TEST_CASE("d'Alembert's principle says nothing of a quaternion that may stretch") {
  const ModelText model(
      "system s\nparam I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2\ncoord w, x, y, z : number\n"
      "body B inertia diag(I1, I2, I3) rotation quaternion (w, x, y, z)\n");
  for (const CertificateCheck& check : certify(model.equations, nullptr).checks) {
    const bool dalembert = check.name == "dalembert";
    CHECK(check.applies != dalembert);
    if (dalembert)
      CHECK(check.statement.find("quaternion of B") != std::string::npos);
    else
      CHECK(check.error_bound < 1e-6);
  }
}

TEST_CASE("four coordinates of a constraint that is no sphere are tried off the unit sphere too") {
  // A mistake that vanishes where x² + y² + u² + v² = 1, where a quaternion of norm 1 would be.
  const char* const dumbbell =
      "system dumbbell\ndimensionless\nparam m = 1, l = 1\ncoord x, y, u, v : number\n"
      "point A mass m at (x, y)\npoint B mass m at (u, v)\nconstraint (x - u)^2 + (y - v)^2 = l^2\n";
  for (const std::string body : {"", "coord θ : number\nbody wheel inertia m rotation angle θ\n"}) {
    ModelText model(dumbbell + body);
    CHECK(certify(model.equations, nullptr).passed());
    Expr beyond = -model.system->context->number(1);
    for (std::size_t i = 0; i < 4; ++i) beyond = beyond + pow(model.q(i), Rational(2));
    model.equations.residual[0] = model.equations.residual[0] + beyond;
    CHECK(failed(certify(model.equations, nullptr)).count("dalembert"));
  }
}

TEST_CASE("a constraint with an input needs the second derivative of the input") {
  // x = u(t): A q'' − b is x'' − u''.
  ModelText model("param m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint x = y name rod\n");
  auto driven = std::make_shared<MechanicalSystem>(*model.system);
  const Expr u = driven->context->symbol("u", Role::Input), rate = driven->context->time_derivative(u);
  driven->written = nullptr;
  driven->constraints[0].value = model.q(0) - u;
  Diagnostics diagnostics;
  auto equations = euler_lagrange(driven, diagnostics);
  REQUIRE(equations);
  CHECK(failed(certify(*equations, nullptr)).empty());
  equations->constraint_accelerations[0] =
      equations->constraint_accelerations[0] + driven->context->time_derivative(rate);
  CHECK(failed(certify(*equations, nullptr)) == Names{"constraint_rows"});
}

TEST_CASE("large systems with constraints pass without their matrices, and fail as small ones do") {
  std::string text = "param m = 1 kg, l = 1 m\ncoord x1, y1, x2, y2, x3, y3, x4, y4 : length\n";
  for (const std::string k : {"1", "2", "3", "4"}) text += "point P" + k + " mass m at (x" + k + ", y" + k + ")\n";
  ModelText model(text + "constraint x1^2 + y1^2 = l^2\nconstraint (x4 - x3)^2 + (y4 - y3)^2 = l^2\n");
  CHECK(certify(model.equations, nullptr).passed());
  CertifyOptions full;
  full.full = true;
  CHECK(certify(model.equations, nullptr, full).passed());
  model.equations.constraint_accelerations[1] = -model.equations.constraint_accelerations[1];
  CHECK(failed(certify(model.equations, nullptr)) == Names{"constraint_rows"});
}

}  // namespace constraint_certificate_test
