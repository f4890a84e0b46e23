#include "boundary.hpp"

#include <maupertuis/verification.hpp>

using namespace maupertuis;

namespace {

const std::string disk = R"(param m = 1 kg, R = 20 cm
coord x, y : length
coord φ, ψ : angle
T = 1/2 m (x'^2 + y'^2) + 1/4 m R^2 φ'^2 + 1/8 m R^2 ψ'^2
constraint x' = R φ' cos ψ name along
constraint y' = R φ' sin ψ name across
)";
const std::string straight = R"(param m = 1 kg, R = 20 cm, v = 1 m/s
coord x, y : length, φ : angle
T = 1/2 m (x'^2 + y'^2) + 1/4 m R^2 φ'^2
constraint x' = R φ' name roll
constraint y = v t name belt
)";

}  // namespace

TEST_CASE("classes and freedoms are judged by the analysis") {
  CHECK(only(disk + "expect freedoms = 4\n").passed);
  CHECK(only(disk + "expect constraint along is nonholonomic\n").passed);
  CHECK(only(disk + "expect constraint across is scleronomic\n").passed);
  CHECK(only(straight + "expect freedoms = 1\n").passed);
  CHECK(only(straight + "expect constraint roll is integrable\n").passed);
  CHECK(only(straight + "expect constraint roll is holonomic\n").passed);
  CHECK(only(straight + "expect constraint belt is holonomic\n").passed);
  CHECK(only(straight + "expect constraint belt is rheonomic\n").passed);
}

TEST_CASE("wrong classes and counts fail, with what is true") {
  const ExpectationResult count = only(disk + "expect freedoms = 2\n");
  CHECK_FALSE(count.passed);
  CHECK(count.actual == "4");
  CHECK(count.message.find("at an instant are 2") != std::string::npos);
  const ExpectationResult rolling = only(disk + "expect constraint along is holonomic\n");
  CHECK_FALSE(rolling.passed);
  CHECK(rolling.actual == "non-holonomic");
  CHECK_FALSE(only(disk + "expect constraint along is integrable\n").passed);
  CHECK_FALSE(only(disk + "expect constraint along is rheonomic\n").passed);
  CHECK_FALSE(only(straight + "expect constraint roll is nonholonomic\n").passed);
  CHECK_FALSE(only(straight + "expect constraint belt is integrable\n").passed);
  CHECK_FALSE(only(straight + "expect constraint belt is scleronomic\n").passed);
}
