// Friction in the planes of contacts in space in many digits: closed forms in decimals, double as another route.
#include "decimal.hpp"

#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

#include <cmath>

using namespace maupertuis;

namespace {

const std::string rolling_ball =
    "dimensionless\nparam g = 9.81, u = 0.2\ncoord x, y, z, a, b, c : number\n"
    "T = 1/2 (x'^2 + y'^2 + z'^2) + 1/5 (a'^2 + b'^2 + c'^2)\nV = g z\n";

std::string block_in_space(const std::string& more) {
  return "dimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\n" + more;
}

ExtendedResult run_in_space(const std::string& text, const Rational& duration, std::vector<Rational> at = {}) {
  ExtendedSimulationOptions options;
  options.duration = duration;
  options.at = std::move(at);
  ExtendedResult out = run(ModelText(text), options);
  INFO(out.reason);
  REQUIRE(out.ok());
  return out;
}

/// The same motion in double: the same happenings, and states to 10⁻¹³ of the largest.
void check_against_double(const std::string& text, const ExtendedResult& many, double duration) {
  const ModelText m(text);
  Diagnostics diagnostics;
  SimulationOptions options;
  options.duration = duration;
  const auto r = simulate(m.model, m.equations, options, diagnostics);
  REQUIRE(r);
  REQUIRE(r->ok());
  REQUIRE(r->happenings.size() == many.happenings.size());
  for (std::size_t i = 0; i < r->happenings.size(); ++i) {
    CHECK(r->happenings[i].kind == many.happenings[i].kind);
    CHECK(r->happenings[i].name == many.happenings[i].name);
    CHECK(r->happenings[i].t == doctest::Approx(std::stod(many.happenings[i].t.text)).epsilon(1e-11));
  }
  double size = 1;
  for (const double x : r->final.q) size = std::max(size, std::abs(x));
  for (std::size_t i = 0; i < r->final.q.size(); ++i)
    CHECK(std::abs(r->final.q[i] - std::stod(many.final.q[i].text)) <= 1e-13 * size);
}

}  // namespace

TEST_CASE("a block thrown over a floor goes straight and stops after v²/(2 μ g)") {
  const std::string text = block_in_space(
      "V = 10 z\ncontact z >= 0 friction 0.25 slip (x', y') name floor\n"
      "start x' = 3, y' = 4\n");
  const ExtendedResult r = run_in_space(text, 3, {1, 2, Rational::from_double(2.5)});
  REQUIRE(r.happenings.size() == 1);
  CHECK(r.happenings[0].kind == Happening::Kind::Stick);
  check_digits(r.happenings[0].t, 2, 32);
  check_digits(r.at[0].q[0], Decimal("2.25"), 32);              // 3 t − ½ 2.5 (3/5) t²
  for (const ExtendedState& s : {r.at[1], r.at[2], r.final}) {  // also at the instant at which it stops
    check_digits(s.q[0], 3, 32);
    check_digits(s.q[1], 4, 32);
  }
  CHECK(r.final.v[0].text == "0");
  CHECK(r.final.v[1].text == "0");
  check_against_double(text, r, 3);
}

TEST_CASE("a block thrown across an incline turns and stops at v (k + cos θ)/(g sin α (k² − 1)), k = μ/tan α") {
  // θ between the slip and downhill at the beginning. Where k is little more than 1, as in the second, the slip turns
  // slowly until it stops.
  const struct {
    const char *tilt, *friction;
    int digits;
  } cases[] = {{"0.4", "0.6", 31}, {"0.1", "1", 29}};
  for (const auto& c : cases) {
    const std::string text = block_in_space(
        fmt::format("param g = 9.81, a = {}, u = {}\n", c.tilt, c.friction) +
        "V = g (x sin a + z cos a)\ncontact z >= 0 friction u slip (x', y') name plane\nstart x' = 1, y' = 2\n");
    const ExtendedResult r = run_in_space(text, 1);
    REQUIRE(r.happenings.size() == 1);
    const Decimal a(c.tilt), k = Decimal(c.friction) / tan(a);
    check_digits(r.happenings[0].t, (sqrt(Decimal(5)) * k - 1) / (Decimal("9.81") * sin(a) * (k * k - 1)), c.digits);
    CHECK(r.final.q[0].digits >= 30);
    CHECK(r.final.q[1].digits >= 30);
    check_against_double(text, r, 1);
  }
}

TEST_CASE("a ball that spins slides along one direction and rolls after 2 v/(7 μ g)") {
  const std::string text =
      rolling_ball + "contact z >= 0 friction u slip (x' - b', y' + a') name floor\nstart x' = 3, a' = 5\n";
  const ExtendedResult r = run_in_space(text, 1);
  const Decimal slip = sqrt(Decimal(34)), rolls = 2 * slip / (7 * Decimal("1.962"));
  REQUIRE(r.happenings.size() == 1);
  check_digits(r.happenings[0].t, rolls, 32);
  check_digits(r.final.v[0], Decimal(15) / 7, 31);
  check_digits(r.final.v[1], Decimal(-10) / 7, 31);
  const Decimal pull = Decimal("1.962") * 3 / slip;
  check_digits(r.final.q[0], 3 * rolls - pull * rolls * rolls / 2 + Decimal(15) / 7 * (1 - rolls), 31);
  check_against_double(text, r, 1);
}

