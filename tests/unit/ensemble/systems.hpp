#pragma once
#include <maupertuis/ensemble.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

/// The input of an ensemble, with its arrays.
struct Trajectories {
  std::size_t n = 0;
  std::vector<double> q, v, parameters, begin, end, times;

  std::size_t count() const { return q.size() / n; }
  maupertuis::EnsembleStart start() const { return {q, v, parameters, begin, end, times}; }
  std::span<const double> q_of(std::size_t i) const { return {q.data() + i * n, n}; }
  std::span<const double> v_of(std::size_t i) const { return {v.data() + i * n, n}; }

  void add(const std::vector<double>& position, const std::vector<double>& velocity, double duration) {
    n = position.size();
    q.insert(q.end(), position.begin(), position.end());
    v.insert(v.end(), velocity.begin(), velocity.end());
    end.push_back(duration);
  }
};

struct System {
  maupertuis::Context context;
  maupertuis::KernelSource source;

  maupertuis::Expr coordinate(const std::string& name) {
    source.coordinates.push_back(context.symbol(name, maupertuis::Role::Coordinate));
    return source.coordinates.back();
  }
  maupertuis::Expr parameter(const std::string& name) {
    source.parameters.push_back(context.symbol(name, maupertuis::Role::Parameter));
    return source.parameters.back();
  }
  maupertuis::Expr rate_squared(maupertuis::Expr e) { return pow(context.time_derivative(e), 2); }
  /// L = T − V; T and V become the first observables, the energy their sum.
  maupertuis::Kernel natural(maupertuis::Expr kinetic, maupertuis::Expr potential) {
    source.residual = maupertuis::variational_residual(kinetic - potential, source.coordinates);
    source.observables = {kinetic, potential};
    return maupertuis::build_kernel(source);
  }
};

inline maupertuis::Kernel double_pendulum() {
  System s;
  const auto a = s.coordinate("a"), b = s.coordinate("b"), g = s.parameter("g"), l = s.parameter("l");
  const auto x1 = l * sin(a), y1 = -(l * cos(a)), x2 = x1 + l * sin(b), y2 = y1 - l * cos(b);
  const maupertuis::Rational half(1, 2);
  return s.natural(half * (s.rate_squared(x1) + s.rate_squared(y1) + s.rate_squared(x2) + s.rate_squared(y2)),
                   g * (y1 + y2));
}

/// Kepler's problem, attracted by 1/r.
inline maupertuis::Kernel kepler() {
  System s;
  const auto x = s.coordinate("x"), y = s.coordinate("y");
  return s.natural(maupertuis::Rational(1, 2) * (s.rate_squared(x) + s.rate_squared(y)),
                   -pow(pow(x, 2) + pow(y, 2), maupertuis::Rational(-1, 2)));
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
