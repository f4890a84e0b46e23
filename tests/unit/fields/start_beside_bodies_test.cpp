#include "questions.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// What carries mass starts as written, whatever the elements beside it can follow; what does not is told.
using namespace maupertuis;

namespace {

struct ToldRun {
  std::vector<FieldRunResult::Value> values;
  std::string codes;  // of what the run told
  std::string told;
};

ToldRun answers_of(const std::string& text) {
  Study study(SourceText("start.lag", "dimensionless\n" + text));
  REQUIRE_MESSAGE(study.field_equations(), text);
  FieldRunOptions options;
  options.duration = 0.5;
  Diagnostics told;
  const auto run = run_coupled(*study.model(), *study.field_equations(), questions_of(study), options, told);
  REQUIRE_MESSAGE(run, text);
  ToldRun out{run->answers, "", ""};
  for (const Diagnostic& d : told.items()) out.codes += d.code, out.told += d.message + "\n";
  return out;
}

/// A mass of 3 at the tip of a beam of EI = 2 and length 1, ω = sqrt(3 EI/(m l³)) = sqrt 2.
const std::string light_beam =
    "field w(x) : number on x = 0 .. 1 cells 2 order 5\nboundary left : w = 0, w_x = 0\ndensity = -w_xx^2\n";

}  // namespace

TEST_CASE("a mass on a beam without mass starts where the start says, in whatever shape") {
  const double ω = std::sqrt(2.0), swing = std::cos(ω / 2), of_rate = std::sin(ω / 2) / ω;
  const std::string asked = "expect w(1) at 0 = 0 ± 9\nexpect w(1) at 0.5 = 0 ± 9\nexpect w(1/2) at 0.5 = 0 ± 9\n";
  for (const char* shape : {"0.1", "0.1 x", "0.1 sin(pi x/2)", "0.1 abs(2 x - 1)", "0.1 x^2 (3 - x)/2"}) {
    const ToldRun of_start = answers_of(light_beam + "T = 3/2 w(1)'^2\nstart w = " + shape + "\n" + asked);
    CHECK(of_start.values[0].value == 0.1);
    CHECK(of_start.values[1].value == doctest::Approx(0.1 * swing).epsilon(1e-12));
    CHECK(of_start.values[2].value == doctest::Approx(0.1 * swing * 5 / 16).epsilon(1e-12));
    CHECK(of_start.values[2].error < 1e-13);
    CHECK(of_start.codes == (std::string(shape) == "0.1 x^2 (3 - x)/2" ? "" : "N0662"));
    const ToldRun of_rates = answers_of(light_beam + "T = 3/2 w(1)'^2\nstart w' = " + shape + "\n" + asked);
    CHECK(of_rates.values[1].value == doctest::Approx(0.1 * of_rate).epsilon(1e-12));
  }
}

TEST_CASE("beams of any length start with the slopes of their start") {
  for (const std::string l : {"1e-4", "1e-9", "1e6"}) {
    CAPTURE(l);
    const ToldRun run = answers_of("param l = " + l +
                                   "\nfield w(x) : number on x = 0 .. l cells 2 order 5\n"
                                   "boundary left : w = 0, w_x = 0\n"
                                   "density = w_t^2/l^3 - l w_xx^2\nT = 3/2 (w(l)'/l)^2\n"
                                   "start w = l/20 (x/l)^2 (3 - x/l)\n"
                                   "expect w(l)/l at 0 = 0 ± 9\nexpect w(l/2)/l at 0 = 0 ± 9\n"
                                   "expect w_x(l/2) at 0 = 0 ± 9\nexpect w_x(l) at 0 = 0 ± 9\n");
    const double expected[] = {0.1, 0.1 * 5 / 16, 0.1125, 0.15};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(run.values[i].value - expected[i]) < 1e-13);
      CHECK(run.values[i].error < 1e-12);
    }
    CHECK(run.codes == "");
  }
}

TEST_CASE("a start that steepens like a power of less than two at a clamp does not clash with it") {
  const ToldRun run = answers_of(
      "field w(x) : number on x = 0 .. 1 cells 2 order 5\n"
      "boundary left : w = 0, w_x = 0\ndensity = w_t^2 - w_xx^2\nT = 3/2 w(1)'^2\n"
      "start w = 0.1 x^(3/2)\nexpect w(1) at 0 = 0 ± 9\n");
  CHECK(run.values[0].value == 0.1);
  CHECK(run.codes.find("W0646") == std::string::npos);
}

