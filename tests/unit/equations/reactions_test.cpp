#include "../model_text.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/reactions.hpp>

#include <cmath>

using namespace maupertuis;

namespace reactions_test {
namespace {

const char* const cartesian_pendulum = R"(system pendulum
param m = 2 kg, l = 70 cm, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
)";

bool equal(Expr a, Expr b) { return zero_test(a - b).verdict == Verdict::Zero; }
Expr square(Expr e) { return pow(e, Rational(2)); }
Expr total(const ExprVector& v) { return v.front().context().sum(v); }

Reaction only_reaction(const ModelText& m) {
  const auto all = reactions(m.equations);
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].value);
  return all[0];
}

/// Values of a reaction at a state, its multipliers and accelerations from the bordered system.
double value_at(const ModelText& m, Expr value, const std::vector<double>& q, const std::vector<double>& v) {
  const auto motion = accelerations_and_multipliers(m.equations);
  REQUIRE(motion);
  ExprMap solution;
  for (std::size_t i = 0; i < q.size(); ++i) solution.emplace(m.a(i), motion->accelerations[i]);
  for (std::size_t k = 0; k < motion->multipliers.size(); ++k)
    solution.emplace(m.equations.multipliers[k], motion->multipliers[k]);
  Bindings at;
  for (const Parameter& p : m.system->parameters) at[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < q.size(); ++i) at[m.q(i)] = q[i], at[m.v(i)] = v[i];
  return evaluate(substitute(value, solution), at);
}

}  // namespace

TEST_CASE("a rod is found whichever of its ends depends on the coordinates of the constraint") {
  // Both ends move with θ, and the constraint is twice the square of their distance.
  const ModelText m(
      "system two\nparam m = 1 kg, a = 0.5 m, l = 0.6 m, g = 9.81 m/s^2\ncoord θ : angle, s : length\n"
      "point P mass m at (a cos θ, a sin θ)\npoint Q mass m at (a cos θ + s, 2 a sin θ)\ngravity (0, -g)\n"
      "constraint 2 (s^2 + a^2 sin(θ)^2) = 2 l^2 name rod\n");
  const Reaction rod = only_reaction(m);
  CHECK(rod.kind == Reaction::Kind::Tension);
  CHECK(rod.sentence.find("pulls P and Q together") != std::string::npos);
}

TEST_CASE("the tension of a pendulum in x and y: m l θ'² + m g cos θ") {
  const ModelText m(cartesian_pendulum);
  const Reaction rod = only_reaction(m);
  CHECK(rod.kind == Reaction::Kind::Tension);
  CHECK(rod.name == "rod");
  CHECK(rod.symbol == m.system->constraints[0].reaction);
  CHECK(rod.dimension.same_as(dimensions::force()));
  CHECK(to_plain(rod.value, m.equations.order) == "-2 l λ_rod");
  for (const double angle : {0.3, 2.5, -1.1}) {
    const double l = 0.7, rate = 1.7, s = std::sin(angle), c = std::cos(angle);
    const double tension = value_at(m, rod.value, {l * s, -l * c}, {l * rate * c, l * rate * s});
    CHECK(tension == doctest::Approx(2 * (l * rate * rate + 9.81 * c)).epsilon(1e-13));
  }
}

TEST_CASE("a rod goes to the place of which its constraint is the distance, not to one that is marked beside it") {
  for (const char* rod : {"constraint norm(P) = l name rod\n", "constraint x^2 + y^2 = l^2 name rod\n",
                          "constraint l = norm(P) name rod\n"}) {
    const ModelText m(std::string("param m = 2 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\n"
                                  "point Q at (x/2, y/2)\npoint P mass m at (x, y)\ngravity (0, -g)\n") +
                      rod);
    CHECK(value_at(m, only_reaction(m).value, {0, -1}, {0, 0}) == doctest::Approx(19.62).epsilon(1e-14));
  }
  // An arch of two bars with a tie between its feet: the distance of one foot from the centre of the other bar is a
  // function of the same angles. Statics: m g/(2 tan α).
  const ModelText arch(R"(param m = 20 kg, l = 2 m, g = 9.81 m/s^2
coord θ, φ : angle
body L mass m inertia m l^2/12 at l/2 (cos θ, sin θ) rotation angle θ
point C at l (cos θ, sin θ)
body R mass m inertia m l^2/12 at C + l/2 (cos φ, -sin φ) rotation angle -φ
point E at C + l (cos φ, -sin φ)
gravity (0, -g)
constraint E.y = 0 name floor
constraint norm(E) = l name tie
)");
  const Reaction tie = reactions(arch.equations)[1];
  const double at = std::acos(-1.0) / 3;
  CHECK(value_at(arch, tie.value, {at, at}, {0, 0}) == doctest::Approx(20 * 9.81 / (2 * std::tan(at))).epsilon(1e-13));
}

