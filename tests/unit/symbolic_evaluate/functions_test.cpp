// Every row of the table of functions, and every family of kinds, against ways that do not read the table.
#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/functions.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/jet_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"
#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

#include <boost/math/special_functions/lambert_w.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace maupertuis;
using evaluation::Real100;

namespace {

std::vector<Kind> functions_of_the_table() {
  std::vector<Kind> kinds;
  std::apply([&](const auto&... row) { (kinds.push_back(row.kind), ...); }, functions::rows);
  return kinds;
}

/// A number in the domain of the function.
Rational inside(Kind kind) { return kind == Kind::Acosh ? Rational(17, 10) : Rational(3, 10); }

Real100 at_100_digits(Expr e, Expr x, const Real100& value) {
  const evaluation::Tape tape({&e, 1});
  evaluation::RealNumbers<Real100> numbers([&](Expr s) {
    REQUIRE(s == x);
    return value;
  });
  std::vector<Real100> values;
  evaluation::run(tape, numbers, values);
  return values[tape.roots()[0]];
}

}  // namespace

TEST_CASE("the derivative of every function is its difference quotient, to 60 digits") {
  for (const Kind kind : functions_of_the_table()) {
    CAPTURE(std::string(name_of(kind)));
    Context c;
    const Expr x = c.symbol("x", Role::Coordinate), f = apply(kind, x);
    const Real100 at = evaluation::real100_from(inside(kind)), h("1e-32");
    const Real100 quotient = (at_100_digits(f, x, at + h) - at_100_digits(f, x, at - h)) / (2 * h);
    const Real100 derivative = at_100_digits(differentiate(f, x), x, at);
    CHECK(derivative != 0);
    CHECK(abs(quotient - derivative) < Real100("1e-60"));
  }
}

TEST_CASE("half-integer powers in 100 digits are those by logarithm and exponential, and their intervals hold them") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate);
  const Real100 at = evaluation::real100_from(Rational(3, 10));
  for (const int n : {-5, -3, -1, 1, 3, 5, 201}) {
    CAPTURE(n);
    const Expr power = pow(x, Rational(n, 2));
    const Real100 exact = exp(Real100(n) / 2 * log(at));
    CHECK(abs(at_100_digits(power, x, at) / exact - 1) < Real100("1e-95"));
    const evaluation::Tape tape({&power, 1});
    evaluation::RealNumbers<evaluation::Interval<Real100>> numbers([&](Expr) {
      return evaluation::Interval<Real100>{at, at};
    });
    std::vector<evaluation::Interval<Real100>> values;
    evaluation::run(tape, numbers, values);
    const auto& range = values[tape.roots()[0]];
    CHECK((range.low <= exact && exact <= range.high));
    CHECK(range.high - range.low < exact * Real100("1e-80"));
    CHECK(isnan(at_100_digits(power, x, Real100(-1))));
  }
}

TEST_CASE("values of every function in double and as intervals agree with 100 digits") {
  using Range = evaluation::Interval<double>;
  for (const Kind kind : functions_of_the_table()) {
    CAPTURE(std::string(name_of(kind)));
    const double x = inside(kind).to_double(), value = functions::value(kind, x);
    const Real100 exact = functions::value(kind, Real100(x));
    CHECK(std::abs(static_cast<double>(exact - value)) <= 4e-16 * std::abs(value));
    const Range range = functions::value(kind, Range{x - 1e-9, x + 1e-9});
    CHECK(range.low <= functions::value(kind, x - 1e-9));
    CHECK(range.high >= functions::value(kind, x + 1e-9));
    CHECK(range.high - range.low < 1e-7);
  }
}

TEST_CASE("the exact number of every row, and its parity") {
  for (const Kind kind : functions_of_the_table()) {
    CAPTURE(std::string(name_of(kind)));
    Context c;
    const auto [at, exactly, parity] =
        functions::of_row(kind, [](const auto& row) { return std::tuple(row.at, row.exactly, row.parity); });
    CHECK(functions::value(kind, static_cast<double>(at)) == exactly);
    CHECK(apply(kind, c.number(at)) == c.number(exactly));
    if (parity == Parity::None) continue;
    const Expr x = c.symbol("x", Role::Coordinate);
    CHECK(apply(kind, -x) == (parity == Parity::Odd ? -apply(kind, x) : apply(kind, x)));
    CHECK(functions::value(kind, -0.3) == (parity == Parity::Odd ? -1 : 1) * functions::value(kind, 0.3));
  }
}

