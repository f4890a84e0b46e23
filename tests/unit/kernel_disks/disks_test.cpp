// Bounds on disks against the functions themselves, in complex numbers on the circle: each rule must cover what a value does there, must not be absurdly
// wide, and must say ∞ where the disk reaches a singularity.
#include "kernel/disks/retrace.hpp"
#include "kernel/program/program.hpp"

#include <doctest/doctest.h>
#include <maupertuis/disks.hpp>
#include <maupertuis/transform.hpp>

#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

using namespace maupertuis;

namespace {

using Complex = std::complex<double>;
constexpr int order = 20;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// f along x(s) = c₀ + c₁ s + c₂ s² + c₃ s³, t = t₀ + s.
struct Followed {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate), t = context.time();
  std::vector<std::vector<double>> c = std::vector<std::vector<double>>(2, std::vector<double>(order + 2, 0.0));  // [x, y][k]
  double t0 = 0;
  std::shared_ptr<Kernel> kernel;
  std::unique_ptr<Retrace<double>> retrace;
  std::unique_ptr<Disks> disks;
  std::vector<double> constants;
  Slot slot = 0;

  void follow(const Expr& f) {
    KernelSource source;
    source.coordinates = {x, y};
    const auto second = [&](const Expr& q) { return context.time_derivative(context.time_derivative(q)); };
    source.residual = {second(x), second(y)};
    source.events = {f};
    kernel = std::make_shared<Kernel>(build_kernel(source));
    const Program& program = kernel->program();
    slot = program.events[0];
    KernelWorkspace work(*kernel, 1);  // for the constants
    work.set_parameters({});
    const double zero[2] = {0.3, 0.4};
    work.evaluate(0, zero, zero);
    retrace = std::make_unique<Retrace<double>>(program, order, std::span(&slot, 1));
    disks = std::make_unique<Disks>(program, std::span(&slot, 1));
    constants.assign(work.constants(), work.constants() + program.constants.size());  // what packing adds comes behind them
    retrace->set_constants(constants.data());
    std::vector<std::vector<double>> rows(order + 2, std::vector<double>(2));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = {c[0][k], c[1][k]};
    retrace->set_motion(t0, [&](int k) { return rows[static_cast<std::size_t>(k)].data(); });
    retrace->expand_about(0);
    disks->set_constants(constants.data());
    disks->begin({retrace->row(0), retrace->stride(), order});
  }
  Complex polynomial(std::size_t i, Complex s) const {
    Complex sum = 0;
    for (int k = order + 1; k >= 0; --k) sum = sum * s + c[i][static_cast<std::size_t>(k)];
    return sum;
  }
};

struct Case {
  const char* name;
  std::function<Expr(Followed&)> expression;
  std::function<Complex(Complex x, Complex y, Complex t)> value;
  double x0 = 0.6;
  double singular = infinity;  // distance of the nearest singularity from x₀ along x
};

/// By its power series, which does for |z| < 3.
Complex error_function(Complex z) {
  Complex sum = 0, power = z;  // (−1)ⁿ z^{2n+1}/n!
  for (int n = 0; n < 80; ++n, power *= -z * z / double(n)) sum += power / (2.0 * n + 1);
  return 2 / std::sqrt(std::numbers::pi) * sum;
}

/// w eʷ = z by Newton's method, from the principal side.
Complex lambert(Complex z) {
  Complex w = std::log(1.0 + z);
  for (int turn = 0; turn < 60; ++turn) w -= (w * std::exp(w) - z) / (std::exp(w) * (w + 1.0));
  return w;
}

