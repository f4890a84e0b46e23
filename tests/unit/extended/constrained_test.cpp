#include "../under_sanitizers.hpp"
#include "decimal.hpp"

using namespace maupertuis;

namespace {

const char* const reduced =
    "system r\nparam m = 1 kg, l = 1.3 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at (l sin θ, l - l cos θ)\n"
    "gravity (0, -g)\nstart θ = 30 deg\nrun 2 s\n";

std::string in_x_and_y(const std::string& constraint, const std::string& start) {
  return "system c\nparam m = 1 kg, l = 1.3 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity "
         "(0, -g)\n" +
         constraint + "start " + start + "\nrun 2 s\n";
}

}  // namespace

TEST_CASE("the pendulum in x and y is the one in θ, to 100 digits; Newton finds what the start leaves open") {
  const ExtendedResult by_angle = run(ModelText(reduced), digits100());
  const ExtendedResult r =
      run(ModelText(in_x_and_y("constraint x^2 + (y - l)^2 = l^2 name rod\n", "x = l/2")), digits100());
  REQUIRE(r.ok());
  for (int axis = 0; axis < 2; ++axis) check_digits(r.final.q[axis], Decimal(by_angle.final.points[axis].text), 98);
  // The tension, m l θ'² + m g cos θ.
  const Decimal rate(by_angle.final.v[0].text), angle(by_angle.final.q[0].text);
  REQUIRE(r.reactions.size() == 1);
  check_digits(r.final.reactions[0], -(Decimal("1.3") * rate * rate + Decimal("9.81") * cos(angle)), 98);
}

TEST_CASE("y = 0 is measured by the motion beside it: a cart with a pendulum is the one that has no y") {
  const ExtendedResult without =
      run(ModelText("dimensionless\ncoord x, a : number\nT = x'^2 + 1/2 ((x' + a' cos a)^2 + (a' sin a)^2)\n"
                    "V = -10 cos a\nstart a = 1\nrun 2\n"),
          digits100());
  for (const std::string law : {"constraint y = 0", "contact y >= 0"}) {
    CAPTURE(law);
    const ExtendedResult r =
        run(ModelText("dimensionless\ncoord x, y, a : number\n"
                      "T = x'^2 + y'^2 + 1/2 ((x' + a' cos a)^2 + (y' + a' sin a)^2)\nV = 30 y - 10 cos a\n" +
                      law + "\nstart a = 1\nrun 2\n"),
            digits100());
    REQUIRE(r.ok());
    check_digits(r.final.q[0], Decimal(without.final.q[0].text), 98);
    check_digits(r.final.q[2], Decimal(without.final.q[1].text), 98);
    check_zero(r.final.q[1], 1e-100);
  }
}

TEST_CASE("a redundant constraint is left out, and its share of the force is not made up") {
  const ExtendedResult by_angle = run(ModelText(reduced), digits100());
  const ExtendedResult r = run(
      ModelText(in_x_and_y(
          "constraint x^2 + (y - l)^2 = l^2 name rod\nconstraint 2 x^2 + 2 (y - l)^2 = 2 l^2 name again\n", "x = l/2")),
      digits100());
  REQUIRE(r.ok());
  check_digits(r.final.q[0], Decimal(by_angle.final.points[0].text), 98);
  REQUIRE(r.final.reactions.size() == 2);
  CHECK(r.final.reactions[0].text.empty());
  CHECK(r.final.reactions[1].text.empty());
}

TEST_CASE("a period of exactly 2 s: g = 4 K(1/2)² in 44 digits") {
  const ModelText m(
      "system d\nparam g = 13.750371636040745654980191559621114395801712 m/s^2, m = 1 kg, l = 1 m\ncoord x, y : "
      "length\n"
      "point P mass m at (x, y)\ngravity (0, -g)\nconstraint x^2 + y^2 = l^2\nstart x = 1 m, y = 0 m\nrun 2 s\n");
  const ExtendedResult r = run(m, digits100());
  REQUIRE(r.ok());
  check_digits(r.final.q[0], 1, 100);
  // The period is off by 1e-45 s, and y goes with its square; with the double of g it would be off by 1e-17 s.
  check_zero(r.final.q[1], 1e-84);
}

