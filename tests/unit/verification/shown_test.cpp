// What a line of `maup test` shows: numbers and tolerances in the unit that was written, and each diagnostic once.
#include "boundary.hpp"

#include <cstdlib>

using namespace maupertuis;

namespace shown_test {
namespace {

const std::string spring = R"(param m = 1 kg, k = 1 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 50 mm
run 1 s
)";

double leading(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

Diagnostics heard(const std::string& text) {
  const ModelText m(text);
  Diagnostics diagnostics;
  verify(m.model, m.equations, m.source, {}, diagnostics);
  return diagnostics;
}

}  // namespace

TEST_CASE("values are shown in the unit that the line uses") {
  for (const std::string digits : {"", "precision quad\n"}) {
    CAPTURE(digits);
    const ExpectationResult r = only(spring + digits + "expect x at 0 s = 52 mm ± 1 mm\n");
    CHECK_FALSE(r.passed);
    CHECK(leading(r.expected) == doctest::Approx(52));
    CHECK(r.expected.substr(r.expected.size() - 3) == " mm");
    CHECK(r.tolerance.find("± 1 mm") == 0);
    CHECK(leading(r.actual) == doctest::Approx(digits.empty() ? 50 : 0.05));
  }
  CHECK(only(spring + "expect x at 0 s = 52 mm ± 1 mm\n").message.find("off by 2 mm") == 0);
}

TEST_CASE("frequencies and their tolerance are shown in hertz where the line is written so") {
  const ExpectationResult r = only(spring + "expect frequencies at x = 0 : 0.16 Hz ± 0.02 Hz\n");
  CHECK(r.passed);
  CHECK(r.tolerance == "± 0.02");
  CHECK(leading(r.actual) == doctest::Approx(0.15915494309189535));
  CHECK(only(spring + "expect frequencies at x = 0 : 0.16 Hz rel 0.02\n").tolerance == "rel 0.02");
}

TEST_CASE("a quantity without drift passes with the tolerance 0") {
  const std::string free = "dimensionless\ncoord x : number\nL = 1/2 x'^2\nstart x' = 1\nrun 1\n";
  passes(free, "expect conserved x' rel 0");
  fails(free, "expect conserved x rel 0");
}

TEST_CASE("an equilibrium on one side of a kink alone is none") {
  const std::string model = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = ";
  passes(model + "x^2 + max(x, 0)^2\n", "expect equilibrium at x = 0 is stable");
  fails(model + "x^2 + max(x, 0)\n", "expect equilibrium at x = 0 is stable");
  fails(model + "x^2 + max(-x, 0)\n", "expect equilibrium at x = 0 is stable");
}

TEST_CASE("a model without a run is not run for lines that need none") {
  CHECK(heard("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nexpect equation x'' = -x\n").items().empty());
}

TEST_CASE("a run that cannot start says so once, whatever lines need it") {
  const std::string torn =
      "dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + 1/2 y'^2\nconstraint x^2 + y^2 = -1\nstart x = 1\nrun until "
      "x = 2 within 3\n";
  const std::string lines[] = {"expect until at 1 ± 1\n", "expect x at 1 = 1 ± 1\n",
                               "expect energy conserved rel 1e-3\n"};
  for (const std::string& text :
       {lines[0], lines[1], lines[2], lines[0] + lines[1], lines[0] + lines[2], lines[0] + lines[1] + lines[2]}) {
    CAPTURE(text);
    std::size_t errors = 0;
    const Diagnostics diagnostics = heard(torn + text);
    for (const Diagnostic& d : diagnostics.items()) errors += d.severity == Severity::Error;
    CHECK(errors == 1);
  }
}

TEST_CASE("an equation that a mistake would make empty explains no claim") {
  // Without its damping the row of y would be 0 = 0.
  const std::string model = "dimensionless\nparam c = 2\ncoord x, y : number\nT = 1/2 x'^2\nD = 1/2 c y'^2\n";
  for (const char* claim : {"claim y' = 1", "claim c = 1"}) {
    const ExpectationResult r = only(model + claim + "\n");
    CHECK_FALSE(r.passed);
    CHECK_MESSAGE(r.pitfall.empty(), claim << ": " << r.pitfall);
  }
}

}  // namespace shown_test