TEST_CASE("a block gives way to a force that grows, straight on or turning, and where static friction is more") {
  const std::string contact = "V = 10 z\ncontact z >= 0 friction 0.3 slip (x', y') name floor\n";
  const ExtendedResult straight = run_in_space(block_in_space("force x = 1.2 t\nforce y = 1.6 t\n" + contact), 3);
  REQUIRE(straight.happenings.size() == 1);
  CHECK(straight.happenings[0].kind == Happening::Kind::Slip);
  check_digits(straight.happenings[0].t, Decimal("1.5"), 32);  // 2 t = μ g, and then (t − t₀)³/3
  check_digits(straight.final.q[0], Decimal("0.6") * Decimal("1.125"), 30);
  check_digits(straight.final.q[1], Decimal("0.8") * Decimal("1.125"), 30);

  const std::string turning = block_in_space("force x = 2 t\nforce y = 1.5 + t^2\n" + contact);
  const ExtendedResult turns = run_in_space(turning, 3);
  REQUIRE(turns.happenings.size() == 1);
  check_digits(turns.happenings[0].t, sqrt((sqrt(Decimal(76)) - 7) / 2), 31);
  CHECK(turns.final.q[0].digits >= 28);
  check_against_double(turning, turns, 3);

  const std::string jumping = block_in_space(
      "force x = 2 t\nforce y = 1.5 + t^2\nV = 10 z\n"
      "contact z >= 0 friction 0.3 static 0.4 slip (x', y') name floor\n");
  const ExtendedResult jumps = run_in_space(jumping, 3);
  REQUIRE(jumps.happenings.size() == 1);
  check_digits(jumps.happenings[0].t, sqrt((sqrt(Decimal(104)) - 7) / 2), 31);  // t⁴ + 7 t² + 2.25 = 16
  CHECK(jumps.final.q[0].digits >= 28);
  check_against_double(jumping, jumps, 3);
}

TEST_CASE(
    "a ball with spin slides in an impact, and bounces to a roll: one that grips takes 2/7 of the slip from its "
    "speed") {
  const std::string text = rolling_ball +
                           "contact z >= 0 restitution 0.7 friction u slip (x' - b', y' + a') name floor\n"
                           "start x' = 3, a' = 5, z = 1\n";
  const ExtendedResult r = run_in_space(text, 1);
  REQUIRE(r.happenings.size() == 1);
  check_digits(r.happenings[0].impulse, Decimal("1.7") * sqrt(2 * Decimal("9.81")), 31);
  // It slides throughout the first impact and grips in the second.
  const Decimal slip = sqrt(Decimal(34)), taken = Decimal("0.2") * Decimal("1.7") * sqrt(2 * Decimal("9.81"));
  check_digits(r.final.v[0], 3 - taken * 3 / slip, 31);
  check_digits(r.final.v[1], -taken * 5 / slip, 31);
  check_against_double(text, r, 1);
  const ExtendedResult grips = run_in_space(text, Rational::from_double(1.25));
  REQUIRE(grips.happenings.size() == 2);
  check_digits(grips.final.v[0], Decimal(15) / 7, 31);
  check_digits(grips.final.v[1], Decimal(-10) / 7, 31);
}

TEST_CASE("an impact whose slip turns, grips or is held is that of double, and never slides where it is sticking") {
  const auto body = [](const char* law, const char* start) {
    return fmt::format(
        "dimensionless\ncoord x, y, z, a, b : number\nT = 1/2 (x'^2 + y'^2 + z'^2) + 0.05 a'^2 + 0.1 b'^2\nV = 10 z\n"
        "contact z + 0.3 a >= 0 restitution 0.5 {} slip (x' + 0.2 a' + 0.1 b', y' + 0.3 b') name floor\nstart {}\n",
        law, start);
  };
  const char* const starts[] = {"z = 1, x' = 3, y' = 1", "z = 1, x' = 0.3, y' = -0.4", "z = 1"};
  for (const char* law : {"friction 0.1", "friction 0.4", "friction 0.4 static 0.9", "sticking"})
    for (const char* start : starts) {
      CAPTURE(law);
      CAPTURE(start);
      const std::string text = body(law, start);
      const ExtendedResult r = run_in_space(text, Rational::from_double(0.5));
      REQUIRE(r.happenings.size() == 1);
      for (const AgreedNumber& x : r.final.v) CHECK((x.digits >= 28 || std::abs(std::stod(x.text)) < 1e-28));
      check_against_double(text, r, 0.5);
    }
}

TEST_CASE("a tripod slides and turns as in double, and its rest is refused, with the reason") {
  std::string text =
      "param m = 1 kg, g = 10 m/s^2, μ = 0.2, J = 0.01 kg m^2, s = 0.1 m\ncoord x, y, z : length, φ, a, b : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (φ'^2 + a'^2 + b'^2)\nV = m g z\n";
  for (int k = 0; k < 3; ++k)
    text += fmt::format(
        "contact z + {0:.15f} s a + {1:.15f} s b >= 0 friction μ slip (x' - s φ' sin(φ + {2:.15f}), y' + s φ' cos(φ + "
        "{2:.15f})) name f{3}\n",
        std::cos(2.0943951023931953 * k), std::sin(2.0943951023931953 * k), 2.0943951023931953 * k, k + 1);
  const std::string turning = text + "start x' = 1 m/s, φ' = 5 rad/s\n";
  const ExtendedResult r = run_in_space(turning, Rational::from_double(0.25));
  CHECK(r.final.q[0].digits >= 30);
  check_against_double(turning, r, 0.25);

  ExtendedSimulationOptions options;
  options.duration = 1;
  const ExtendedResult stops = run(ModelText(text + "start x' = 1 m/s\n"), options);
  CHECK(stops.ending == Ending::Paradox);
  CHECK(stops.reason.find("statically indeterminate") != std::string::npos);
}
