#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <string>

// The motion that a workspace finds must satisfy the equations: the residual, written out by the chain rule and
// evaluated along the motion as an independent function, vanishes at every order.

namespace {

using namespace maupertuis;

struct System {
  Context context;
  KernelSource source;
  std::vector<double> parameters, q, v;

  Expr coordinate(const std::string& name, double position, double velocity) {
    const Expr e = context.symbol(name, Role::Coordinate);
    source.coordinates.push_back(e);
    q.push_back(position);
    v.push_back(velocity);
    return e;
  }
  Expr parameter(const std::string& name, double value) {
    const Expr e = context.symbol(name, Role::Parameter);
    source.parameters.push_back(e);
    parameters.push_back(value);
    return e;
  }
  Expr dot(Expr e) { return context.time_derivative(e); }
  void from_lagrangian(Expr lagrangian) { source.residual = variational_residual(lagrangian, source.coordinates); }
};

void check_motion(System& system, int order, double tolerance) {
  const auto written_out = expand_time_derivatives(system.source.residual);
  for (const Expr& r : written_out) system.source.events.push_back(r);
  KernelWorkspace work(build_kernel(system.source), order);
  work.set_parameters(system.parameters);
  REQUIRE(work.expand(0.3, system.q, system.v) == KernelStatus::Ok);
  for (std::size_t j = 0; j < system.q.size(); ++j) CHECK(work.coordinate(1)[j] == system.v[j]);
  for (std::size_t i = 0; i < written_out.size(); ++i) {
    double size = 1;
    for (int k = 0; k < order; ++k) {
      for (std::size_t j = 0; j < system.q.size(); ++j)
        size = std::max(size, std::abs(work.coordinate(k + 2)[j]) * (k + 1) * (k + 2));
      CAPTURE(i);
      CAPTURE(k);
      CHECK(std::abs(work.event(i, k)) <= tolerance * size * (k + 1));
    }
  }
}

}  // namespace

TEST_CASE("chains of pendulums from points satisfy their equations at every order") {
  for (const int links : {1, 2, 3, 5, 8, 9, 12}) {
    CAPTURE(links);
    System s;
    const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), g = s.parameter("g", 9.81);
    Expr x = s.context.number(0), y = s.context.number(0), lagrangian = s.context.number(0);
    for (int i = 0; i < links; ++i) {
      const Expr angle = s.coordinate("a" + std::to_string(i), 0.3 + 0.4 * i, 0.5 - 0.1 * i);
      x = x + l * sin(angle);
      y = y - l * cos(angle);
      lagrangian = lagrangian + Rational(1, 2) * m * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) - m * g * y;
    }
    s.from_lagrangian(lagrangian);
    check_motion(s, 12, 1e-12);
  }
}

TEST_CASE("chains of rods with their centres, damped, on a shaken support: running sums that begin in any lane") {
  for (const int links : {17, 18, 20, 23, 25}) {
    CAPTURE(links);
    System s;
    const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), c = s.parameter("c", 0.2);
    const Expr half = s.context.number(Rational(1, 2)), t = s.context.time();
    Expr x = sin(t * Rational(3)) * Rational(1, 5), y = s.context.number(0), lagrangian = s.context.number(0);
    for (int i = 0; i < links; ++i) {
      const Expr angle = s.coordinate("a" + std::to_string(i), 0.3 + 0.1 * i, 0.5 - 0.03 * i);
      const Expr across = x + half * l * sin(angle), down = y - half * l * cos(angle);
      x = x + l * sin(angle);
      y = y - l * cos(angle);
      lagrangian = lagrangian + half * m * (pow(s.dot(across), 2) + pow(s.dot(down), 2)) +
                   half * m * Rational(1, 10) * pow(s.dot(angle), 2) - m * Rational(981, 100) * down;
    }
    s.from_lagrangian(lagrangian);
    for (std::size_t i = 0; i < s.source.coordinates.size(); ++i)
      s.source.residual[i] = s.source.residual[i] + c * s.dot(s.source.coordinates[i]);
    check_motion(s, 6, 1e-12);
  }
}

