/// Claims about fields that are wrong where no point comes by itself.
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {

bool line_holds(const std::string& model, const std::string& line) {
  Study study(SourceText("field.lag", "dimensionless\n" + model + line + "\n"));
  const auto verification = study.verification();
  REQUIRE(verification);
  REQUIRE(verification->results.size() == 1);
  INFO(line, ": ", verification->results.front().actual, " | ", verification->results.front().message);
  CHECK_FALSE(verification->results.front().message.empty());
  return verification->results.front().passed;
}

const std::string line_of_waves = "field u(x) : number on x = 0 .. 10 cells 20\ndensity = 1/2 u'^2 - 1/2 u_x^2";
const std::string start = "\nstart u = cos(x)\nrun 10\n";

}  // namespace

TEST_CASE("a solution is one at all times, and for all sizes") {
  CHECK(line_holds(line_of_waves + start, "expect solution u = cos(x) cos(t)"));
  CHECK_FALSE(line_holds(line_of_waves + start, "expect solution u = cos(x) cos(t) + x t^2 step(t - 3)"));
  CHECK_FALSE(line_holds(line_of_waves + start, "expect solution u = cos(x) cos(t) + exp(-((t - 8)/0.1)^2)"));
  CHECK_FALSE(line_holds(line_of_waves + " - (1 - cos u)\nstart u = 0\nrun 1\n",
                         "expect solution u = 1e-6 cos(x) cos(sqrt(2) t)"));
  // At the values of the model alone.
  const std::string faster = "param w = 2\n" + line_of_waves + start;
  CHECK(line_holds(faster, "expect solution u = cos(2 x) cos(w t)"));
  CHECK_FALSE(line_holds(faster, "expect solution u = cos(3 x) cos(w t)"));
}

TEST_CASE("equations and currents are tested in every piece of a density") {
  const std::string pieces =
      line_of_waves + " - piecewise(u > 0 : u log(u), u > -5 : 0, else : (u+5)^2)\nstart u = 1\nrun 1\n";
  CHECK(
      line_holds(pieces, "expect equation u'' - u_xx + piecewise(u > 0 : log(u) + 1, u > -5 : 0, else : 2 (u+5)) = 0"));
  CHECK_FALSE(line_holds(
      pieces, "expect equation u'' - u_xx + piecewise(u > 0 : log(u) + 1, u > -5 : 0, else : 20 (u+5)) = 0"));
  const std::string energy = "expect current 1/2 u'^2 + 1/2 u_x^2 + piecewise(u > 0 : u log(u), u > -5 : 0, else : ";
  CHECK(line_holds(pieces, energy + "(u+5)^2) flux -u' u_x"));
  CHECK_FALSE(line_holds(pieces, energy + "7 (u+5)^2) flux -u' u_x"));
}
