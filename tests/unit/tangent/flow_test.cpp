#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <boost/multiprecision/cpp_dec_float.hpp>

// The derivative of flows against closed forms, against quotients of differences in quad precision, and against what
// the geometry of mechanics asks of it.

using namespace maupertuis;

namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<40>>;

const char* const oscillator =
    "system oscillator\ndimensionless\nparam m = 2, k = 3, c = 0\ncoord x : number\n"
    "T = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\nstart x = 0.3, x' = -1\n";
const std::string two_links =
    "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ1, θ2 : angle\npoint A mass m at l (sin θ1, -cos "
    "θ1)\n"
    "point B mass m at A + l (sin θ2, -cos θ2)\ngravity (0, -g)\nstart θ1 = 2.0 rad, θ2 = 2.5 rad\n";

/// ∂(final)/∂(start component) by central differences in quad precision: its error is h² times the third derivative.
std::vector<double> quotient(const ModelText& m, double t, std::size_t coordinate, int order) {
  const Rational h = *Rational::parse("1e-9");
  const auto above = quad_end(m, t, coordinate, order, h), below = quad_end(m, t, coordinate, order, -h);
  std::vector<double> out;
  for (std::size_t i = 0; i < above.size(); ++i)
    out.push_back(((Quad(above[i]) - Quad(below[i])) / Quad("2e-9")).convert_to<double>());
  return out;
}

std::vector<double> column(const TangentPoint& p, std::size_t j) { return {p.column(j).begin(), p.column(j).end()}; }

std::string chain(int links) {
  std::string text = "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", previous = "O";
  for (int i = 1; i <= links; ++i) text += "coord q" + std::to_string(i) + " : angle\n";
  for (int i = 1; i <= links; ++i) {
    const std::string point = "P" + std::to_string(i), angle = "q" + std::to_string(i);
    text += "point " + point + " mass m at " + previous + " + l (sin " + angle + ", -cos " + angle + ")\n";
    previous = point;
  }
  text += "gravity (0, -g)\nstart";
  for (int i = 1; i <= links; ++i)
    text += (i > 1 ? "," : "") + std::string(" q") + std::to_string(i) + " = " + std::to_string(0.8 + 0.1 * i) + " rad";
  return text + "\n";
}

}  // namespace

TEST_CASE("harmonic oscillator: cos ωt, sin ωt / ω") {
  const ModelText m(oscillator);
  const double w = std::sqrt(1.5), t = 7.3;
  const TangentPoint p = carried(m, t);
  const std::vector<double> expected{std::cos(w * t), -w * std::sin(w * t), std::sin(w * t) / w, std::cos(w * t)};
  CHECK(p.columns() == 2);
  CHECK(relative_difference(p.directions, expected) < 1e-14);
}

TEST_CASE("backwards is the inverse") {
  const ModelText m(two_links);
  TangentFlow flow(m.equations);
  TangentPoint point = flow.all_directions(start_of(m));
  const std::vector<double> unit = point.directions;
  REQUIRE_FALSE(flow.advance(point, 1.5));
  REQUIRE_FALSE(flow.advance(point, 0));
  CHECK(relative_difference(point.directions, unit) < 1e-11);
  CHECK(relative_difference(point.state.q, {2.0, 2.5}) < 1e-13);
}

TEST_CASE("Kepler: over a period dΦ = 1 − f ∂T/∂x, since every orbit closes after its own period T(E)") {
  const ModelText m(
      "system kepler\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = -1/sqrt(x^2 + y^2)\n"
      "start x = 0.4, y' = 2\n");
  const double period = 2 * std::acos(-1.0);  // a = 1
  const TangentPoint p = carried(m, period);
  const double r = 0.4, v = 2, slope = 3 * period;  // T = 2π (−2E)^(−3/2), dT/dE = 6π at E = −1/2
  const std::vector<double> f{0, v, -1 / (r * r), 0}, energy{1 / (r * r), 0, 0, v};
  std::vector<double> expected;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) expected.push_back((i == j ? 1.0 : 0.0) - f[i] * slope * energy[j]);
  CHECK(relative_difference(p.directions, expected) < 2e-13);
}

TEST_CASE("two links: against differences of the flow in quad precision" * doctest::skip(under_sanitizers)) {
  const ModelText m(two_links);
  const TangentPoint p = carried(m, 2);
  for (std::size_t j = 0; j < 4; ++j)
    CHECK(relative_difference(column(p, j), quotient(m, 2, j % 2, j < 2 ? 0 : 1)) < 2e-13);
}