TEST_CASE("running sums of coordinates: without a leaf 1, with an operand twice, and with constants") {
  for (const int which : {0, 1, 2}) {
    CAPTURE(which);
    System s;
    const Expr c = s.parameter("c", 0.6);
    for (int i = 0; i < 17; ++i) s.coordinate("q" + std::to_string(i), 0.1 * (i + 1), 0.2 - 0.03 * i);
    const auto& q = s.source.coordinates;
    Expr sum = s.context.number(0);
    for (std::size_t i = 0; i < 17; ++i) {
      if (which == 1 && i == 6) sum = sum + c * q[0], sum = sum + q[0];
      if (which == 2 && i == 6) sum = sum + Rational(1, 7) + q[6], sum = sum - (q[7] + Rational(2, 7));
      sum = sum + q[i];
      s.source.residual.push_back(s.context.symbol("q" + std::to_string(i), Role::Coordinate, 2) + sum +
                                  (which > 0 && i == 0 ? Rational(1) : Rational(0)));
    }
    check_motion(s, 8, 1e-13);
  }
}

TEST_CASE("quotients and roots of some lanes of a vector, beside coordinates in the others") {
  for (const int members : {3, 5, 7}) {
    System s;
    for (int i = 0; i < 17; ++i) {
      const std::string name = "q" + std::to_string(i);
      const Expr q = s.coordinate(name, 0.5, 0.25), two = s.context.number(2);
      const Expr force = i >= members   ? q
                         : members == 3 ? q / (two + q)
                         : members == 5 ? sqrt(two + q)
                                        : apply(Kind::Log, two + q);
      s.source.residual.push_back(s.context.symbol(name, Role::Coordinate, 2) + force);
    }
    check_motion(s, 8, 1e-13);
  }
}

TEST_CASE("pendulums on a cart, on an ellipse, and on a turning arm satisfy their equations at every order") {
  for (const int which : {0, 1, 2, 3}) {
    CAPTURE(which);
    System s;
    const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), g = s.parameter("g", 9.81);
    const Expr a = s.coordinate("a", 0.4, 0.9), b = s.coordinate("b", -0.2, 0.5);
    const Expr turned = which == 2 ? a + b : which == 3 ? a * b : a;
    const Expr x = l * sin(turned) + (which == 2 ? s.context.number(0) : which == 3 ? sin(b) : b);
    const Expr y = (which == 1 ? -Rational(2) * l : -l) * cos(turned);
    s.from_lagrangian(Rational(1, 2) * m * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) + pow(s.dot(b), 2) - m * g * y);
    check_motion(s, 12, 1e-12);
  }
}

TEST_CASE("functions beside stored accelerations: corrections keep to their rows") {
  System s;
  const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), two = s.context.number(2);
  const Expr x = s.coordinate("x", 0.4, 0.3), y = s.coordinate("y", 0.19, 0.63), z = s.coordinate("z", -0.22, 0.74);
  const Expr w = x - m * z, potential = x / (two + y * y) + l * apply(Kind::Log, two + w * w) * y;
  s.from_lagrangian(Rational(1, 2) * (m * pow(s.dot(x), 2) + pow(s.dot(y), 2) + m * pow(s.dot(z), 2)) -
                    Rational(1, 2) * potential);
  s.source.residual[0] = s.source.residual[0] + Rational(1, 3) * pow(s.dot(z), 3);
  check_motion(s, 12, 1e-12);
}