const std::vector<Case>& cases() {
  const Complex i(0, 1);
  static const std::vector<Case> all = {
      {"x y", [](Followed& f) { return f.x * f.y; }, [](Complex x, Complex y, Complex) { return x * y; }},
      {"x^2", [](Followed& f) { return pow(f.x, 2); }, [](Complex x, Complex, Complex) { return x * x; }},
      {"x^9", [](Followed& f) { return pow(f.x, 9); }, [](Complex x, Complex, Complex) { return std::pow(x, 9); }},
      {"1/x", [](Followed& f) { return pow(f.x, -1); }, [](Complex x, Complex, Complex) { return 1.0 / x; }, 0.6, 0.6},
      {"y/(x + 1)", [](Followed& f) { return f.y / (f.x + Rational(1)); }, [](Complex x, Complex y, Complex) { return y / (x + 1.0); }, 0.6, 1.6},
      {"sqrt(x)", [](Followed& f) { return pow(f.x, Rational(1, 2)); }, [](Complex x, Complex, Complex) { return std::sqrt(x); }, 0.6, 0.6},
      {"x^(5/3)", [](Followed& f) { return pow(f.x, Rational(5, 3)); }, [](Complex x, Complex, Complex) { return std::pow(x, 5.0 / 3); }, 0.6, 0.6},
      {"x^(-3/2)", [](Followed& f) { return pow(f.x, Rational(-3, 2)); }, [](Complex x, Complex, Complex) { return std::pow(x, -1.5); }, 0.6, 0.6},
      {"sin 3x", [](Followed& f) { return sin(f.x * Rational(3)); }, [](Complex x, Complex, Complex) { return std::sin(3.0 * x); }},
      {"cos 3x", [](Followed& f) { return cos(f.x * Rational(3)); }, [](Complex x, Complex, Complex) { return std::cos(3.0 * x); }},
      {"sinh 2x", [](Followed& f) { return apply(Kind::Sinh, f.x * Rational(2)); }, [](Complex x, Complex, Complex) { return std::sinh(2.0 * x); }},
      {"cosh 2x", [](Followed& f) { return apply(Kind::Cosh, f.x * Rational(2)); }, [](Complex x, Complex, Complex) { return std::cosh(2.0 * x); }},
      {"exp(-4x)", [](Followed& f) { return apply(Kind::Exp, f.x * Rational(-4)); }, [](Complex x, Complex, Complex) { return std::exp(-4.0 * x); }},
      {"log x", [](Followed& f) { return apply(Kind::Log, f.x); }, [](Complex x, Complex, Complex) { return std::log(x); }, 0.6, 0.6},
      {"tan x", [](Followed& f) { return apply(Kind::Tan, f.x); }, [](Complex x, Complex, Complex) { return std::tan(x); }, 0.6, std::numbers::pi / 2 - 0.6},
      {"asin x", [](Followed& f) { return apply(Kind::Asin, f.x); }, [](Complex x, Complex, Complex) { return std::asin(x); }, 0.6, 0.4},
      {"acos x", [](Followed& f) { return apply(Kind::Acos, f.x); }, [](Complex x, Complex, Complex) { return std::acos(x); }, 0.6, 0.4},
      {"atan x", [](Followed& f) { return apply(Kind::Atan, f.x); }, [](Complex x, Complex, Complex) { return std::atan(x); }, 0.6, std::hypot(1, 0.6)},
      {"tanh x", [](Followed& f) { return apply(Kind::Tanh, f.x); }, [](Complex x, Complex, Complex) { return std::tanh(x); }, 0.6, std::hypot(0.6, std::numbers::pi / 2)},
      {"asinh x", [](Followed& f) { return apply(Kind::Asinh, f.x); }, [](Complex x, Complex, Complex) { return std::asinh(x); }, 0.6, std::hypot(1, 0.6)},
      {"acosh x", [](Followed& f) { return apply(Kind::Acosh, f.x); }, [](Complex x, Complex, Complex) { return std::acosh(x); }, 1.6, 0.6},
      {"atanh x", [](Followed& f) { return apply(Kind::Atanh, f.x); }, [](Complex x, Complex, Complex) { return std::atanh(x); }, 0.6, 0.4},
      {"atan2(y, x)", [](Followed& f) { const Expr both[] = {f.y, f.x}; return f.context.function(Kind::Atan2, both); },
       [i](Complex x, Complex y, Complex) { return -i * std::log((x + i * y) / std::sqrt(x * x + y * y)); }, 0.6},
      {"erf 2x", [](Followed& f) { return apply(Kind::Erf, f.x * Rational(2)); }, [](Complex x, Complex, Complex) { return error_function(2.0 * x); }},
      {"lambert_w x", [](Followed& f) { return apply(Kind::LambertW, f.x); }, [](Complex x, Complex, Complex) { return lambert(x); }, 0.6, 0.6 + std::exp(-1.0)},
      {"logistic", [](Followed& f) { return pow(f.context.number(1) + apply(Kind::Exp, f.x * Rational(-300)), -1); },
       [](Complex x, Complex, Complex) { return 1.0 / (1.0 + std::exp(-300.0 * x)); }, 0.6, 0.6},
      {"sin(5 t) x + t^3", [](Followed& f) { return sin(f.t * Rational(5)) * f.x + pow(f.t, 3); },
       [](Complex x, Complex, Complex t) { return std::sin(5.0 * t) * x + t * t * t; }},
  };
  return all;
}

Complex on_circle(double r, int k, int count) { return std::polar(r, 2 * std::numbers::pi * (k + 0.5) / count); }

}  // namespace