TEST_CASE("the arrow of a pulled rod points from the mass to the pivot, with the size of the tension") {
  const ModelText m(cartesian_pendulum);
  const Reaction rod = only_reaction(m);
  REQUIRE(rod.arrows.size() == 1);  // the pivot stands still: no arrow
  CHECK(rod.arrows[0].point == "P");
  const double fy = value_at(m, rod.arrows[0].force[1], {0, -0.7}, {0.5, 0});
  CHECK(fy == doctest::Approx(2 * (0.25 / 0.7 + 9.81)));
}

TEST_CASE("the same tension where the choice of coordinates removed the rod") {
  const ModelText m(R"(system pendulum
param m = 2 kg, l = 70 cm, g = 9.81 m/s^2
coord θ : angle
point P mass m at l (sin θ, -cos θ)
gravity (0, -g)
reaction rod = release l
)");
  const Reaction rod = only_reaction(m);
  CHECK(rod.kind == Reaction::Kind::Released);
  CHECK(rod.dimension.same_as(dimensions::force()));
  CHECK(equal(rod.value, m.p("m") * m.p("l") * square(m.v(0)) + m.p("m") * m.p("g") * cos(m.q(0))));
}

TEST_CASE("both rods of a double pendulum: released lengths against multipliers of four Cartesian coordinates") {
  const std::string head =
      "param m1 = 1 kg, m2 = 3 kg, l1 = 80 cm, l2 = 50 cm, g = 9.81 m/s^2, F = 2 N\ngravity (0, -g)\n";
  const ModelText polar("system s\n" + head + R"(coord θ1, θ2 : angle
point A mass m1 at l1 (sin θ1, -cos θ1)
point B mass m2 at A + l2 (sin θ2, -cos θ2)
force on B = (F, 0)
reaction upper = release l1
reaction lower = release l2
)");
  const ModelText cartesian("system s\n" + head + R"(coord x1, y1, x2, y2 : length
point A mass m1 at (x1, y1)
point B mass m2 at (x2, y2)
force on B = (F, 0)
constraint norm(A) = l1 name upper
constraint (x1 - x2)^2 + (y1 - y2)^2 = l2^2 name lower
)");
  const auto released = reactions(polar.equations), rods = reactions(cartesian.equations);
  REQUIRE(released.size() == 2);
  REQUIRE(rods.size() == 2);
  CHECK(rods[0].kind == Reaction::Kind::Tension);
  CHECK(rods[1].kind == Reaction::Kind::Tension);
  CHECK(rods[1].arrows.size() == 2);
  const double a = 0.4, b = -1.3, va = 1.1, vb = -0.6, l1 = 0.8, l2 = 0.5;
  const double x1 = l1 * std::sin(a), y1 = -l1 * std::cos(a), vx1 = l1 * va * std::cos(a), vy1 = l1 * va * std::sin(a);
  const std::vector<double> q{x1, y1, x1 + l2 * std::sin(b), y1 - l2 * std::cos(b)};
  const std::vector<double> v{vx1, vy1, vx1 + l2 * vb * std::cos(b), vy1 + l2 * vb * std::sin(b)};
  for (std::size_t k = 0; k < 2; ++k)
    CHECK(value_at(polar, released[k].value, {a, b}, {va, vb}) ==
          doctest::Approx(value_at(cartesian, rods[k].value, q, v)).epsilon(1e-12));
  // m2 (g − r̈_B)·e2 + F·e2 with r̈_B·e2 = l1 θ1'' sin(θ2 − θ1) − l1 θ1'² cos(θ2 − θ1) − l2 θ2'².
  const Expr lag = polar.q(1) - polar.q(0);
  const ExprVector along{polar.p("l2") * square(polar.v(1)), polar.p("l1") * square(polar.v(0)) * cos(lag),
                         -(polar.p("l1") * polar.a(0) * sin(lag)), polar.p("g") * cos(polar.q(1))};
  CHECK(equal(released[1].value, polar.p("m2") * total(along) + polar.p("F") * sin(polar.q(1))));
}