TEST_CASE("a knife edge: a constraint between velocities, in circles") {
  const ModelText m(
      "system skate\nparam m = 1 kg, J = 0.1 kg m^2\ncoord x, y : length, θ : angle\nT = 1/2 m (x'^2 + y'^2) + 1/2 J "
      "θ'^2\n"
      "constraint x' sin θ = y' cos θ name blade\nstart x' = 1 m/s, θ' = 3 rad/s\nrun 1 s\n");
  const ExtendedResult r = run(m, digits100());
  check_digits(r.final.q[0], sin(Decimal(3)) / 3, 99);
  check_digits(r.final.q[1], (1 - cos(Decimal(3))) / 3, 99);
}

TEST_CASE("written values that clash with a constraint in their last digits") {
  const ExtendedResult r =
      run(ModelText(in_x_and_y("constraint x^2 + y^2 = l^2 name rod\n", "x = 0.78 m, y = -1.0400000000001 m")),
          digits100());
  REQUIRE(r.ok());
  const Decimal x(r.final.q[0].text), y(r.final.q[1].text);
  CHECK(abs(x * x + y * y - Decimal("1.69")) < Decimal("1e-96"));
}

TEST_CASE("a top that a quaternion turns keeps 12 digits of 113 bits in double, after a hundred radians" *
          doctest::skip(under_sanitizers)) {
  const ModelText m(
      "system top\nparam m = 100 g, h = 3 cm, g = 9.81 m/s^2, tilt = 25 deg\nparam I1 = 5e-5 kg m^2, I3 = 6e-5 kg m^2\n"
      "frame spinning rotation quaternion\nbody top mass m inertia diag(I1, I1, I3) at (0, 0, h) in spinning\ngravity "
      "(0, 0, -g)\n"
      "start spinning.qx = sin(tilt/2), top.ω = (0, 0, 200) rad/s\nrun 500 ms\n");
  const ExtendedResult exact = run(m, {});
  REQUIRE(exact.ok());
  Diagnostics diagnostics;
  const auto motion = simulate(m.model, m.equations, {}, diagnostics);
  REQUIRE(motion);
  REQUIRE(motion->ok());
  for (const auto& [ours, theirs] :
       {std::pair(&motion->final.q, &exact.final.q), std::pair(&motion->final.v, &exact.final.v)}) {
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = std::stod((*theirs)[i].text);
      largest = std::max(largest, std::abs(x)), difference = std::max(difference, std::abs((*ours)[i] - x));
    }
    CHECK(difference < 1e-12 * largest);
  }
}

TEST_CASE("a start that gives a point by its place and velocity, in all digits") {
  const ModelText m(
      "system arm\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord a, b : angle\npoint elbow mass m at l (cos a, sin "
      "a)\n"
      "point hand mass m at elbow + l (cos b, sin b)\ngravity (0, -g)\n"
      "start hand = (1.2, 0.5) m, a' = 0.1 rad/s, hand.y' = 0.7 m/s\nrun 1e-150 s\n");
  const ExtendedResult r = run(m, digits100());
  REQUIRE(r.ok());
  const Decimal a(r.final.q[0].text), b(r.final.q[1].text);
  CHECK(abs(cos(a) + cos(b) - Decimal("1.2")) < Decimal("1e-97"));
  CHECK(abs(sin(a) + sin(b) - Decimal("0.5")) < Decimal("1e-97"));
  check_digits(r.final.v[0], Decimal("0.1"), 98);
  CHECK(abs(cos(a) * Decimal("0.1") + cos(b) * Decimal(r.final.v[1].text) - Decimal("0.7")) < Decimal("1e-97"));
}
