// The reference of the random steep models against closed forms: a referee must be right itself.
#include <doctest/doctest.h>

#include "reference.hpp"

using namespace steep;

namespace {

Term term(Shape shape, Role role, const char* amplitude, const char* offset, const char* width) {
  Term out;
  out.shape = shape, out.role = role;
  out.amplitude = {amplitude}, out.offset = {offset}, out.width = {width};
  return out;
}

/// Both resolutions end within `tolerance` of (x, v) of coordinate 0.
void check_end(const Description& d, Quad x, Quad v) {
  const Law<Quad> fine(d);
  const Law<Long> coarse(d);
  const auto a = Reference<Quad>(fine, {1e-22, 1, 10}).run();
  const auto b = Reference<Long>(coarse, {1e-16, 0.6, 8}).run();
  REQUIRE(a.has_value());
  REQUIRE(b.has_value());
  CHECK(static_cast<double>(fabs(a->q[0] - x)) < 1e-19);
  CHECK(static_cast<double>(fabs(a->v[0] - v)) < 1e-19);
  CHECK(static_cast<double>(fabs(Quad(b->q[0]) - x)) < 1e-13);
}

Quad number(const char* text) { return parse<Quad>(text); }
Quad pi() { return acosq(Quad(-1)); }

}  // namespace

TEST_CASE("an exponential wall: exp((x − a)/d) E is the energy times sech²") {
  Description d;
  Term wall = term(Shape::Exp, Role::Potential, "0.7", "6", "0.05");
  wall.of_q[0] = 1;
  d.terms = {wall};
  d.v[0] = {"1.3"}, d.duration = {"9"};
  const Quad width = number("0.05"), height = number("0.7"), v0 = number("1.3");
  const Quad energy = v0 * v0 / 2 + height * exp(-6 / width), speed = sqrt(2 * energy);
  // x = a + d log(energy/E) − 2 d log cosh(speed (t − t₀)/2d), t₀ from x(0) = 0 and v > 0.
  const Quad at_start = acoshq(exp(3 / width) * sqrt(energy / height));
  const Quad now = speed * 9 / (2 * width) - at_start;
  check_end(d, 6 + width * logq(energy / height) - 2 * width * logq(cosh(now)), -speed * tanh(now));
}

TEST_CASE("a Gaussian pulse on a free particle: error functions") {
  Description d;
  Term pulse = term(Shape::Gauss, Role::Force, "3", "6", "0.05");
  pulse.of_t = 1;
  d.terms = {pulse};
  d.duration = {"10"};
  const Quad width = number("0.05"), after = 4 / width, before = -6 / width;
  const auto integral = [](Quad u) { return u * erfq(u) + expq(-u * u) / sqrtq(pi()); };  // of erf
  const Quad half = 3 * width * sqrtq(pi()) / 2;
  check_end(d, half * width * (integral(after) - integral(before) - erfq(before) * (after - before)),
            half * (erfq(after) - erfq(before)));
}

TEST_CASE("a smoothed friction without a spring: sinh(v/w) falls exponentially") {
  Description d;
  Term layer = term(Shape::Tanh, Role::Force, "-0.25", "0", "0.02");
  layer.of_v[0] = 1;
  d.terms = {layer};
  d.v[0] = {"0.5"}, d.duration = {"2.1"};
  const Quad width = number("0.02");
  const Quad v = width * asinhq(sinhq(number("0.5") / width) * exp(-number("0.25") * number("2.1") / width));
  const Law<Quad> law(d);
  const auto end = Reference<Quad>(law, {}).run();
  REQUIRE(end.has_value());
  CHECK(static_cast<double>(fabs(end->v[0] - v)) < 1e-20);
}

TEST_CASE("a window and a kink: pieces of parabolas") {
  Description d;
  Term window = term(Shape::Window, Role::Force, "30", "4", "0.02");
  window.of_t = 1;
  d.terms = {window};
  d.duration = {"12"};
  const Quad gained = 30 * number("0.02");
  check_end(d, gained * (number("0.01") + 12 - number("4.02")), gained);

  Description kink;
  Term potential = term(Shape::Abs, Role::Potential, "2", "0", "1");
  potential.of_q[0] = 1;
  kink.terms = {potential};
  kink.v[0] = {"1"}, kink.duration = {"4.25"};  // a period is 4 v/a = 2
  check_end(kink, number("0.1875"), number("0.5"));
}

TEST_CASE("a square wave: the velocity is a sum of pieces; a switch of time is met exactly") {
  Description d;
  Term wave = term(Shape::Square, Role::Force, "1", "0", "0.02");
  wave.of_t = 1;
  d.terms = {wave};
  d.duration = {"1"};
  // Half periods of p = 0.02 π: x = Σ over whole periods of p², then what is left.
  const Quad half = number("0.02") * pi();
  Quad x = 0, v = 0, t = 0, sign = 1;
  for (; t + half < 1; t += half, sign = -sign) x += v * half + sign * half * half / 2, v += sign * half;
  const Quad left = 1 - t;
  x += v * left + sign * left * left / 2, v += sign * left;
  check_end(d, x, v);
}

TEST_CASE("a wall that is grazed: the short time beyond the switch is not overlooked") {
  // x = 1.0001 sin t enters max(x − 1, 0) for 0.028; the momentum that it takes is seen in the energy, which is kept.
  Description d;
  Term spring = term(Shape::Harmonic, Role::Potential, "1", "0", "1"),
       wall = term(Shape::RampSquare, Role::Potential, "200", "1", "1");
  spring.of_q[0] = wall.of_q[0] = 1;
  d.terms = {spring, wall};
  d.v[0] = {"1.0001"}, d.duration = {"9"};
  const Law<Quad> law(d);
  Reference<Quad> reference(law, {});
  const auto end = reference.run();
  REQUIRE(end.has_value());
  CHECK(reference.switches() == 4);
  const Quad energy = (end->q[0] * end->q[0] + end->v[0] * end->v[0]) / 2,
             before = number("1.0001") * number("1.0001") / 2;
  CHECK(static_cast<double>(fabs(energy - before)) < 1e-20);
  // Without the wall it would be elsewhere.
  CHECK(static_cast<double>(fabs(end->q[0] - number("1.0001") * sin(Quad(9)))) > 1e-5);
}

TEST_CASE("masses coupled by c x' y' cos(x − y) keep their energy") {
  Description d;
  d.n = 2;
  d.mass[0] = {"1.5"}, d.mass[1] = {"0.8"};
  d.coupling = Coupling::Swinging, d.coupled = {"0.3"};
  d.q[0] = {"0.4"}, d.v[0] = {"1.2"}, d.v[1] = {"-0.7"}, d.duration = {"5"};
  const Law<Quad> law(d);
  const auto energy = [](const State<Quad>& s) {
    return number("0.75") * s.v[0] * s.v[0] + number("0.4") * s.v[1] * s.v[1] +
           number("0.3") * s.v[0] * s.v[1] * cos(s.q[0] - s.q[1]);
  };
  const auto end = Reference<Quad>(law, {1e-22, 0.05, 10}).run();
  REQUIRE(end.has_value());
  CHECK(static_cast<double>(fabs(energy(*end) - energy(law.start()))) < 1e-20);
}
