#include "decimal.hpp"

using namespace maupertuis;

TEST_CASE("the zeros of |x| as a force, located to 100 digits") {
  // x'' = −sign x from x = 1/5: a parabola between zeros, the quarter of a period √(2/5).
  const ModelText m("system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = abs(x)\nstart x = 0.2\nrun 7\n");
  const ExtendedResult r = run(m, digits100());
  REQUIRE(r.ok());
  const Decimal quarter = sqrt(Decimal("0.4"));
  Decimal t = 7;
  while (t > 4 * quarter) t -= 4 * quarter;
  // 7 = 2 periods and 3.06 quarters: on the way up from the second zero.
  REQUIRE(t > 3 * quarter);
  const Decimal to_turn = 4 * quarter - t;
  check_digits(r.final.q[0], Decimal("0.2") - to_turn * to_turn / 2, 98);
  check_digits(r.final.v[0], to_turn, 98);
  CHECK(r.statistics.switches == 6);
}

TEST_CASE("dry friction: the motion stops where both sides push back, and says so") {
  const ModelText m(
      "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = -0.3 sign(x')\nstart x' = 1\nrun 7\n");
  const ExtendedResult r = run(m, {});
  CHECK(r.ending == Ending::Sliding);
  CHECK(r.reached == doctest::Approx(1 / 0.3).epsilon(1e-14));
}

TEST_CASE("run until: the time of a throw, to 100 digits") {
  const ModelText m(
      "system throw\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, -g)\n"
      "start y = 2 m, x' = 1 m/s, y' = 3 m/s\nrun until y = 0 within 10 s\n");
  const ExtendedResult r = run(m, digits100());
  CHECK(r.ending == Ending::UntilReached);
  const Decimal g("9.81"), fall = (3 + sqrt(9 + 4 * g)) / g;
  check_digits(r.final.t, fall, 100);
  check_digits(r.final.q[0], fall, 100);
  check_digits(r.final.v[1], 3 - g * fall, 100);
}

TEST_CASE("run until: not reached") {
  const ModelText m(
      "system throw\nparam m = 1 kg\ncoord x : length\npoint P mass m at (x, 0 [m])\nstart x' = 1 m/s\nrun until x = 5 "
      "m within 2 s\n");
  const ExtendedResult r = run(m, {});
  CHECK(r.ending == Ending::UntilNotReached);
  check_digits(r.final.q[0], 2, 32);
}
