#pragma once
#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/lanes.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

// Systems that between them have every instruction, and the comparison of their lanes with the reference interpreter.

namespace {

using namespace maupertuis;

constexpr int order = 12;
[[maybe_unused]] constexpr int widths[] = {1, 2, 4, 8, 16};

struct Motion {
  double t = 0;
  std::vector<double> q, v, parameters;
};

struct System {
  std::string name;
  Context context;
  KernelSource source;
  Motion start;

  Expr coordinate(const std::string& word, double position, double velocity) {
    source.coordinates.push_back(context.symbol(word, Role::Coordinate));
    start.q.push_back(position);
    start.v.push_back(velocity);
    return source.coordinates.back();
  }
  Expr parameter(const std::string& word, double value) {
    source.parameters.push_back(context.symbol(word, Role::Parameter));
    start.parameters.push_back(value);
    return source.parameters.back();
  }
  Expr dot(Expr e) { return context.time_derivative(e); }
  Expr acceleration(const std::string& word) { return context.symbol(word, Role::Coordinate, 2); }
  void from_lagrangian(Expr lagrangian) { source.residual = variational_residual(lagrangian, source.coordinates); }
};

using Systems = std::vector<std::unique_ptr<System>>;

System& add(Systems& list, const std::string& name) {
  list.push_back(std::make_unique<System>());
  list.back()->name = name;
  return *list.back();
}

/// A particle under the force f(q + q²/3), and f as its inertia beside it, so that tangents go through f as well.
void add_function(Systems& list, const std::string& name, double q0, const std::function<Expr(Expr)>& f) {
  System& s = add(list, name);
  const Expr q = s.coordinate("q", q0, 0.4), r = s.coordinate("r", 0.2, -0.3), c = s.parameter("c", 0.7);
  const Expr u = q + q * q / Rational(3), rate = s.dot(f(u));
  s.from_lagrangian(Rational(1, 2) * pow(s.dot(q), 2) + Rational(1, 2) * pow(s.dot(r) + rate, 2) -
                    c * f(u) * (r + Rational(2)));
}

void add_functions(Systems& list) {
  const auto kind = [&](Kind k, const std::string& name, double q0) {
    add_function(list, name, q0, [k](Expr u) { return apply(k, u); });
  };
  kind(Kind::Sin, "sin", 0.7), kind(Kind::Cos, "cos", 0.7), kind(Kind::Tan, "tan", 0.4), kind(Kind::Asin, "asin", 0.3);
  kind(Kind::Acos, "acos", 0.3), kind(Kind::Atan, "atan", 0.6), kind(Kind::Sinh, "sinh", 0.7),
      kind(Kind::Cosh, "cosh", 0.7);
  kind(Kind::Tanh, "tanh", 0.5), kind(Kind::Asinh, "asinh", 0.5), kind(Kind::Acosh, "acosh", 1.5);
  kind(Kind::Atanh, "atanh", 0.3), kind(Kind::Exp, "exp", 0.9), kind(Kind::Log, "log", 1.1),
      kind(Kind::Erf, "erf", 0.5);
  kind(Kind::LambertW, "lambert_w", 0.6);
  for (const auto& [p, d] : std::vector<std::pair<int, int>>{{2, 1}, {5, 1}, {-1, 1}, {-3, 1}, {1, 2}, {-3, 2}})
    add_function(list, "power " + std::to_string(p) + "/" + std::to_string(d), 0.9,
                 [p = p, d = d](Expr u) { return pow(u, Rational(p, d)); });
  add_function(list, "quotient", 0.6, [](Expr u) { return sin(u) / (u + Rational(2)); });
  add_function(list, "power of itself", 0.9, [](Expr u) { return u.context().power(u, u); });
}

void add_chain(Systems& list, int links) {
  System& s = add(list, "chain of " + std::to_string(links));
  const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), g = s.parameter("g", 9.81);
  Expr x = s.context.number(0), y = s.context.number(0), lagrangian = s.context.number(0);
  for (int i = 0; i < links; ++i) {
    const Expr angle = s.coordinate("a" + std::to_string(i), 0.3 + 0.4 * i, 0.5 - 0.1 * i);
    x = x + l * sin(angle);
    y = y - l * cos(angle);
    lagrangian = lagrangian + Rational(1, 2) * m * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) - m * g * y;
  }
  s.from_lagrangian(lagrangian);
}

void add_driven(Systems& list) {
  System& s = add(list, "moving support");
  const Expr m = s.parameter("m", 1.5), w = s.parameter("w", 2.5), c = s.parameter("c", 3.0), b = s.parameter("B", 0.4);
  const Expr t = s.context.time();
  const Expr x = s.coordinate("x", 0.3, 0.2), y = s.coordinate("y", -0.4, 0.6);
  const Expr px = s.dot(x + sin(w * t) * apply(Kind::Exp, -t)), py = s.dot(y);
  s.from_lagrangian(-m * pow(c, 2) * sqrt(s.context.number(1) - (pow(px, 2) + pow(py, 2)) / pow(c, 2)) +
                    b * (x * py - y * px) - Rational(1, 2) * (pow(x, 2) + pow(x, 4)) -
                    apply(Kind::Log, pow(y, 2) + Rational(2)));
  s.start.t = 0.3;
}

