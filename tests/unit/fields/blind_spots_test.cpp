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

TEST_CASE("a value without a time is that of the rest where nothing moves, with loads at places too") {
  const auto result = [](const std::string& load, const std::string& line) {
    Study study(SourceText("field.lag",
                           "dimensionless\nparam EI = 5, P = 10, L = 1\nfield w(x) : number on x = 0 .. L\n"
                           "boundary w = 0\n" +
                               load + line + "\n"));
    const auto verification = study.verification();
    REQUIRE(verification);
    return verification->results.at(0);
  };
  const std::string beam = "density = -1/2 EI w_xx^2\n", at_middle = "force w(L/2) = -P\n";
  CHECK(result(beam + at_middle, "expect w(L/2) = -P L^3/(48 EI)").passed);
  CHECK(result(beam + "V = P w(L/2)\n", "expect w(L/4) = -11*P L^3/(768 EI)").passed);
  CHECK(result("density = -1/2 EI w_xx^2 - P/L w\n", "expect w(L/2) = -5*P L^3/(384 EI)").passed);
  CHECK(result(beam + at_middle, "expect total w = -5*P L^4/(384 EI) ± 1e-9").passed);
  for (const char* wrong : {"expect w(L/2) = 0", "expect w(L/2) = P L^3/(48 EI)",
                            "expect w(L/2) at 1 = -P L^3/(48 EI) ± 1e-9", "expect energy conserved"}) {
    const ExpectationResult r = result(beam + at_middle + "run 2\n", wrong);
    INFO(wrong, " | ", r.message);
    CHECK_FALSE(r.passed);
    CHECK_FALSE(r.message.empty());
  }
  // A mass on a field that has none does move, which is another question.
  const ExpectationResult moving =
      result("density = -1/2 EI w_xx^2\nT = 1/2 w(L/2)'^2\nstart w = 0\nrun 1\n", "expect w(L/2) at 1 = 0 ± 1");
  CHECK(moving.message.find("nothing moves") == std::string::npos);
}
