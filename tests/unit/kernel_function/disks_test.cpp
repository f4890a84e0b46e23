// Disks contain what complex numbers find on them.
#include <doctest/doctest.h>
#include <maupertuis/expression.hpp>
#include <maupertuis/function_disks.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <string>

using namespace maupertuis;
using Complex = std::complex<double>;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Case {
  const char* name;
  std::function<Expr(Expr, Expr)> expression;
  std::function<Complex(Complex, Complex)> value;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"sum", [](Expr x, Expr y) { return x - 2 * y; }, [](Complex x, Complex y) { return x - 2.0 * y; }},
      {"product", [](Expr x, Expr y) { return x * y; }, [](Complex x, Complex y) { return x * y; }},
      {"quotient", [](Expr x, Expr y) { return x / y; }, [](Complex x, Complex y) { return x / y; }},
      {"square", [](Expr x, Expr) { return pow(x, 2); }, [](Complex x, Complex) { return x * x; }},
      {"fortieth power", [](Expr x, Expr) { return pow(x, 40); }, [](Complex x, Complex) { return std::pow(x, 40); }},
      {"inverse cube", [](Expr x, Expr) { return pow(x, -3); }, [](Complex x, Complex) { return 1.0 / (x * x * x); }},
      {"sqrt", [](Expr x, Expr) { return sqrt(x); }, [](Complex x, Complex) { return std::sqrt(x); }},
      {"sin", [](Expr x, Expr) { return sin(x); }, [](Complex x, Complex) { return std::sin(x); }},
      {"cos", [](Expr x, Expr) { return cos(x); }, [](Complex x, Complex) { return std::cos(x); }},
      {"tan", [](Expr x, Expr) { return apply(Kind::Tan, x); }, [](Complex x, Complex) { return std::tan(x); }},
      {"asin", [](Expr x, Expr) { return apply(Kind::Asin, x / 8); },
       [](Complex x, Complex) { return std::asin(x / 8.0); }},
      {"acos", [](Expr x, Expr) { return apply(Kind::Acos, x / 8); },
       [](Complex x, Complex) { return std::acos(x / 8.0); }},
      {"atan", [](Expr x, Expr) { return apply(Kind::Atan, x); }, [](Complex x, Complex) { return std::atan(x); }},
      {"sinh", [](Expr x, Expr) { return apply(Kind::Sinh, x); }, [](Complex x, Complex) { return std::sinh(x); }},
      {"cosh", [](Expr x, Expr) { return apply(Kind::Cosh, x); }, [](Complex x, Complex) { return std::cosh(x); }},
      {"tanh", [](Expr x, Expr) { return apply(Kind::Tanh, 3 * x); },
       [](Complex x, Complex) { return std::tanh(3.0 * x); }},
      {"asinh", [](Expr x, Expr) { return apply(Kind::Asinh, x); }, [](Complex x, Complex) { return std::asinh(x); }},
      {"acosh", [](Expr x, Expr) { return apply(Kind::Acosh, x + 4); },
       [](Complex x, Complex) { return std::acosh(x + 4.0); }},
      {"atanh", [](Expr x, Expr) { return apply(Kind::Atanh, x / 8); },
       [](Complex x, Complex) { return std::atanh(x / 8.0); }},
      {"exp", [](Expr x, Expr) { return apply(Kind::Exp, Rational(-3) * x * x); },
       [](Complex x, Complex) { return std::exp(-3.0 * x * x); }},
      {"log", [](Expr x, Expr) { return apply(Kind::Log, x); }, [](Complex x, Complex) { return std::log(x); }},
      {"atan2",
       [](Expr x, Expr y) {
         return x.context().function(Kind::Atan2, std::array{x, y});
       },
       [](Complex x, Complex y) { return std::atan(x / y); }},
      {"abs", [](Expr x, Expr) { return apply(Kind::Abs, x); },
       [](Complex x, Complex) { return x.real() < 0 ? -x : x; }},
      {"logistic", [](Expr x, Expr) { return 1 / (apply(Kind::Exp, Rational(-200) * x) + 1); },
       [](Complex x, Complex) { return 1.0 / (1.0 + std::exp(-200.0 * x)); }},
  };
  return all;
}

}  // namespace

