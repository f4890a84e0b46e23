#include <doctest/doctest.h>
#include <maupertuis/functions.hpp>
#include <maupertuis/kernel.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <string>

// Every elementary function of u(t) = t + t²/3 against Cauchy's integral: the coefficients are those of the discrete
// Fourier transform of f(u(t0 + r e^{iφ})). Nothing of the recurrences is used.

namespace {

using namespace maupertuis;
using Complex = std::complex<long double>;
using ComplexFunction = std::function<Complex(Complex)>;

constexpr int order = 12;

Complex inner(Complex t) { return t + t * t / 3.0L; }

/// 2/√π Σ (−1)ⁿ z²ⁿ⁺¹/(n! (2n + 1)), for |z| of a few.
Complex complex_erf(Complex z) {
  Complex power = z, sum = 0;
  for (int n = 0; n < 120; ++n) {
    sum += power / static_cast<long double>(2 * n + 1);
    power *= -z * z / static_cast<long double>(n + 1);
  }
  return sum * 2.0L / std::sqrt(std::acos(-1.0L));
}

/// The root of w eʷ = z by Newton's method.
Complex complex_lambert_w(Complex z) {
  Complex w = std::log(1.0L + z);
  for (int i = 0; i < 40; ++i) w -= (w - z * std::exp(-w)) / (1.0L + w);
  return w;
}

struct Coefficient {
  long double value;
  long double size;  // of the terms that were added up: the largest |f| on the circle, over r^k
};

Coefficient cauchy(const ComplexFunction& f, long double t0, long double radius, int k) {
  constexpr int points = 256;
  Complex sum = 0;
  long double largest = 0;
  for (int i = 0; i < points; ++i) {
    const Complex turn = std::polar(1.0L, 2 * std::acos(-1.0L) * static_cast<long double>(i) / points);
    const Complex value = f(inner(t0 + radius * turn));
    largest = std::max(largest, std::abs(value));
    sum += value * std::pow(turn, -k);
  }
  const long double scale = std::pow(radius, static_cast<long double>(-k));
  return {sum.real() / points * scale, largest * scale};
}

struct Case {
  std::string name;
  std::function<Expr(Expr)> expression;
  ComplexFunction function;
  double t0;
  long double radius = 0.35L;  // below the distance to the nearest singularity, not far below
};

Expr power_of(Expr u, std::int64_t p, std::int64_t q) { return pow(u, Rational(p, q)); }

std::vector<Case> cases() {
  std::vector<Case> list;
  const auto add = [&](std::string name, Kind kind, ComplexFunction f, double t0, long double radius = 0.35L) {
    list.push_back({std::move(name), [kind](Expr u) { return apply(kind, u); }, std::move(f), t0, radius});
  };
  add(
      "sin", Kind::Sin, [](Complex u) { return std::sin(u); }, 0.7, 3);
  add(
      "cos", Kind::Cos, [](Complex u) { return std::cos(u); }, 0.7, 3);
  add(
      "tan", Kind::Tan, [](Complex u) { return std::tan(u); }, 0.4);
  add(
      "asin", Kind::Asin, [](Complex u) { return std::asin(u); }, 0.3);
  add(
      "acos", Kind::Acos, [](Complex u) { return std::acos(u); }, 0.3);
  add(
      "atan", Kind::Atan, [](Complex u) { return std::atan(u); }, 0.6);
  add(
      "sinh", Kind::Sinh, [](Complex u) { return std::sinh(u); }, 0.7, 3);
  add(
      "cosh", Kind::Cosh, [](Complex u) { return std::cosh(u); }, 0.7, 3);
  add(
      "tanh", Kind::Tanh, [](Complex u) { return std::tanh(u); }, 0.5);
  add(
      "asinh", Kind::Asinh, [](Complex u) { return std::asinh(u); }, 0.5);
  add(
      "acosh", Kind::Acosh, [](Complex u) { return std::acosh(u); }, 1.5);
  add(
      "atanh", Kind::Atanh, [](Complex u) { return std::atanh(u); }, 0.3);
  add(
      "exp", Kind::Exp, [](Complex u) { return std::exp(u); }, 0.9, 3);
  add(
      "log", Kind::Log, [](Complex u) { return std::log(u); }, 1.1);
  add("erf", Kind::Erf, complex_erf, 0.5, 1);
  add("lambert_w", Kind::LambertW, complex_lambert_w, 0.6);
  list.push_back({"square", [](Expr u) { return power_of(u, 2, 1); }, [](Complex u) { return u * u; }, 0.9, 1});
  list.push_back(
      {"fifth power", [](Expr u) { return power_of(u, 5, 1); }, [](Complex u) { return u * u * u * u * u; }, 0.9, 1});
  list.push_back({"reciprocal", [](Expr u) { return power_of(u, -1, 1); }, [](Complex u) { return 1.0L / u; }, 0.9});
  list.push_back(
      {"inverse cube", [](Expr u) { return power_of(u, -3, 1); }, [](Complex u) { return 1.0L / (u * u * u); }, 0.9});
  list.push_back({"sqrt", [](Expr u) { return power_of(u, 1, 2); }, [](Complex u) { return std::sqrt(u); }, 0.9});
  list.push_back(
      {"power -3/2", [](Expr u) { return power_of(u, -3, 2); }, [](Complex u) { return std::pow(u, -1.5L); }, 0.9});
  list.push_back({"power of itself", [](Expr u) { return u.context().power(u, u); },
                  [](Complex u) { return std::exp(u * std::log(u)); }, 0.9});
  list.push_back({"product", [](Expr u) { return sin(u) * apply(Kind::Exp, u) * u; },
                  [](Complex u) { return std::sin(u) * std::exp(u) * u; }, 0.6, 3});
  list.push_back({"quotient", [](Expr u) { return sin(u) / (u + Rational(2)); },
                  [](Complex u) { return std::sin(u) / (u + 2.0L); }, 0.6});
  list.push_back({"sum of products", [](Expr u) { return Rational(3) * u * sin(u) - u * cos(u) + Rational(1, 7); },
                  [](Complex u) { return 3.0L * u * std::sin(u) - u * std::cos(u) + 1.0L / 7; }, 0.6, 3});
  list.push_back({"atan2",
                  [](Expr u) {
                    const std::vector<Expr> arguments{u * u, u + Rational(1)};
                    return u.context().function(Kind::Atan2, arguments);
                  },
                  [](Complex u) { return std::atan(u * u / (u + 1.0L)); }, 0.6});
  return list;
}

void check_series(const Case& c, const KernelWorkspace& work) {
  for (int k = 0; k <= order; ++k) {
    const Coefficient expected = cauchy(c.function, c.t0, c.radius, k);
    CAPTURE(k);
    CHECK(std::abs(work.event(0, k) - expected.value) <= 4e-15L * expected.size);
  }
}

}  // namespace