TEST_CASE("reach covers what a value does on the disk, and not absurdly more") {
  for (const Case& a : cases())
    for (unsigned seed = 0; seed < 6; ++seed) {
      CAPTURE(std::string(a.name));
      CAPTURE(seed);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> part(-0.3, 0.3);
      Followed f;
      f.c[0][0] = a.x0, f.c[1][0] = 0.7;
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 1; k < 4; ++k) f.c[i][k] = part(random);
      f.t0 = 1.3;
      f.follow(a.expression(f));
      const Complex at_centre = a.value(f.polynomial(0, 0), f.polynomial(1, 0), f.t0);
      for (const double r : {0.9, 0.6, 0.4, 0.2, 0.1, 0.02}) {
        CAPTURE(r);
        f.disks->evaluate(r);
        double largest = 0;
        for (int k = 0; k < 64; ++k) {
          const Complex s = on_circle(r, k, 64);
          largest = std::max(largest, std::abs(a.value(f.polynomial(0, s), f.polynomial(1, s), f.t0 + s) - at_centre));
        }
        CHECK(f.disks->reach(f.slot) >= largest * (1 - 1e-9));
        CHECK(f.disks->tail(f.slot) >= 0);
        if (r <= 0.02) CHECK(f.disks->reach(f.slot) <= 32 * largest + 1e-12);  // terms may cancel
      }
    }
}

TEST_CASE("tails cover what the polynomial leaves out") {
  for (const Case& a : cases()) {
    CAPTURE(std::string(a.name));
    Followed f;
    f.c[0] = std::vector<double>(order + 2, 0.0), f.c[1] = f.c[0];
    f.c[0][0] = a.x0, f.c[0][1] = 0.5, f.c[0][2] = -0.2, f.c[1][0] = 0.7, f.c[1][1] = -0.4;
    f.t0 = 0.4;
    f.follow(a.expression(f));
    int finite = 0;
    for (const double r : {0.9, 0.6, 0.4, 0.2}) {
      f.disks->evaluate(r);
      const double tail = f.disks->tail(f.slot);
      if (!(tail < infinity)) continue;
      ++finite;
      for (const double x : {0.45, -0.45, 0.3}) {
        const double s = x * r;
        const double exact = a.value(f.polynomial(0, s), f.polynomial(1, s), f.t0 + s).real();
        double by_series = 0;
        for (int k = order + 1; k >= 0; --k) by_series = by_series * s + f.retrace->row(k)[f.slot];
        CHECK(std::abs(exact - by_series) <= tail * std::pow(std::abs(x), order + 2) / (1 - std::abs(x)) + 1e-14 * (1 + std::abs(exact)));
      }
    }
    CHECK(finite > 0);
  }
}

TEST_CASE("a disk that reaches a singularity bounds nothing") {
  for (const Case& a : cases()) {
    if (!(a.singular < infinity)) continue;
    CAPTURE(std::string(a.name));
    Followed f;
    f.c[0][0] = a.x0, f.c[0][1] = 1, f.c[1][0] = 0.7;
    f.follow(a.expression(f));
    f.disks->evaluate(1.01 * a.singular);
    CHECK(f.disks->tail(f.slot) == infinity);
  }
}

TEST_CASE("what is far from its layer costs nothing, and wakes up when the disk comes near") {
  Followed f;  // a pulse at t = 6, 0.05 wide, seen from t = 0
  const Expr pulse = apply(Kind::Exp, pow((f.t - Rational(6)) * Rational(20), 2) * Rational(-1));
  f.follow(pulse);
  f.disks->evaluate(2);
  CHECK(f.disks->tail(f.slot) < 1e-300);
  Followed g;
  g.follow(apply(Kind::Exp, pow((g.t - Rational(6)) * Rational(20), 2) * Rational(-1)));
  g.disks->evaluate(6.5);
  CHECK(g.disks->tail(g.slot) > 1);
  g.disks->evaluate(2);
  CHECK(g.disks->tail(g.slot) < 1e-300);
}

TEST_CASE("polynomials in t of degrees that the step keeps have no tail, of higher ones they have") {
  for (const int degree : {1, 3, 16, 32}) {
    Followed f;
    f.t0 = 0.5;
    Expr power = f.t;
    for (int d = 1; d < degree; d *= 2) power = d == 1 && degree == 3 ? power * f.t * f.t : power * power;
    f.follow(degree == 1 ? f.t : power);
    f.disks->evaluate(1);
    CAPTURE(degree);
    CHECK((f.disks->tail(f.slot) == 0) == (degree < order));
  }
}
