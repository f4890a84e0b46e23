#pragma once
#include <maupertuis/integrator.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <string>
#include <vector>

/// A system put together by hand for the tests of integrators.
struct Mechanics {
  using Expr = maupertuis::Expr;
  using Rational = maupertuis::Rational;

  maupertuis::Context context;
  maupertuis::KernelSource source;
  std::vector<double> parameters, q, v;

  Expr coordinate(const std::string& name, double position, double velocity) {
    const Expr e = context.symbol(name, maupertuis::Role::Coordinate);
    source.coordinates.push_back(e);
    q.push_back(position);
    v.push_back(velocity);
    return e;
  }
  Expr parameter(const std::string& name, double value) {
    const Expr e = context.symbol(name, maupertuis::Role::Parameter);
    source.parameters.push_back(e);
    parameters.push_back(value);
    return e;
  }
  Expr dot(Expr e) { return context.time_derivative(e); }
  Expr number(std::int64_t n, std::int64_t d = 1) { return context.number(Rational(n, d)); }
  /// L = T − V; the energy T + V becomes observable 0.
  void natural(Expr kinetic, Expr potential) {
    source.residual = maupertuis::variational_residual(kinetic - potential, source.coordinates);
    source.observables.push_back(kinetic + potential);
  }
  maupertuis::TaylorStepper stepper(const maupertuis::TaylorOptions& options = {}, double t = 0) {
    maupertuis::TaylorStepper result(maupertuis::build_kernel(source), parameters, options);
    result.start(t, q, v);
    return result;
  }
};

/// Steps to `end` or to whatever ends the run before.
inline maupertuis::Step advance(maupertuis::TaylorStepper& stepper, double end) {
  maupertuis::Step step;
  while (stepper.time() != end) {
    step = stepper.step(end);
    if (step.ending != maupertuis::StepEnding::None || step.event) break;
  }
  return step;
}

inline void build_oscillator(Mechanics& m, double x, double v) {
  const auto e = m.coordinate("x", x, v);
  m.natural(pow(m.dot(e), 2) / maupertuis::Rational(2), pow(e, 2) / maupertuis::Rational(2));
}

inline void build_kepler(Mechanics& m, double eccentricity) {
  const auto x = m.coordinate("x", 1 - eccentricity, 0);
  const auto y = m.coordinate("y", 0, std::sqrt((1 + eccentricity) / (1 - eccentricity)));
  m.natural((pow(m.dot(x), 2) + pow(m.dot(y), 2)) / maupertuis::Rational(2),
            -pow(pow(x, 2) + pow(y, 2), maupertuis::Rational(-1, 2)));
}

/// m = l = 1, g = 9.81, from points.
inline void build_double_pendulum(Mechanics& m) {
  const auto a = m.coordinate("a", 2.0, 0), b = m.coordinate("b", 2.5, 0);
  const auto g = m.parameter("g", 9.81), mass = m.parameter("m", 1), l = m.parameter("l", 1);
  const auto x1 = l * sin(a), y1 = -(l * cos(a)), x2 = x1 + l * sin(b), y2 = y1 - l * cos(b);
  const auto square = [&](maupertuis::Expr e) { return pow(m.dot(e), 2); };
  m.natural(maupertuis::Rational(1, 2) * mass * (square(x1) + square(y1)) +
                maupertuis::Rational(1, 2) * mass * (square(x2) + square(y2)),
            mass * g * y1 + mass * g * y2);
}