TEST_CASE("two links: the symplectic form in canonical variables is preserved, and so is the volume") {
  const ModelText m(two_links);
  const TangentGeometry geometry(m.equations);
  CHECK(geometry.symplectic());
  TangentFlow flow(m.equations);
  TangentPoint p = flow.all_directions(start_of(m));
  const auto before = geometry.symplectic_products(p);
  REQUIRE_FALSE(flow.advance(p, 3));
  CHECK(relative_difference(geometry.symplectic_products(p), before) < 1e-12);
  CHECK(std::abs(*geometry.divergence(p.state)) == 0);
}

TEST_CASE("damping: the determinant follows from the trace (Liouville)") {
  std::string text = oscillator;
  text.replace(text.find("c = 0"), 5, "c = 0.7");
  const ModelText m(text);
  const TangentGeometry geometry(m.equations);
  CHECK_FALSE(geometry.symplectic());
  CHECK(*geometry.divergence(start_of(m)) == doctest::Approx(-0.35).epsilon(1e-15));
  CHECK(determinant(carried(m, 5).directions) == doctest::Approx(std::exp(-0.35 * 5)).epsilon(1e-13));
}

TEST_CASE("a drive and damping that depends on the place: against differences in quad precision") {
  const ModelText m(
      "system driven\ndimensionless\ncoord x : number\ninput u = 0.3 cos(1.4 t)\nT = 1/2 (1 + x^2) x'^2\nV = 1/4 x^4 - "
      "1/2 x^2\n"
      "D = 1/2 (0.2 + x^2) x'^2\nforce x = u\nstart x = 0.2, x' = 0.1\n");
  const TangentPoint p = carried(m, 6);
  CHECK(relative_difference(column(p, 0), quotient(m, 6, 0, 0)) < 1e-13);
  CHECK(relative_difference(column(p, 1), quotient(m, 6, 0, 1)) < 1e-13);
}

TEST_CASE("constraints: the Cartesian pendulum carries directions as the angle does") {
  const ModelText angle(
      "system a\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
      "gravity (0, -g)\nstart θ = 1 rad, θ' = 0.5 rad/s\n");
  const ModelText cartesian(
      "system b\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
      "-g)\n"
      "constraint x^2 + y^2 = l^2 name rod\nstart x = l sin(1), y = -l cos(1), x' = 0.5 [1/s] l cos(1), y' = 0.5 [1/s] "
      "l sin(1)\n");
  const auto push = [](const MotionState& at, std::span<const double> d) {
    const double s = std::sin(at.q[0]), c = std::cos(at.q[0]), w = at.v[0];
    return std::vector<double>{2 * c * d[0], 2 * s * d[0], 2 * (c * d[1] - s * w * d[0]),
                               2 * (s * d[1] + c * w * d[0])};
  };
  TangentFlow by_angle(angle.equations), by_position(cartesian.equations);
  TangentPoint a = by_angle.all_directions(start_of(angle)), b{start_of(cartesian), {}};
  CHECK(by_position.all_directions(b.state).columns() == 2);
  for (std::size_t j = 0; j < 2; ++j)
    for (const double x : push(a.state, a.column(j))) b.directions.push_back(x);
  REQUIRE_FALSE(by_angle.advance(a, 4));
  REQUIRE_FALSE(by_position.advance(b, 4));
  for (std::size_t j = 0; j < 2; ++j) CHECK(relative_difference(column(b, j), push(a.state, a.column(j))) < 1e-12);
}

TEST_CASE("a spherical pendulum by its constraint: ω is preserved on the allowed directions") {
  const ModelText m(
      "system sphere\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y, z : length\npoint P mass m at (x, y, z)\n"
      "gravity (0, 0, -g)\nconstraint x^2 + y^2 + z^2 = l^2\nstart x = 0.6 m, z = -0.8 m, y' = 2 m/s\n");
  const TangentGeometry geometry(m.equations);
  TangentFlow flow(m.equations);
  TangentPoint p = flow.all_directions(start_of(m));
  CHECK(p.columns() == 4);
  const auto before = geometry.symplectic_products(p);
  REQUIRE_FALSE(flow.advance(p, 5));
  CHECK(relative_difference(geometry.symplectic_products(p), before) < 1e-11);
}