TEST_CASE("a moving support, a magnetic term and a mass that depends on the velocity") {
  System s;
  const Expr m = s.parameter("m", 1.5), w = s.parameter("w", 2.5), c = s.parameter("c", 3.0), b = s.parameter("B", 0.4);
  const Expr t = s.context.time();
  const Expr x = s.coordinate("x", 0.3, 0.2), y = s.coordinate("y", -0.4, 0.6);
  const Expr support = sin(w * t) * apply(Kind::Exp, -t);
  const Expr px = s.dot(x + support), py = s.dot(y);
  const Expr relativistic = -m * pow(c, 2) * sqrt(s.context.number(1) - (pow(px, 2) + pow(py, 2)) / pow(c, 2));
  const Expr lagrangian = relativistic + b * (x * py - y * px) - Rational(1, 2) * (pow(x, 2) + pow(x, 4)) -
                          apply(Kind::Log, pow(y, 2) + Rational(2));
  s.from_lagrangian(lagrangian);
  check_motion(s, 12, 1e-10);
}

TEST_CASE("coordinates whose equation holds no acceleration give a singular mass matrix with the coordinate's index") {
  System s;
  const Expr x = s.coordinate("x", 1, 0), y = s.coordinate("y", 1, 0);
  s.from_lagrangian(Rational(1, 2) * pow(s.dot(x), 2) - pow(x, 2) - pow(y, 2));
  KernelWorkspace work(build_kernel(s.source), 8);
  CHECK(work.expand(0, s.q, s.v) == KernelStatus::SingularMass);
  CHECK(work.singular_coordinate() == 1);
}

TEST_CASE("an indefinite mass matrix with zero diagonal is solved") {
  System s;  // Bateman: L = x' y' + (x y' − x' y)/5 − x y
  const Expr x = s.coordinate("x", 1, 0.5), y = s.coordinate("y", 0.3, -0.2);
  s.from_lagrangian(s.dot(x) * s.dot(y) + (x * s.dot(y) - s.dot(x) * y) / Rational(5) - x * y);
  check_motion(s, 12, 1e-13);
}

TEST_CASE("units do not make a mass matrix singular") {
  System s;
  const Expr x = s.coordinate("x", 1e-9, 0), y = s.coordinate("y", 1, 0);
  s.from_lagrangian(Rational::parse("1e-24").value() * pow(s.dot(x), 2) +
                    Rational::parse("1e12").value() * pow(s.dot(y), 2) - pow(y, 2));
  KernelWorkspace work(build_kernel(s.source), 8);
  CHECK(work.expand(0, s.q, s.v) == KernelStatus::Ok);
}

TEST_CASE("no freedoms: functions of time alone") {
  Context context;
  KernelSource source;
  source.observables = {sin(context.time())};
  source.integrands = {context.time()};
  KernelWorkspace work(build_kernel(source), 4);
  REQUIRE(work.expand(0.5, {}, {}) == KernelStatus::Ok);
  CHECK(work.observable(0) == std::sin(0.5));
  CHECK(work.integrand(0, 0) == 0.5);
  CHECK(work.integrand(0, 1) == 1);
}

TEST_CASE("an entry of M without a counterpart counts, however small it is") {
  // x'' = 1 moves y, z, … as little as ε, and they are moved by nothing else. Up to 16 unknowns by an inverse, beyond
  // by factors.
  for (const int followers : {1, 7, 15, 20})
    for (const double size : {1e-3, 1e-9, 1e-12, 1e-15, 1e-18}) {
      CAPTURE(followers);
      CAPTURE(size);
      System s;
      const Expr x = s.coordinate("x", 0, 0), epsilon = s.parameter("ε", size);
      s.source.residual.push_back(s.dot(s.dot(x)) - Rational(1));
      for (int i = 1; i <= followers; ++i) {
        const Expr y = s.coordinate("y" + std::to_string(i), 0, 0);
        s.source.residual.push_back(Rational(i) * s.dot(s.dot(y)) + epsilon * s.dot(s.dot(x)));
      }
      KernelWorkspace work(build_kernel(s.source), 4);
      work.set_parameters(s.parameters);
      REQUIRE(work.expand(0, s.q, s.v) == KernelStatus::Ok);
      CHECK(work.acceleration(0) == doctest::Approx(1).epsilon(1e-15));
      for (int i = 1; i <= followers; ++i)
        CHECK(work.acceleration(static_cast<std::size_t>(i)) * i / size == doctest::Approx(-1).epsilon(1e-14));
    }
}