TEST_CASE("the series of the certificate, by rules of their own, have the derivatives of the table") {
  using evaluation::FieldNumbers;
  using FieldJet = evaluation::Jet<FieldNumbers::Value>;
  for (const Kind kind : functions_of_the_table()) {
    CAPTURE(std::string(name_of(kind)));
    Context c;
    const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
    const Expr f = apply(kind, sqrt(x * x + y * y) * Rational(2, 3) + Rational(1)), first = differentiate(f, x),
               second = differentiate(first, x);
    const auto roots = evaluation::flatten_arguments(std::array{f, first, second});
    const auto tape = evaluation::Tape::with_gaussians(roots);
    const auto hints = evaluation::field_hints(tape);
    int points = 0;
    for (std::uint64_t attempt = 1; attempt < 2000 && points < 3; ++attempt) {
      try {
        FieldNumbers numbers(evaluation::random_prime_triple(hints.m, attempt / 50), hints, evaluation::mix(attempt));
        evaluation::JetNumbers<FieldNumbers> jets(numbers, 3, [&](Expr s) {
          FieldJet out;
          out(0, 0) = numbers.symbol(s);
          if (s == x) out(0, 1) = out(1, 0) = numbers.number(1);
          return out;
        });
        std::vector<FieldJet> values;
        evaluation::run(tape, jets, values);
        const FieldJet &of_f = values[tape.roots()[0]], &of_first = values[tape.roots()[1]],
                       &of_second = values[tape.roots()[2]];
        CHECK(of_f(0, 1) == of_first(0, 0));
        CHECK(of_f(1, 0) == of_first(0, 0));
        CHECK(of_f(1, 1) == of_second(0, 0));
        CHECK(numbers.multiply(of_f(0, 2), numbers.number(2)) == of_second(0, 0));
        ++points;
      } catch (const evaluation::Redraw&) {
      }
    }
    CHECK(points == 3);
  }
}

TEST_CASE("identities of erf and of Lambert's W") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), a = c.symbol("a", Role::Parameter);
  const auto w = [](Expr e) { return apply(Kind::LambertW, e); };
  const auto exp = [](Expr e) { return apply(Kind::Exp, e); };
  const auto log = [](Expr e) { return apply(Kind::Log, e); };
  const auto erf = [](Expr e) { return apply(Kind::Erf, e); };
  const auto is_zero = [](Expr e) { return zero_test(e).verdict == Verdict::Zero; };
  CHECK(is_zero(w(x) * exp(w(x)) - x));
  CHECK(is_zero(pow(w(x), Rational(2)) * exp(2 * w(x) + a) - x * x * exp(a)));
  CHECK(is_zero(log(w(a)) - log(a) + w(a)));
  CHECK(is_zero(differentiate(w(x), x) * x * (w(x) + Rational(1)) - w(x)));
  CHECK(is_zero(differentiate(erf(a * x), x) - 2 * a / sqrt(c.pi()) * exp(-a * a * x * x)));
  CHECK(is_zero(erf(x - a) + erf(a - x)));
  CHECK(is_zero(erf((x + a) * (x - a)) - erf(x * x - a * a)));
  for (const Expr& e :
       {w(x) * exp(w(x)) - 2 * x, w(x) - x, log(w(a)) - log(a) - w(a), erf(x) - x, erf(2 * x) - 2 * erf(x),
        differentiate(erf(x), x) - exp(-x * x), w(-x) + w(x), erf(x) - apply(Kind::Tanh, x)})
    CHECK(zero_test(e).verdict == Verdict::Nonzero);
}

namespace {

// erf(x) by its alternating series, whose terms are up to exp(x²) times as large as their sum.
Real100 alternating_erf(double at) {
  using Long = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<400>, boost::multiprecision::et_off>;
  const Long x = at;
  Long power = x, sum = x;
  for (int n = 1; n < 2000; ++n) {
    power *= -x * x / n;
    sum += power / (2 * n + 1);
  }
  return Real100(2 * sum / sqrt(boost::math::constants::pi<Long>()));
}

}  // namespace

TEST_CASE("the error function up to where it is 1, against another series in 400 digits") {
  for (const double x : {1e-300, 1e-60, 1e-3, 0.4, 0.5, 0.9999, 1.7, 3.1415, 7.3, 11.0, 15.2, 15.3}) {
    CAPTURE(x);
    const Real100 exact = alternating_erf(x);
    CHECK(abs(error_function(Real100(x)) - exact) <= Real100("1e-98") * exact);
    CHECK(error_function(Real100(-x)) == -error_function(Real100(x)));
  }
  CHECK(error_function(Real100(0)) == 0);
  CHECK(error_function(Real100(1e300)) == 1);
  CHECK(error_function(std::numeric_limits<Real100>::infinity()) == 1);
  CHECK(isnan(error_function(std::numeric_limits<Real100>::quiet_NaN())));
}

TEST_CASE("Lambert's W on its whole domain, against Boost with 100 digits") {
  using Quiet = boost::math::policies::policy<boost::math::policies::domain_error<boost::math::policies::ignore_error>>;
  for (const double x : {-0.36787944117144228, -0.3678794411714, -0.367877, -0.3678767, -0.36787, -0.36, -0.2, -1e-3,
                         -1e-17, 1e-300, 5e-9, 0.1, 1.0, 2.8, 50.0, 1e10, 1e300}) {
    CAPTURE(x);
    const Real100 exact = boost::math::lambert_w0(Real100(x), Quiet());
    const double w = lambert_w(x);
    CHECK(abs(exact - w) <= Real100(2) * (std::nextafter(std::abs(w), 1e308) - std::abs(w)));
    CHECK(abs(lambert_w(Real100(x)) - exact) * (1 + exact) <= Real100("1e-95") * abs(exact) * (1 + abs(exact)));
  }
  CHECK(std::isnan(lambert_w(-0.36787944117144239)));
  CHECK(std::isnan(lambert_w(-2.0)));
  CHECK(std::isnan(lambert_w(std::nan(""))));
  CHECK(lambert_w(0.0) == 0);
  CHECK(std::isinf(lambert_w(std::numeric_limits<double>::infinity())));
  CHECK(isnan(lambert_w(Real100(-0.36787944117144239))));
}