TEST_CASE("a constraint between velocities: the knife edge against differences in quad precision") {
  const ModelText m(
      "system edge\nparam m = 1 kg, J = 0.5 kg m^2, g = 3 m/s^2\ncoord x, y : length, φ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 J φ'^2\nV = -m g x\nconstraint x' sin φ = y' cos φ\nstart φ = 0.3 rad, φ' = 1.5 "
      "rad/s\n");
  TangentFlow flow(m.equations);
  TangentPoint p{start_of(m),
                 {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1}};  // at rest in x and y, so that δφ and δφ' are allowed
  CHECK(flow.all_directions(p.state).columns() == 5);
  REQUIRE_FALSE(flow.advance(p, 3));
  CHECK(relative_difference(column(p, 0), quotient(m, 3, 2, 0)) < 1e-12);
  CHECK(relative_difference(column(p, 1), quotient(m, 3, 2, 1)) < 1e-12);
  CHECK_FALSE(TangentGeometry(m.equations).divergence(p.state));
}

TEST_CASE("switches: a spring that only pushes is differentiable, a constant force that turns over is not") {
  const std::string head = "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n", tail = "start x = 1, x' = -1\n";
  const ModelText pushes(head + "force x = -4 min(x, 0) - 1\n" + tail);
  // x falls, is stopped by the spring below 0, and comes back: against differences in quad precision.
  const TangentPoint p = carried(pushes, 3);
  CHECK(relative_difference(column(p, 0), quotient(pushes, 3, 0, 0)) < 1e-12);
  CHECK(relative_difference(column(p, 1), quotient(pushes, 3, 0, 1)) < 1e-12);
  const ModelText turns(head + "V = abs(x)\n" + tail);
  TangentFlow flow(turns.equations);
  TangentPoint q = flow.all_directions(start_of(turns));
  const auto stop = flow.advance(q, 3);
  REQUIRE(stop);
  CHECK(stop->ending == StepEnding::None);
  CHECK(stop->t == doctest::Approx(std::sqrt(3) - 1).epsilon(1e-14));  // 1 − t − t²/2 = 0
  CHECK(q.state.t == 0);
  // Up to the switch the derivative is that from before; it does not go on from there.
  REQUIRE_FALSE(flow.advance(q, stop->t));
  CHECK(relative_difference(q.directions, {1, 0, stop->t, 1}) < 1e-14);
  CHECK(flow.advance(q, 3)->t == stop->t);
}

TEST_CASE("switches: through forces that begin with a root the derivative keeps H and areas") {
  struct Force {
    const char* text;
    double factor, power, from;
  };
  for (const Force& f : {Force{"-10 max(x, 0)^(3/2)", 10, 1.5, 0}, Force{"-10 max(x, 0)^(6/5)", 10, 1.2, 0},
                         Force{"-10 max(x - 0.1, 0)^(5/2)", 10, 2.5, 0.1}}) {
    const ModelText m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nforce x = ") + f.text +
                      "\nstart x = 0.9, x' = 0.2\n");
    const auto slope = [&](double x) { return x + f.factor * std::pow(std::max(x - f.from, 0.0), f.power); };
    TangentFlow flow(m.equations);
    TangentPoint p = flow.all_directions(start_of(m));
    const TangentPoint begin = p;
    REQUIRE_FALSE(flow.advance(p, 7));  // some turns
    const auto& d = p.directions;
    CHECK(determinant(d) == doctest::Approx(determinant(begin.directions)).epsilon(1e-11));
    for (std::size_t k = 0; k < 2; ++k) {
      const auto after = column(p, k), before = column(begin, k);
      CHECK(slope(p.state.q[0]) * after[0] + p.state.v[0] * after[1] ==
            doctest::Approx(slope(0.9) * before[0] + 0.2 * before[1]).epsilon(1e-10));
    }
    // Along H it is the time that it gains.
    const auto end = [&](double x) {
      TangentPoint q = begin;
      q.state.q[0] = x;
      REQUIRE_FALSE(flow.advance(q, 7));
      return q.state.q[0];
    };
    CHECK(column(p, 0)[0] == doctest::Approx((end(0.9 + 1e-5) - end(0.9 - 1e-5)) / 2e-5).epsilon(1e-5));
  }
}

