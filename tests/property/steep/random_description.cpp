#include "description.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

/// Random steep models, class by class.
namespace steep {
namespace {

class Maker {
 public:
  explicit Maker(unsigned long long number) : random_(number * 0x9e3779b97f4a7c15ull + 1) {}

  Description make_core() {
    d_.units = chance(0.25);
    cores();
    return d_;
  }

  Description make() {
    d_.units = chance(0.25);
    switch (whole(0, 4)) {
      case 0:
        walls();
        break;
      case 1:
        pulses();
        break;
      case 2:
        layers();
        break;
      case 3:
        switches();
        break;
      default:
        mixed();
    }
    return d_;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double by_ratio(double low, double high) { return low * std::exp(uniform(0, 1) * std::log(high / low)); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(double p) { return uniform(0, 1) < p; }
  double sign() { return chance(0.5) ? 1 : -1; }
  static Number number(double x) { return {fmt::format("{:.4g}", x)}; }

  Term& add(Shape shape, Role role, double amplitude) {
    Term term;
    term.shape = shape, term.role = role, term.amplitude = number(amplitude);
    d_.terms.push_back(term);
    return d_.terms.back();
  }
  /// (w − offset)/width, or (w − offset)·(1/width).
  void scale(Term& term, double offset, double width) {
    term.offset = number(offset);
    term.width_multiplies = chance(0.3);
    term.width = number(term.width_multiplies ? 1 / width : width);
  }

  void masses(int n) {
    d_.n = n;
    for (int i = 0; i < n; ++i) d_.mass[i] = chance(0.4) ? Number{"1"} : number(uniform(0.5, 3));
    if (n < 2 || chance(0.6)) return;
    d_.coupling = d_.units || chance(0.5) ? Coupling::Constant : Coupling::Swinging;
    d_.coupled = number(uniform(0.1, 0.4));
  }

  void oscillator(int i, double low = 0.3, double high = 4) {
    Term& term = add(Shape::Harmonic, Role::Potential, uniform(low, high));
    term.of_q[i] = 1;
  }
  void spring(int i, int j) {
    Term& term = add(Shape::Harmonic, Role::Potential, uniform(0.2, 2));
    term.of_q[i] = -1, term.of_q[j] = 1;
  }
  void damper(int i) {
    Term& term = add(Shape::Harmonic, Role::Dissipation, uniform(0.02, 0.3));
    term.of_v[i] = 1;
  }
  void start(double q, double v) {
    for (int i = 0; i < d_.n; ++i) {
      if (chance(0.7)) d_.q[i] = number(uniform(-q, q));
      if (chance(0.5)) d_.v[i] = number(uniform(-v, v));
    }
  }

  /// One to three coordinates, free, bound, coupled, damped: what pulses and switches act on.
  void bystander() {
    masses(whole(1, 3));
    for (int i = 0; i < d_.n; ++i) {
      if (chance(0.7)) oscillator(i);
      if (chance(0.15)) damper(i);
      if (i > 0 && chance(0.5)) spring(i - 1, i);
    }
    start(1, 1);
  }

  // ---- walls ----

  /// Coordinate 0 runs free with speed v from 0 towards `distance`; others are bound.
  double runner(double distance) {
    masses(whole(1, 2));
    const double v = uniform(0.4, 1.5);
    d_.v[0] = number(v);
    if (d_.n == 2) oscillator(1), d_.q[1] = number(uniform(-1, 1));
    if (d_.coupling == Coupling::Swinging) d_.coupling = Coupling::Constant;
    d_.duration = number(distance / v * uniform(1.4, 2.2));
    return v;
  }

  void wall_on_the_way(Shape shape, double amplitude, double width, int side) {
    const double distance = uniform(2, 12);
    runner(distance);
    Term& term = add(shape, Role::Potential, amplitude);
    term.of_q[0] = side;
    scale(term, side * distance, width);
    if (shape == Shape::Exp && !d_.units && chance(0.2)) term.of_t = 1;  // it comes nearer
  }

  void falling_ball() {
    masses(1);
    const double height = uniform(0.3, 2), g = chance(0.5) ? 9.81 : uniform(1, 10);
    Term& weight = add(Shape::One, Role::Force, 1);
    weight.amplitude = number(-g * std::stod(d_.mass[0].text));
    Term& floor = add(Shape::Exp, Role::Potential, uniform(0.2, 2));
    floor.of_q[0] = -1;
    scale(floor, 0, by_ratio(0.003, 0.1));
    d_.q[0] = number(height);
    d_.duration = number(std::sqrt(2 * height / g) * uniform(1.3, 6));
  }

  void molecules() {
    masses(1);
    const double r = uniform(5, 25), v = uniform(0.5, 1.5);
    Term& term = add(Shape::LennardJones, Role::Potential, uniform(0.3, 2));
    term.of_q[0] = 1;
    scale(term, 0, uniform(0.5, 1.5));
    d_.q[0] = number(r), d_.v[0] = number(-v);
    d_.duration = number(r / v * uniform(1.1, 1.7));
  }

  void high_power() {
    masses(whole(1, 2));
    for (int i = 0; i < d_.n; ++i) {
      Term& term = add(Shape::Power, Role::Potential, uniform(0.3, 2));
      term.extra = {fmt::format("{}", 2 * whole(5, 30))};
      term.of_q[i] = 1;
      scale(term, 0, uniform(1, 5));
    }
    start(0.5, 1);
    d_.v[0] = number(uniform(0.5, 1.5));
    d_.duration = number(uniform(3, 15));
  }

  void washboard() {
    masses(1);
    Term& term = add(Shape::Comb, Role::Potential, uniform(-0.05, 0.05));
    term.of_q[0] = 1, term.extra = number(by_ratio(10, 100));
    scale(term, 0, uniform(0.1, 0.4));
    d_.q[0] = number(uniform(0.2, 0.6)), d_.v[0] = number(uniform(0.5, 1));
    d_.duration = number(uniform(4, 12));
  }

  void round_hill(Shape shape) {
    masses(2);
    d_.coupling = Coupling::None;
    Term& term = add(shape, Role::Potential, shape == Shape::Plummer ? by_ratio(0.2, 5) : uniform(-2, 3));
    const double distance = shape == Shape::Plummer ? 0 : uniform(3, 12), v = uniform(0.5, 1.5);
    term.of_q[0] = term.of_q[1] = 1;
    term.centre[0] = number(distance), term.centre[1] = number(shape == Shape::Plummer ? 0 : uniform(-0.3, 0.3));
    term.width = number(shape == Shape::Plummer ? by_ratio(0.02, 0.2) : by_ratio(0.1, 0.6));
    if (shape == Shape::Plummer) {
      oscillator(0, 0.5, 1.5), oscillator(1, 0.5, 1.5);
      d_.q[0] = number(uniform(0.5, 1.5)), d_.v[1] = number(uniform(0.1, 0.5));
      d_.duration = number(uniform(3, 9));
    } else {
      d_.v[0] = number(v);
      d_.duration = number(distance / v * uniform(1.3, 2));
    }
  }

  void masses_on_a_line() {
    masses(whole(2, 3));
    if (d_.coupling == Coupling::Swinging) d_.coupling = Coupling::None;
    for (int i = 1; i < d_.n; ++i) {
      Term& term = add(Shape::Exp, Role::Potential, uniform(0.3, 2));
      term.of_q[i - 1] = 1, term.of_q[i] = -1;
      scale(term, 0, by_ratio(0.02, 0.3));
      d_.q[i] = number(3.5 * i + uniform(0, 1));
    }
    d_.v[0] = number(uniform(0.6, 1.5));
    d_.duration = number(uniform(6, 14));
  }

  void soft_pen() {
    masses(whole(1, 2));
    const double stiffness = by_ratio(20, 1000);
    for (int i = 0; i < d_.n; ++i)
      for (const int side : {1, -1}) {
        Term& term = add(Shape::RampSquare, Role::Potential, stiffness);
        term.of_q[i] = side, term.offset = number(uniform(0.8, 2));
      }
    start(0.5, 1);
    d_.v[0] = number(uniform(0.5, 1.5));
    d_.duration = number(uniform(4, 14));
  }

  void round_pen() {
    masses(2);
    d_.coupling = Coupling::None;
    Term& term = add(Shape::RoundPen, Role::Potential, by_ratio(20, 500));
    term.of_q[0] = term.of_q[1] = 1, term.width = number(uniform(0.8, 2));
    d_.q[0] = number(uniform(-0.4, 0.4)), d_.v[0] = number(uniform(0.5, 1.5)), d_.v[1] = number(uniform(-0.6, 0.6));
    d_.duration = number(uniform(3, 10));
  }

  void kink() {
    masses(1);
    Term& term = add(Shape::Abs, Role::Potential, uniform(0.2, 2));
    term.of_q[0] = 1;
    scale(term, uniform(-1, 1), uniform(0.5, 2));
    d_.v[0] = number(uniform(0.5, 1.5));
    d_.duration = number(uniform(3, 10));
  }

  void walls() {
    d_.kind = "walls";
    const int side = chance(0.5) ? 1 : -1;
    switch (whole(0, 13)) {
      case 0:
      case 1:
        return wall_on_the_way(Shape::Exp, uniform(0.3, 2), by_ratio(0.02, 0.5), 1);
      case 2:
        return falling_ball();
      case 3:
        return molecules();
      case 4:
        return wall_on_the_way(Shape::Gauss, uniform(-1, 2), by_ratio(0.05, 1), side);
      case 5:
        return wall_on_the_way(Shape::TanhStep, uniform(-1, 2), by_ratio(0.03, 0.5), side);
      case 6:
        return wall_on_the_way(Shape::Lorentz, uniform(-0.5, 0.5), by_ratio(0.05, 0.5), side);
      case 7:
        return high_power();
      case 8:
        return washboard();
      case 9:
        return round_hill(chance(0.5) ? Shape::Plummer : Shape::RoundGauss);
      case 10:
        return masses_on_a_line();
      case 11:
        return soft_pen();
      case 12:
        return round_pen();
      default:
        return kink();
    }
  }

  // ---- cores ----

  /// A body that swings through the origin on a straight line, with a small core on its way: the swing has all of the
  /// coefficients, and nothing of the core shows in them.
  void core_on_a_swing() {
    constexpr double slope = 0.5, exponents[] = {1, 1.5, 3, 6, 12};
    d_.n = 2;
    const double amplitude = uniform(0.8, 1.5), rate = uniform(0.7, 1.5), part = uniform(0.3, 0.9);
    for (int i = 0; i < 2; ++i) {
      Term& swing = add(Shape::Harmonic, Role::Potential, rate * rate);
      swing.of_q[i] = 1;
      d_.v[i] = number((i == 0 ? 1 : slope) * amplitude * rate);
    }
    const double width = by_ratio(3e-4, 1e-2);
    Term& core = add(Shape::Core, Role::Potential, by_ratio(0.01, 1));
    core.of_q[0] = core.of_q[1] = 1;
    core.extra = number(exponents[whole(0, 4)]);
    core.width = number(width);
    core.centre[0] = number(part * amplitude);
    core.centre[1] = number(slope * part * amplitude + uniform(-0.5, 0.5) * width);
    d_.duration = number(std::asin(part) / rate * uniform(1.2, 2));
  }

  /// A body in the plane, aimed at one to three cores far away or near, of any hardness and strength, that attract or
  /// repel.
  void cores() {
    d_.kind = "cores";
    if (chance(0.4)) return core_on_a_swing();
    masses(2);
    d_.coupling = Coupling::None;
    const double v = uniform(0.3, 2);
    double farthest = 0;
    for (int k = whole(1, 3); k > 0; --k) {
      constexpr double exponents[] = {0.5, 0.5, 1, 1.5, 3, 6, 12};
      const double exponent = exponents[whole(0, 6)], width = by_ratio(0.003, 0.3), distance = by_ratio(0.7, 12);
      const bool attracts = exponent == 0.5 && chance(0.6);
      Term& term = add(Shape::Core, Role::Potential, attracts ? -by_ratio(0.3, 30) : by_ratio(1e-6, 3));
      term.of_q[0] = term.of_q[1] = 1;
      term.extra = number(exponent);
      term.width = number(width);
      term.centre[0] = number(distance);
      term.centre[1] = number((attracts ? sign() * uniform(0.5, 4) : uniform(-1.5, 1.5)) * width);
      farthest = std::max(farthest, distance);
    }
    if (chance(0.3)) oscillator(0, 0.01, 0.1);
    if (chance(0.3)) oscillator(1);
    d_.v[0] = number(v);
    d_.duration = number(farthest / v * uniform(1.2, 2));
  }

  // ---- pulses ----

  void pulse(int target) {
    const double t0 = by_ratio(1, 40), width = by_ratio(0.01, 0.5), strength = sign() * uniform(0.1, 1);
    constexpr Shape shapes[] = {Shape::Gauss,    Shape::Sech2,  Shape::TanhStep, Shape::Lorentz,
                                Shape::Logistic, Shape::Window, Shape::Gauss};
    const Shape shape = shapes[whole(0, 6)];
    const bool lasting = shape == Shape::TanhStep || shape == Shape::Logistic;
    Term& term = add(shape, Role::Force, lasting ? strength : strength / width);
    term.target = target, term.of_t = 1;
    scale(term, t0, width);
    d_.duration = number(std::max(std::stod(d_.duration.text), t0 + uniform(1, 6)));
  }

  void pulse_train(int target) {
    Term& term = add(Shape::Comb, Role::Force, uniform(0.2, 2));
    term.target = target, term.of_t = 1, term.extra = number(by_ratio(30, 500));
    scale(term, uniform(-2, 2), uniform(0.7, 2));
    d_.duration = number(uniform(8, 25));
  }

  void moving_pivot() {
    d_.pivot_moves = true;
    d_.units = true;
    d_.n = 1;
    const double t0 = uniform(2, 8);
    d_.pivot = {number(uniform(0.5, 2)),    number(uniform(0.3, 1)), {"9.81"}, number(uniform(0.02, 0.1)), number(t0),
                number(by_ratio(0.01, 0.1))};
    d_.q[0] = number(chance(0.5) ? 0 : uniform(-0.5, 0.5));
    d_.duration = number(t0 + uniform(1, 3));
  }

  void pulses() {
    d_.kind = "pulses";
    if (chance(0.1)) return moving_pivot();
    bystander();
    if (chance(0.2)) return pulse_train(whole(0, d_.n - 1));
    for (int k = whole(1, 2); k > 0; --k) pulse(whole(0, d_.n - 1));
  }

  // ---- layers ----

  void friction(int i) {
    const double strength = uniform(0.05, 0.5), width = by_ratio(0.004, 0.1);
    const int which = whole(0, 4);
    if (which >= 3) {
      Term& term = add(which == 3 ? Shape::LogCosh : Shape::Root, Role::Dissipation, strength * width);
      term.of_v[i] = 1, term.width = number(width);
      return;
    }
    Term& term = add(which == 0 ? Shape::Tanh : which == 1 ? Shape::Stribeck : Shape::Coulomb, Role::Force, -strength);
    term.of_v[i] = 1, term.target = i;
    if (which == 1) term.extra = number(uniform(0.1, 0.6));
    scale(term, chance(0.4) ? uniform(-0.4, 0.4) : 0, width);
  }

  void pull(int i) {
    Term& term = add(Shape::Cosine, Role::Force, uniform(0.2, 1));
    term.of_t = 1, term.target = i;
    scale(term, 0, uniform(0.4, 1.5));
  }

  void layers() {
    d_.kind = "layers";
    if (chance(0.2)) {
      masses(2);
      d_.coupling = Coupling::None;
      oscillator(0, 1, 10), oscillator(1, 1, 10);
      const double width = by_ratio(0.004, 0.1);
      Term& term = add(Shape::RoundRoot, Role::Dissipation, uniform(0.1, 0.5) * width);
      term.of_v[0] = term.of_v[1] = 1, term.width = number(width);
    } else {
      masses(whole(1, 2));
      for (int i = 0; i < d_.n; ++i) {
        oscillator(i, 0.5, 10);
        if (i == 0 || chance(0.5)) friction(i);
        if (chance(0.4)) pull(i);
      }
    }
    start(1, 1);
    if (d_.q[0].zero()) d_.q[0] = number(uniform(0.3, 1));
    d_.duration = number(uniform(2, 8));
  }

  // ---- switches ----

  void switched(int target) {
    constexpr Shape of_time[] = {Shape::Square,    Shape::Pwm,    Shape::Clip,
                                 Shape::Rectified, Shape::Nested, Shape::Window};
    constexpr Shape of_place[] = {Shape::Gate, Shape::Jump, Shape::Saturation, Shape::Ramp};
    const bool time = chance(0.65);
    const Shape shape = time ? of_time[whole(0, 5)] : of_place[whole(0, 3)];
    const bool restoring = shape == Shape::Saturation || shape == Shape::Ramp || shape == Shape::Jump;
    Term& term = add(shape, Role::Force, (restoring ? -1 : sign()) * uniform(0.2, 2));
    term.target = target;
    if (shape == Shape::Pwm) term.extra = number(uniform(-0.8, 0.8));
    if (time) {
      term.of_t = 1;
      const bool waves = shape != Shape::Nested && shape != Shape::Window;
      scale(term, uniform(-1, 2), waves ? by_ratio(0.01, 0.2) : by_ratio(0.05, 1));
    } else {
      term.of_q[target] = 1;
      scale(term, uniform(-0.5, 0.5), by_ratio(0.05, 0.5));
    }
  }

  void switches() {
    d_.kind = "switches";
    bystander();
    if (d_.coupling == Coupling::Swinging) d_.coupling = Coupling::None;
    d_.duration = number(uniform(3, 9));
    for (int k = whole(1, 2); k > 0; --k) switched(whole(0, d_.n - 1));
  }

  /// A wall or a layer with pulses or switches.
  void mixed() {
    if (chance(0.5))
      walls();
    else
      layers();
    d_.kind = "mixed";
    const std::string duration = d_.duration.text;
    if (chance(0.5))
      switched(whole(0, d_.n - 1));
    else
      pulse(whole(0, d_.n - 1));
    d_.duration = {fmt::format("{:.4g}", std::min(std::stod(d_.duration.text), 2 * std::stod(duration)))};
  }

  std::mt19937_64 random_;
  Description d_;
};

}  // namespace

Description random_description(unsigned long long number) {
  return number >= first_core ? Maker(number).make_core() : Maker(number).make();
}

}  // namespace steep