TEST_CASE("the force that holds a length is Lagrange's for the length as a coordinate") {
  // The same model with l as a parameter and as a coordinate; spring, damper, force, torque, a body and a driven pivot.
  const auto text = [](const std::string& length, const std::string& rest) {
    return "system s\nparam m = 1 kg, M = 2 kg, J = 3 kg m^2, k = 5 N/m, r = 1 m, c = 2 N s/m, F = 3 N, τ = 4 N m, g = "
           "9.81 m/s^2, "
           "w = 2 rad/s, a = 1 m" +
           length + "\ncoord θ, φ : angle" + rest +
           "point A mass m at (a sin(w t), 0) + l (sin θ, -cos θ)\n"
           "body B mass M inertia J at A + l (sin φ, cos φ) rotation angle φ + θ\npoint W at (a, a)\ngravity (0, -g)\n"
           "spring B - W stiffness k length r\ndamper A - B coefficient c\ndamper A - W coefficient c\n"
           "force on B = (F, 2 F)\ntorque on B = τ\n";
  };
  const ModelText held(text(", l = 2 m", "\n") + "reaction rod = release l\n");
  const ModelText free(text("", ", l : length\n"));
  Bindings at_free, at_held;  // the same state, l at rest
  double value = 0.3;
  const auto bind = [&](Expr a, Expr b, double x) {
    at_free[a] = x;
    at_held[b] = x;
  };
  for (const Parameter& p : free.system->parameters) bind(p.symbol, held.p(p.name), p.si_value);
  for (std::size_t i = 0; i < 2; ++i) {
    bind(free.q(i), held.q(i), value += 0.41);
    bind(free.v(i), held.v(i), value += 0.37);
    bind(free.a(i), held.a(i), value -= 1.23);
  }
  bind(free.q(2), held.p("l"), 2);
  at_free[free.v(2)] = at_free[free.a(2)] = 0;
  at_free[free.system->context->time()] = at_held[held.system->context->time()] = 0.7;
  const double lagrange = evaluate(expand_time_derivatives(free.equations.residual[2]), at_free);
  CHECK(std::abs(lagrange) > 1);
  CHECK(evaluate(only_reaction(held).value, at_held) == doctest::Approx(-lagrange).epsilon(1e-12));
}

TEST_CASE("a length held in a damper's path: its force is felt") {
  const ModelText m(R"(system s
param m = 1 kg, l = 2 m, c = 3 N s/m, w = 5 m
coord θ : angle
point P mass m at l (sin θ, -cos θ)
point W at (w, 0)
damper P - W coefficient c
reaction rod = release l
)");
  // The damper pulls P with c d' along the line to W.
  const Expr dx = m.p("l") * sin(m.q(0)) - m.p("w"), dy = -(m.p("l") * cos(m.q(0)));
  const Expr d2 = square(dx) + square(dy), rate = (dx * cos(m.q(0)) + dy * sin(m.q(0))) * m.p("l") * m.v(0);  // d d'
  const Expr along = dx * sin(m.q(0)) - dy * cos(m.q(0));
  const Expr closed = m.p("m") * m.p("l") * square(m.v(0)) - m.p("c") * rate * along / d2;
  CHECK(equal(only_reaction(m).value, closed));
}

TEST_CASE("a held angle takes a torque, also from the rotation of a body") {
  const ModelText m(R"(system s
param J = 2 kg m^2, α = 10 deg, τ = 3 N m
coord θ : angle
body B inertia J at (0, 0) rotation angle θ + α
torque on B = τ
reaction hold = release α
)");
  const Reaction hold = only_reaction(m);
  CHECK(hold.dimension.same_as(dimensions::torque()));
  CHECK(equal(hold.value, m.p("J") * m.a(0) - m.p("τ")));
}

TEST_CASE("a torque between two bodies acts back on the one that it comes from") {
  const std::string text = R"(system s
param J = 2 kg m^2, α = 10 deg, τ = 3 N m
coord θ, φ : angle
body A inertia J at (0, 0) rotation angle φ
body B inertia J at (0, 0) rotation angle θ + α
reaction hold = release α
)";
  const ModelText pushed(text + "torque on B from A = τ\n"), pushing(text + "torque on A from B = τ\n");
  CHECK(equal(only_reaction(pushed).value, pushed.p("J") * pushed.a(0) - pushed.p("τ")));
  CHECK(equal(only_reaction(pushing).value, pushing.p("J") * pushing.a(0) + pushing.p("τ")));
}

TEST_CASE("the multiplier of a quaternion's norm is no force, and that is said") {
  const ModelText m("param J = 1 kg m^2\nbody top inertia diag(J, J, 2 J) rotation quaternion\n");
  const auto all = reactions(m.equations);
  REQUIRE(all.size() == 1);
  CHECK(equal(all[0].value, m.system->constraints[0].multiplier));
  CHECK(all[0].arrows.empty());
  CHECK(all[0].sentence == "no force: the multiplier keeps the four numbers that turn top on the unit sphere");
}

TEST_CASE("a length in a given T has no reaction, and the reason is said") {
  const ModelText m(
      "system s\nparam m = 1 kg, l = 1 m\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nreaction rod = release l\n");
  const auto all = reactions(m.equations);
  REQUIRE(all.size() == 1);
  CHECK_FALSE(all[0].value);
  CHECK(all[0].sentence.find("the given T") != std::string::npos);
}