TEST_CASE("many coordinates go in groups whose motions agree") {
  const ModelText m(chain(9));
  TangentFlow flow(m.equations);
  const TangentGeometry geometry(m.equations);
  TangentPoint p = flow.all_directions(start_of(m));
  CHECK(p.columns() == 18);
  const auto before = geometry.symplectic_products(p);
  REQUIRE_FALSE(flow.advance(p, 0.5));
  CHECK(flow.spread() > 0);  // they are separate runs
  CHECK(flow.spread() < 1e-12);
  CHECK(relative_difference(geometry.symplectic_products(p), before) < 1e-11);
  const auto by_differences = quotient(m, 0.5, 4, 0);
  CHECK(relative_difference(column(p, 4), by_differences) < 1e-12);
}

TEST_CASE("points on the way, and a flow that cannot go on") {
  const ModelText m("system fall\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\n");
  TangentFlow flow(m.equations);
  std::vector<TangentPoint> points;
  const double collision = std::acos(-1.0) / std::sqrt(8.0);
  const double times[] = {0.2, 0.4, 1.0, 1.3};
  const auto stop = flow.along(flow.all_directions(start_of(m)), times, points);
  REQUIRE(stop);
  CHECK(stop->ending != StepEnding::None);
  CHECK(stop->t == doctest::Approx(collision).epsilon(1e-3));
  REQUIRE(points.size() == 3);
  TangentPoint direct = flow.all_directions(start_of(m));
  REQUIRE_FALSE(flow.advance(direct, 1.0));
  CHECK(relative_difference(points[2].directions, direct.directions) < 1e-13);
}

TEST_CASE("a rod that is written by its length is kept from a start at rest") {
  // |P| = l is a root: its terms do not show what rounding makes of it. Reference: the same in the angle, at rest at
  // atan2(0.18, 0.24), by its elliptic function: x(1 s) = l sin θ(1 s), in 30 digits.
  const ModelText m(
      "system p\nparam m = 1 kg, l = 0.3 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\n"
      "gravity (0, -g)\nconstraint norm(P) = l\nstart x = 0.18 m, y = -0.24 m\n");
  TangentFlow flow(m.equations);
  TangentPoint point = flow.all_directions(start_of(m));
  for (int k = 1; k <= 10; ++k) {
    const auto stop = flow.advance(point, 0.1 * k);
    INFO((stop ? stop->reason : std::string()));
    REQUIRE_FALSE(stop);
  }
  const double k = std::sin(0.5 * std::atan2(0.18, 0.24)), w = std::sqrt(9.81 / 0.3);
  // θ = 2 asin(k cd(ω t, k)), cd by the arithmetic-geometric mean.
  double a[12], c[12], b = std::sqrt(1 - k * k);
  a[0] = 1, c[0] = k;
  int steps = 0;
  for (; std::abs(c[steps]) > 1e-16 && steps < 10; ++steps) {
    a[steps + 1] = 0.5 * (a[steps] + b), c[steps + 1] = 0.5 * (a[steps] - b);
    b = std::sqrt(a[steps] * b);
  }
  double amplitude = std::ldexp(a[steps], steps) * w * 1.0;
  for (int j = steps; j > 0; --j) amplitude = 0.5 * (amplitude + std::asin(c[j] / a[j] * std::sin(amplitude)));
  const double cn = std::cos(amplitude), sn = std::sin(amplitude), dn = std::sqrt(1 - k * k * sn * sn);
  const double theta = 2 * std::asin(k * cn / dn);
  CHECK(point.state.q[0] == doctest::Approx(0.3 * std::sin(theta)).epsilon(1e-12));
}

TEST_CASE("the flow of equations alone refuses contacts and friction, and lists that do not fit") {
  const ModelText rubbed(
      "system f\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\n"
      "gravity (0, -g)\nfriction x coefficient 0.3 normal m g\nstart x' = 2 m/s\n");
  CHECK_THROWS_WITH_AS(TangentFlow(rubbed.equations), doctest::Contains("friction (x)"), std::invalid_argument);
  const ModelText m("system f\ndimensionless\ncoord x : number\nL = 1/2 x'^2\n");
  TangentFlow flow(m.equations);
  CHECK_THROWS_WITH_AS(static_cast<void>(flow.all_directions({0, {1, 2}, {1, 2}})), doctest::Contains("state.q"),
                       std::invalid_argument);
  TangentPoint point{{0, {1}, {1}}, {1, 0, 0}};
  CHECK_THROWS_WITH_AS(static_cast<void>(flow.advance(point, 1)), doctest::Contains("`directions`"),
                       std::invalid_argument);
}