TEST_CASE("the cases are all functions of the table") {
  const auto list = cases();
  std::apply(
      [&](const auto&... row) {
        const auto check = [&](std::string_view name) {
          CHECK_MESSAGE(std::any_of(list.begin(), list.end(), [&](const Case& c) { return c.name == name; }),
                        std::string(name));
        };
        (check(row.name), ...);
      },
      functions::rows);
}

TEST_CASE("jets of every function agree with Cauchy's integral, as functions of time") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    Context context;
    const Expr t = context.time();
    KernelSource source;
    source.events = {c.expression(t + t * t / Rational(3))};
    KernelWorkspace work(build_kernel(source), order);
    REQUIRE(work.expand(c.t0, {}, {}) == KernelStatus::Ok);
    check_series(c, work);
  }
}

TEST_CASE("jets of every function agree with Cauchy's integral, as functions of a coordinate in free motion") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    Context context;
    const Expr q = context.symbol("q", Role::Coordinate);
    KernelSource source;
    source.coordinates = {q};
    source.residual = {context.symbol("q", Role::Coordinate, 2)};
    source.events = {c.expression(q + q * q / Rational(3))};
    KernelWorkspace work(build_kernel(source), order);
    REQUIRE(work.expand(0, std::vector{c.t0}, std::vector{1.0}) == KernelStatus::Ok);
    check_series(c, work);
  }
}

TEST_CASE("d/dt of every function is its shifted series") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    Context context;
    const Expr t = context.time();
    const Expr f = c.expression(t + t * t / Rational(3));
    KernelSource source;
    source.events = {f, context.time_derivative(f), context.time_derivative(context.time_derivative(f)) + f};
    KernelWorkspace work(build_kernel(source), order);
    REQUIRE(work.expand(c.t0, {}, {}) == KernelStatus::Ok);
    for (int k = 0; k + 2 <= order; ++k) {
      CHECK(work.event(1, k) == doctest::Approx((k + 1) * work.event(0, k + 1)).epsilon(1e-12));
      CHECK(work.event(2, k) ==
            doctest::Approx((k + 1) * (k + 2) * work.event(0, k + 2) + work.event(0, k)).epsilon(1e-11));
    }
  }
}
