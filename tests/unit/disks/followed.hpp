#pragma once
#include "disks/retrace.hpp"
#include "kernel/program/program.hpp"

#include <maupertuis/disks.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

/// Functions of known polynomials x(s), y(s), by the program and in complex numbers.
namespace maupertuis::test {

using Complex = std::complex<double>;
inline constexpr int order = 20;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// f along x(s) = c₀ + c₁ s + c₂ s² + c₃ s³, t = t₀ + s.
struct Followed {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate), t = context.time();
  std::vector<std::vector<double>> c =
      std::vector<std::vector<double>>(2, std::vector<double>(order + 2, 0.0));  // [x, y][k]
  double t0 = 0;
  std::shared_ptr<Kernel> kernel;
  std::unique_ptr<Retrace<double>> retrace;
  std::unique_ptr<Disks> disks;
  std::vector<double> constants;
  Slot slot = 0;

  /// R_x = x'' + in_residual.
  void follow(const Expr& f) { follow(f, f); }
  void follow(const Expr& f, const Expr& in_residual) { follow(f, in_residual, context.number(0)); }
  /// R_y = y'' + in_second besides.
  void follow(const Expr& f, const Expr& in_residual, const Expr& in_second) {
    KernelSource source;
    source.coordinates = {x, y};
    const auto second = [&](const Expr& q) { return context.time_derivative(context.time_derivative(q)); };
    source.residual = {second(x) + in_residual, second(y) + in_second};
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
    constants.assign(work.constants(),
                     work.constants() + program.constants.size());  // what packing adds comes behind them
    retrace->set_constants(constants.data());
    std::vector<std::vector<double>> rows(order + 2, std::vector<double>(2));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = {c[0][k], c[1][k]};
    retrace->set_motion(t0, 0.0, [&](int k) { return rows[static_cast<std::size_t>(k)].data(); });
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
inline Complex error_function(Complex z) {
  Complex sum = 0, power = z;  // (−1)ⁿ z^{2n+1}/n!
  for (int n = 0; n < 80; ++n, power *= -z * z / double(n)) sum += power / (2.0 * n + 1);
  return 2 / std::sqrt(std::numbers::pi) * sum;
}

/// w eʷ = z by Newton's method, from the principal side.
inline Complex lambert(Complex z) {
  Complex w = std::log(1.0 + z);
  for (int turn = 0; turn < 60; ++turn) w -= (w * std::exp(w) - z) / (std::exp(w) * (w + 1.0));
  return w;
}

inline const std::vector<Case>& cases() {
  const Complex i(0, 1);
  static const std::vector<Case> all = {
      {"x y", [](Followed& f) { return f.x * f.y; }, [](Complex x, Complex y, Complex) { return x * y; }},
      {"x^2", [](Followed& f) { return pow(f.x, 2); }, [](Complex x, Complex, Complex) { return x * x; }},
      {"x^9", [](Followed& f) { return pow(f.x, 9); }, [](Complex x, Complex, Complex) { return std::pow(x, 9); }},
      {"1/x", [](Followed& f) { return pow(f.x, -1); }, [](Complex x, Complex, Complex) { return 1.0 / x; }, 0.6, 0.6},
      {"y/(x + 1)", [](Followed& f) { return f.y / (f.x + Rational(1)); },
       [](Complex x, Complex y, Complex) { return y / (x + 1.0); }, 0.6, 1.6},
      {"sqrt(x)", [](Followed& f) { return pow(f.x, Rational(1, 2)); },
       [](Complex x, Complex, Complex) { return std::sqrt(x); }, 0.6, 0.6},
      {"x^(3/2)", [](Followed& f) { return pow(f.x, Rational(3, 2)); },
       [](Complex x, Complex, Complex) { return x * std::sqrt(x); }, 0.6, 0.6},
      {"x^(5/3)", [](Followed& f) { return pow(f.x, Rational(5, 3)); },
       [](Complex x, Complex, Complex) { return std::pow(x, 5.0 / 3); }, 0.6, 0.6},
      {"x^(-3/2)", [](Followed& f) { return pow(f.x, Rational(-3, 2)); },
       [](Complex x, Complex, Complex) { return std::pow(x, -1.5); }, 0.6, 0.6},
      {"sin 3x", [](Followed& f) { return sin(f.x * Rational(3)); },
       [](Complex x, Complex, Complex) { return std::sin(3.0 * x); }},
      {"cos 3x", [](Followed& f) { return cos(f.x * Rational(3)); },
       [](Complex x, Complex, Complex) { return std::cos(3.0 * x); }},
      {"sinh 2x", [](Followed& f) { return apply(Kind::Sinh, f.x * Rational(2)); },
       [](Complex x, Complex, Complex) { return std::sinh(2.0 * x); }},
      {"cosh 2x", [](Followed& f) { return apply(Kind::Cosh, f.x * Rational(2)); },
       [](Complex x, Complex, Complex) { return std::cosh(2.0 * x); }},
      {"exp(-4x)", [](Followed& f) { return apply(Kind::Exp, f.x * Rational(-4)); },
       [](Complex x, Complex, Complex) { return std::exp(-4.0 * x); }},
      {"log x", [](Followed& f) { return apply(Kind::Log, f.x); },
       [](Complex x, Complex, Complex) { return std::log(x); }, 0.6, 0.6},
      {"tan x", [](Followed& f) { return apply(Kind::Tan, f.x); },
       [](Complex x, Complex, Complex) { return std::tan(x); }, 0.6, std::numbers::pi / 2 - 0.6},
      {"asin x", [](Followed& f) { return apply(Kind::Asin, f.x); },
       [](Complex x, Complex, Complex) { return std::asin(x); }, 0.6, 0.4},
      {"acos x", [](Followed& f) { return apply(Kind::Acos, f.x); },
       [](Complex x, Complex, Complex) { return std::acos(x); }, 0.6, 0.4},
      {"atan x", [](Followed& f) { return apply(Kind::Atan, f.x); },
       [](Complex x, Complex, Complex) { return std::atan(x); }, 0.6, std::hypot(1, 0.6)},
      {"tanh x", [](Followed& f) { return apply(Kind::Tanh, f.x); },
       [](Complex x, Complex, Complex) { return std::tanh(x); }, 0.6, std::hypot(0.6, std::numbers::pi / 2)},
      {"asinh x", [](Followed& f) { return apply(Kind::Asinh, f.x); },
       [](Complex x, Complex, Complex) { return std::asinh(x); }, 0.6, std::hypot(1, 0.6)},
      {"acosh x", [](Followed& f) { return apply(Kind::Acosh, f.x); },
       [](Complex x, Complex, Complex) { return std::acosh(x); }, 1.6, 0.6},
      {"atanh x", [](Followed& f) { return apply(Kind::Atanh, f.x); },
       [](Complex x, Complex, Complex) { return std::atanh(x); }, 0.6, 0.4},
      {"atan2(y, x)",
       [](Followed& f) {
         const Expr both[] = {f.y, f.x};
         return f.context.function(Kind::Atan2, both);
       },
       [i](Complex x, Complex y, Complex) { return -i * std::log((x + i * y) / std::sqrt(x * x + y * y)); }, 0.6},
      {"erf 2x", [](Followed& f) { return apply(Kind::Erf, f.x * Rational(2)); },
       [](Complex x, Complex, Complex) { return error_function(2.0 * x); }},
      {"lambert_w x", [](Followed& f) { return apply(Kind::LambertW, f.x); },
       [](Complex x, Complex, Complex) { return lambert(x); }, 0.6, 0.6 + std::exp(-1.0)},
      {"logistic", [](Followed& f) { return pow(f.context.number(1) + apply(Kind::Exp, f.x * Rational(-300)), -1); },
       [](Complex x, Complex, Complex) { return 1.0 / (1.0 + std::exp(-300.0 * x)); }, 0.6, 0.6},
      {"sin(5 t) x + t^3", [](Followed& f) { return sin(f.t * Rational(5)) * f.x + pow(f.t, 3); },
       [](Complex x, Complex, Complex t) { return std::sin(5.0 * t) * x + t * t * t; }},
  };
  return all;
}

inline Complex on_circle(double r, int k, int count) { return std::polar(r, 2 * std::numbers::pi * (k + 0.5) / count); }

}  // namespace maupertuis::test