/// A formula that a parameter selects.
void add_selection(Systems& list, double k) {
  System& s = add(list, "selection " + std::to_string(k));
  const Expr x = s.coordinate("x", 0.5, 0.2), y = s.coordinate("y", 0.7, 0.1), p = s.parameter("k", k);
  const auto call = [&](Kind kind, const std::vector<Expr>& arguments) { return s.context.function(kind, arguments); };
  const Expr choice = call(Kind::Piecewise, {call(Kind::Less, {p, s.context.number(0)}), sqrt(x), sin(x) + y * x});
  s.from_lagrangian(pow(s.dot(x), 2) + pow(s.dot(y), 2) + pow(s.dot(choice), 2) - choice);
}

/// The operand that is not in force has no value.
void add_undefined_operand(Systems& list) {
  System& s = add(list, "undefined operand");
  const Expr x = s.coordinate("x", -0.5, 0.2), p = s.parameter("k", 1);
  const auto call = [&](Kind kind, const std::vector<Expr>& arguments) { return s.context.function(kind, arguments); };
  const Expr choice = call(Kind::Piecewise, {call(Kind::Less, {p, s.context.number(0)}), sqrt(x), sin(x)});
  s.source.residual = {s.acceleration("x") + s.dot(s.dot(choice)) / Rational(3) + choice};
}

/// Two pendulums with friction between them: sums of velocities beside accelerations.
void add_friction(Systems& list) {
  System& s = add(list, "friction");
  const Expr x = s.coordinate("x", 0.7, -0.4), y = s.coordinate("y", -0.3, 0.9), c = s.parameter("c", 0.6);
  s.source.residual = {s.acceleration("x") + c * (s.dot(x) - s.dot(y)) + sin(x),
                       2 * s.acceleration("y") + c * (s.dot(y) - s.dot(x)) + sin(y)};
}

/// Its equation holds derivatives of a function of t alone, which are found stages ahead.
void add_shaken_pendulum(Systems& list) {
  System& s = add(list, "pendulum on a shaken support");
  const Expr l = s.parameter("l", 0.8), w = s.parameter("w", 3.0), a = s.coordinate("a", 0.9, 0.3);
  const Expr x = Rational(1, 5) * sin(w * s.context.time()) + l * sin(a), y = -l * cos(a);
  s.from_lagrangian(Rational(1, 2) * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) - Rational(981, 100) * y);
  s.start.t = 0.3;
}

/// Sums of coordinates beside sums with t, one shape: of the latter a lane has no tangent.
void add_mixed_angles(Systems& list) {
  System& s = add(list, "mixed angles");
  const Expr x = s.coordinate("x", 0.4, 0.3), y = s.coordinate("y", -0.6, 0.5), c = s.parameter("c", 0.8);
  const Expr first = x - y, second = y + s.context.time();
  s.from_lagrangian(Rational(1, 2) * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) + pow(s.dot(sin(first) * c), 2) +
                    pow(s.dot(sin(second)), 2) - cos(first) * sin(second));
  s.start.t = 0.2;
}

/// Expressions of every instruction that have a value wherever their operands have one.
class RandomExpressions {
 public:
  RandomExpressions(std::vector<Expr> leaves, unsigned seed) : leaves_(std::move(leaves)), random_(seed) {}

  Expr make(int depth) {
    if (depth == 0) return leaves_[random_() % leaves_.size()];
    const Expr x = make(depth - 1), y = make(depth - 1 - static_cast<int>(random_() % static_cast<unsigned>(depth)));
    const Expr two = x.context().number(2);
    switch (random_() % 11) {
      case 0:
        return x + Rational(1, 3) * y;
      case 1:
        return x * y;
      case 2:
        return x * x - y;
      case 3:
        return sin(x) - cos(y);
      case 4:
        return x / (two + y * y);
      case 5:
        return sqrt(two + x * x);
      case 6:
        return pow(two + x * x, Rational(-3, 2)) * y;
      case 7:
        return apply(Kind::Tanh, x) + apply(Kind::Atan, y);
      case 8:
        return apply(Kind::Exp, sin(x));
      case 9:
        return apply(Kind::Log, two + x * x) - y;
      default:
        return apply(Kind::Cosh, sin(x)) * y;
    }
  }

 private:
  std::vector<Expr> leaves_;
  std::mt19937 random_;
};