TEST_CASE("the inertia of a slope, and a coordinate that a light beam is tied to, start as written") {
  const ToldRun slope = answers_of(light_beam + "T = 1/2 w_x(1)'^2\nstart w = 0.1 sin(pi x), w' = 0.1 x\n" +
                                   "expect w_x(1) at 0 = 0 ± 9\nexpect w_x(1)' at 0 = 0 ± 9\n");
  CHECK(slope.values[0].value == doctest::Approx(-0.1 * std::acos(-1.0)).epsilon(1e-15));
  CHECK(slope.values[1].value == doctest::Approx(0.1).epsilon(1e-15));
  const ToldRun tied = answers_of(light_beam + "coord y : number\nT = 3/2 y'^2\nconstraint w(1) = y\n" +
                                  "start w = x^2, y = 0.1\nexpect y at 0 = 0 ± 9\nexpect w(1) at 0 = 0 ± 9\n");
  CHECK(tied.values[0].value == doctest::Approx(0.1).epsilon(1e-14));
  CHECK(tied.values[1].value == doctest::Approx(0.1).epsilon(1e-14));
  CHECK(tied.codes == "N0662");
  CHECK(tied.told.find("w = 0.1 beside 1 at x = 1") != std::string::npos);
}

TEST_CASE("a slope that the start has at a clamp is told beside bodies too, and bodies keep theirs") {
  const std::string beam =
      "field w(x) : number on x = 0 .. 1 cells 4 order 7\ndensity = 1/2 w'^2 - w_xx^2\nT = 1/20 w_x(1)'^2\n";
  const ToldRun clamped = answers_of(beam + "boundary left : w = 0, w_x = 0\nstart w = 0.1 sin(pi x), w' = 0.1 x\n" +
                                     "expect w_x(1) at 0 = 0 ± 9\nexpect w_x(1)' at 0 = 0 ± 9\n");
  CHECK(clamped.codes == "W0646W0646");
  CHECK(clamped.told.find("w_x = 0.314159 beside 0") != std::string::npos);
  CHECK(clamped.told.find("w_tx = 0.1 beside 0") != std::string::npos);
  CHECK(clamped.values[0].value == doctest::Approx(-0.1 * std::acos(-1.0)).epsilon(1e-15));
  CHECK(clamped.values[1].value == doctest::Approx(0.1).epsilon(1e-15));
  const std::string hinged = beam + "boundary left : w = 0\nstart w = 0.1 sin(pi x)\n";
  CHECK(answers_of(hinged + "expect w_x(1) at 0 = 0 ± 9\n").codes.empty());
  // The slope of |x| at the end where it has its kink is the one inside.
  CHECK(answers_of(beam + "boundary left : w = 0, w_x = 0\nstart w = 0.1 abs(x)\nexpect w(1) at 0 = 0 ± 9\n").codes ==
        "W0646");
}

TEST_CASE("a kink at a mass on a string is one of waves only where the string has mass") {
  const auto codes = [](const std::string& inertia) {
    return answers_of("field u(x) : number on x = 0 .. 2 cells 4 order 3\nboundary u = 0\ndensity = " + inertia +
                      " - 1/2 u_x^2\nT = 1/2 u(1)'^2\nstart u = 0.1 (1 - abs(x - 1))\nexpect u(1) at 0.5 = 0 ± 9\n");
  };
  CHECK(codes("1/2 u'^2").codes == "W0651");
  const ToldRun light = codes("0");
  CHECK(light.codes.empty());
  CHECK(light.values[0].value == doctest::Approx(0.1 * std::cos(std::sqrt(2.0) / 2)).epsilon(1e-12));
  CHECK(light.values[0].error < 1e-13);
}

TEST_CASE("frequencies of a model with fields that name no field are told how to be asked for") {
  Study study(SourceText("f.lag",
                         "dimensionless\nfield u(x) : number on x = 0 .. 1 boundary u = 0\n"
                         "density = 1/2 u'^2 - 1/2 u_x^2\nexpect frequencies : pi rel 1e-9\n"));
  REQUIRE(study.verification());
  REQUIRE(study.verification()->results.size() == 1);
  CHECK(study.verification()->results[0].message.find("`expect frequencies of u : …`") != std::string::npos);
}