TEST_CASE("a held ring: the torque along its angle") {
  const ModelText m(R"(system s
param J = 2 kg m^2, τ = 3 N m
coord a, b : angle
T = 1/2 J a'^2 + 1/2 J b'^2
force a = τ
constraint a = b name mesh
constraint b = 0 name hold
)");
  const auto all = reactions(m.equations);
  CHECK(all[1].kind == Reaction::Kind::Multiplier);
  CHECK(all[1].dimension.same_as(dimensions::torque()));
  CHECK(all[1].sentence == "the torque on b that holds the constraint, positive towards increasing b");
  CHECK(value_at(m, all[1].value, {0, 0}, {0, 0}) == doctest::Approx(-3));
}

TEST_CASE("a bead on a wire given implicitly: λ |∇φ| is the normal force") {
  const ModelText m(R"(system bead
param m = 1 kg, a = 50 cm, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint y = x^2 / a name wire
)");
  const Reaction wire = only_reaction(m);
  CHECK(wire.kind == Reaction::Kind::Contact);
  // At rest at slope 2x/a = tan β: N = m g cos β.
  const double x = 0.3, slope = 2 * x / 0.5;
  CHECK(value_at(m, wire.value, {x, x * x / 0.5}, {0, 0}) == doctest::Approx(9.81 / std::sqrt(1 + slope * slope)));
  REQUIRE(wire.arrows.size() == 1);
  CHECK(value_at(m, wire.arrows[0].force[0], {x, x * x / 0.5}, {0, 0}) ==
        doctest::Approx(-9.81 * slope / (1 + slope * slope)));
}

TEST_CASE("a floor pushes; a polar length pulls; a knife edge holds sideways") {
  const ModelText floor(
      "system s\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\n"
      "gravity (0, -g)\nconstraint y = 0 name floor\n");
  const Reaction push = only_reaction(floor);
  CHECK(push.kind == Reaction::Kind::Contact);
  CHECK(value_at(floor, push.value, {1, 0}, {0, 0}) == doctest::Approx(9.81));

  const ModelText polar(
      "system s\nparam m = 1 kg, l = 2 m\ncoord r : length, θ : angle\n"
      "point P mass m at r (cos θ, sin θ)\nconstraint r = l name string\n");
  const Reaction pull = only_reaction(polar);
  CHECK(pull.kind == Reaction::Kind::Tension);
  CHECK(value_at(polar, pull.value, {2, 0.4}, {0, 3}) == doctest::Approx(18));

  const ModelText knife(R"(system s
param m = 1 kg, J = 1 kg m^2, F = 4 N
coord x, y : length, ψ : angle
body B mass m inertia J at (x, y) rotation angle ψ
force on B = (0, F)
constraint x' sin ψ = y' cos ψ name edge
)");
  const Reaction edge = only_reaction(knife);
  CHECK(edge.dimension.same_as(dimensions::force()));
  CHECK(edge.kind == Reaction::Kind::Contact);
  CHECK(equal(edge.value, knife.equations.multipliers[0]));
  CHECK(value_at(knife, edge.value, {0, 0, 0}, {0, 0, 0}) == doctest::Approx(4));  // against F: along −(left − right)
}

TEST_CASE("a coupler between two cranks is a rod") {
  const ModelText m(R"(system four_bar
param m = 1 kg, a = 1 m, b = 2 m, c = 3 m, d = 4 m
coord α, β : angle
point A mass m at a (cos α, sin α)
point B mass m at (d, 0) + b (cos β, sin β)
constraint (A.x - B.x)^2 + (A.y - B.y)^2 = c^2 name coupler
)");
  const Reaction coupler = only_reaction(m);
  CHECK(coupler.kind == Reaction::Kind::Tension);
  CHECK(equal(coupler.value, Rational(-2) * m.p("c") * m.equations.multipliers[0]));
}

TEST_CASE("relations that are no rods") {
  const ModelText m(
      "system s\nparam m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\n"
      "constraint x^2 + 2 y^2 = l^2 name track\n");
  CHECK(only_reaction(m).kind == Reaction::Kind::Contact);
  const ModelText given(
      "system s\nparam m = 1 kg, l = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
      "constraint x^2 + y^2 = l^2 name rod\n");
  const Reaction r = only_reaction(given);
  CHECK(r.kind == Reaction::Kind::Generalized);
  CHECK(equal(square(r.value),
              Rational(4) * square(given.equations.multipliers[0]) * (square(given.q(0)) + square(given.q(1)))));
}

}  // namespace reactions_test