/// Two coordinates with a mass matrix that is definite whatever the expressions are.
[[maybe_unused]] void make_random(System& s, unsigned seed) {
  const Expr x = s.coordinate("x", 0.4, 0.3), y = s.coordinate("y", -0.6, 0.5), c = s.parameter("c", 0.8);
  RandomExpressions random({x, y, c, s.context.time(), x, y}, seed);
  const Expr a = random.make(3), b = random.make(3), potential = random.make(4);
  s.from_lagrangian(Rational(1, 2) * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) +
                    Rational(1, 8) * (pow(s.dot(sin(a)), 2) + pow(s.dot(cos(b)), 2)) - sin(potential));
  s.start.t = 0.2;
}

[[maybe_unused]] Systems systems() {
  Systems list;
  add_friction(list);
  add_functions(list);
  for (const int links : {1, 2, 3, 5, 9}) add_chain(list, links);
  add_driven(list);
  add_shaken_pendulum(list);
  add_mixed_angles(list);
  add_selection(list, 1);
  add_selection(list, -1);
  add_undefined_operand(list);
  return list;
}

/// Motions near the start, each of its own parameters.
[[maybe_unused]] std::vector<Motion> motions_near(const Motion& start, int count) {
  std::vector<Motion> out;
  for (int i = 0; i < count; ++i) {
    Motion m = start;
    for (double& x : m.q) x *= 1 + 0.003 * i;
    for (double& x : m.v) x -= 0.007 * i;
    for (double& x : m.parameters) x *= 1 + 0.01 * i;
    m.t += 0.02 * i;
    out.push_back(m);
  }
  return out;
}

/// One motion by machine code: rolled, or straight-line code where the program is small and `long_run` asks for it.
[[maybe_unused]] KernelWorkspace compiled_workspace(const Kernel& kernel, int orders, bool long_run,
                                                    const std::string& processor) {
  KernelWorkspace work(kernel, orders);
  CompileOptions options;
  options.cache = false;
  options.long_run = long_run;
  options.processor = processor;
  const CompileReport report = work.compile(options);
  REQUIRE_MESSAGE(report.compiled, report.trouble);
  return work;
}

struct Expansion {
  std::vector<std::vector<double>> coefficients;  // [motions][(order + 2) n]
  std::vector<double> quality;                    // [motions]
};

void place(LaneWorkspace& work, int lane, const Motion& m) {
  const auto at = [&](std::size_t i) {
    return i * static_cast<std::size_t>(work.width()) + static_cast<std::size_t>(lane);
  };
  work.set_parameters(lane, m.parameters);
  work.time()[lane] = m.t;
  for (std::size_t i = 0; i < m.q.size(); ++i) work.coordinate(0)[at(i)] = m.q[i], work.coordinate(1)[at(i)] = m.v[i];
}

Expansion expand(const Kernel& kernel, const std::vector<Motion>& motions,
                 std::shared_ptr<const LaneExpansion> expansion) {
  const int width = expansion->width();
  LaneWorkspace work(kernel, order, std::move(expansion));
  Expansion out;
  for (std::size_t first = 0; first < motions.size(); first += static_cast<std::size_t>(width)) {
    for (int lane = 0; lane < width; ++lane)
      place(work, lane, motions[std::min(first + static_cast<std::size_t>(lane), motions.size() - 1)]);
    work.expand();
    for (int lane = 0; lane < width && first + static_cast<std::size_t>(lane) < motions.size(); ++lane) {
      std::vector<double> all;
      for (int k = 0; k <= order + 1; ++k)
        for (std::size_t i = 0; i < kernel.freedoms(); ++i)
          all.push_back(work.coordinate(k)[i * static_cast<std::size_t>(width) + static_cast<std::size_t>(lane)]);
      out.coefficients.push_back(std::move(all));
      out.quality.push_back(work.quality()[lane]);
    }
  }
  return out;
}

[[maybe_unused]] Expansion expand(const Kernel& kernel, const std::vector<Motion>& motions, int width,
                                  InstructionSet set) {
  return expand(kernel, motions, interpreted_lanes(kernel, width, set));
}

[[maybe_unused]] bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Rounding errors, which the solve magnifies by as much as the mass matrix is ill-conditioned. A power is up to six
/// operations, which both round in their own way: u^(−3) is off by 1.5e-14 of the size here, and by as much as one
/// operation from the motion in 113 bits.
[[maybe_unused]] void check_against_reference(const Kernel& kernel, const Motion& m, const std::vector<double>& found,
                                              double quality) {
  KernelWorkspace work(kernel, order);
  work.set_parameters(m.parameters);
  REQUIRE(work.expand(m.t, m.q, m.v) == KernelStatus::Ok);
  const std::size_t n = kernel.freedoms();
  for (int k = 0; k <= order + 1; ++k) {
    double size = 1;  // rounding errors spread over the coordinates
    for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(work.coordinate(k)[i]));
    for (std::size_t i = 0; i < n; ++i) {
      CAPTURE(k);
      CAPTURE(i);
      CHECK(std::abs(found[static_cast<std::size_t>(k) * n + i] - work.coordinate(k)[i]) <=
            2e-14 * (k + 1) * size / quality);
    }
  }
}

}  // namespace