TEST_CASE("a disk contains the values of each function on it") {
  int finite = 0;
  for (const Case& c : cases()) {
    Context context;
    const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate);
    const FunctionKernel kernel = build_function({.inputs = {x, y}, .parameters = {}, .outputs = {c.expression(x, y)}});
    FunctionWorkspace work(kernel);
    FunctionDisks disks(kernel, {});
    for (const double x0 : {0.3, 1.7, 3.1, 5.0})
      for (const double y0 : {0.9, 2.2})
        for (const double radius : {0.01, 0.1, 0.5, 1.5}) {
          const std::string name = c.name;
          CAPTURE(name);
          CAPTURE(x0);
          CAPTURE(radius);
          const double point[] = {x0, y0}, reach[] = {radius, 0.6 * radius};
          double value = 0;
          work.evaluate(point, {&value, 1});
          disks.set_centre(point);
          disks.evaluate(reach);
          if (!(disks.reach(0) < HUGE_VAL)) continue;
          ++finite;
          double largest = 0;
          for (int k = 0; k < 64; ++k)  // x and y move on the circle with phases of their own
            for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
              const double angle = 2 * pi * k / 64;
              const Complex s = std::polar(radius, angle), u = std::polar(0.6 * radius, angle + turn);
              Complex change = c.value(x0 + s, y0 + u) - value;
              if (std::string(c.name) == "atan2")
                change -= pi * std::round(change.real() / pi);  // the branch of atan is not atan2's
              largest = std::max(largest, std::abs(change));
            }
          CHECK(largest <= disks.reach(0) * (1 + 1e-12));
          CHECK(disks.tail(0) <= disks.reach(0));
        }
  }
  CHECK(finite > 24 * 16);  // of 24 · 32: small disks are bounded
}

TEST_CASE("a disk is not much larger than what it contains, and does not bound what has no bound") {
  Context context;
  const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate);
  const auto bounds = [&](Expr e, double x0, double reach) {
    const FunctionKernel kernel = build_function({.inputs = {x, y}, .parameters = {}, .outputs = {e}});
    FunctionDisks disks(kernel, {});
    const double point[] = {x0, 1}, radius[] = {reach, 0};
    disks.set_centre(point);
    disks.evaluate(radius);
    return std::pair{disks.reach(0), disks.tail(0)};
  };
  CHECK(bounds(3 * x - 2 * y, 1, 0.5).first == doctest::Approx(1.5));
  CHECK(bounds(3 * x - 2 * y, 1, 0.5).second == 0);  // a polynomial of the inputs' degree leaves no tail
  CHECK(bounds(apply(Kind::Exp, x), 0, 1).first < 1.01 * std::exp(1.0));
  CHECK(bounds(sin(x), 0, 1).first < 1.01 * std::sinh(1.0));
  // A pulse far away is nothing, whatever the disk; a wall behind which exp is huge is harmless in 1/(1 + exp).
  CHECK(bounds(apply(Kind::Exp, Rational(-1) * pow(400 * (x - 6), 2)), 1, 1).first < 1e-300);
  CHECK(bounds(1 / (apply(Kind::Exp, Rational(-50) * (x - 9)) + 1), 1, 2).first < 1e-100);
  CHECK(bounds(apply(Kind::Tanh, 50 * x), 5, 1).first < 1e-100);
  for (const Expr e :
       {1 / x, sqrt(x), apply(Kind::Log, x), apply(Kind::Sign, x), apply(Kind::Abs, x), apply(Kind::Step, x)}) {
    CHECK(bounds(e, 0.5, 0.6).second == HUGE_VAL);
    CHECK(bounds(e, 0.5, 0.4).second < 100);
  }
  CHECK(bounds(apply(Kind::Sign, x), 0.5, 0.4).first == 0);
}
