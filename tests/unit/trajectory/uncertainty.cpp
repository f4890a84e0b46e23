#include <maupertuis/trajectory.hpp>
#include <maupertuis/uncertainty.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>

using namespace maupertuis;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What the text says: value, and half the width of the interval.
struct Read {
  double value = 0, error = 0, digits = 0;
};

Read read(const std::string& text) {
  const auto open = text.find('('), close = text.find(')');
  const std::string mantissa = text.substr(0, open), tail = text.substr(close + 1);
  const auto point = mantissa.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  const int power = tail.empty() ? 0 : std::stoi(tail.substr(1));
  return {std::stod(mantissa + "e" + std::to_string(power)),
          std::stod(text.substr(open + 1, close - open - 1) + "e" + std::to_string(power - decimals)),
          static_cast<double>(close - open - 1)};
}

}  // namespace

TEST_CASE("numbers stand with the digits that are certain") {
  CHECK(with_uncertainty(-5.003407250541227, 3e-8) == "-5.00340725(4)");  // 3e-8, and 5e-10 of rounding: up
  CHECK(with_uncertainty(-0.48546178042110844, 9.6e-9) == "-0.48546178(2)");
  CHECK(with_uncertainty(9.9996, 4e-3) == "10.000(5)");
  CHECK(with_uncertainty(9.9996e-9, 4e-12) == "1.0000(5)e-8");  // the leading digit changes with rounding
  CHECK(with_uncertainty(9.99996e-9, 4e-13) == "1.00000(5)e-8");
  CHECK(with_uncertainty(9.7e-9, 1e-9) == "1.0(2)e-8");
  CHECK(with_uncertainty(1234567, 12) == "1.23457(2)e6");
  CHECK(with_uncertainty(-3e-5, 0.004) == "0.000(5)");  // no minus before zero
  CHECK(with_uncertainty(1e-18, 1e-16) == "0(2)e-16");
  CHECK(with_uncertainty(7e-300, 1e-310) == "7.0000000000(1)e-300");
}

TEST_CASE("what is exact has no parentheses, what is lost has no digits") {
  CHECK(with_uncertainty(0.1, 0) == "0.1");
  CHECK(with_uncertainty(-0.0, 0) == "0");
  CHECK(with_uncertainty(1.5, infinity) == "?");
  CHECK(with_uncertainty(1.5, std::nan("")) == "1.5");
  CHECK(with_uncertainty(std::nan(""), 1) == "nan");
}

TEST_CASE("the interval that stands there holds the value and its error, and is at most six times as wide") {
  rc::check([](std::int64_t mantissa, int exponent, int accuracy, bool close) {
    const double value = std::ldexp(static_cast<double>(mantissa % 1'000'000'007), exponent % 60);
    const double error = std::abs(value == 0 ? 1 : value) * std::exp2(-1 - std::abs(accuracy) % 51) * (close ? 1 : 0.7);
    const std::string text = with_uncertainty(value, error);
    const Read found = read(text);
    RC_LOG() << value << " " << error << " " << text;
    RC_ASSERT(found.digits == 1);
    const double slack = 1e-8 * error + 2e-16 * std::abs(value);
    RC_ASSERT(std::abs(found.value - value) + error <= found.error + slack);
    RC_ASSERT(found.error <= 6 * error + slack);
  });
}

TEST_CASE("errors become columns after all others") {
  Trajectory run;
  run.columns = {{"x", "m"}, {"x'", "m/s"}};
  run.times = {0, 1};
  run.values = {1, 2, 3, 4};
  CHECK(to_csv(with_error_columns(run)) == to_csv(run));
  run.errors = {0, 0.25, 0.5, infinity};
  CHECK(to_csv(with_error_columns(run)) ==
        "t [s],x [m],x' [m/s],error(x) [m],error(x') [m/s]\r\n0,1,2,0,0.25\r\n1,3,4,0.5,inf\r\n");
}
