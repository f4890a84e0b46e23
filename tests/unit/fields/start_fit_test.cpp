#include "questions.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

/// Starts that do not fit what stands at an end, against exact motions.
using namespace maupertuis;

namespace {

/// A start u between a held end at 0 and one at 1 with D = ½ d u(1)'²: u = F(t + x) − F(t − x), F = u/2 odd to 1, and
/// (1 + d) F'(s) = (d − 1) F'(s − 2) beyond, which a start with u(1) = 0 leaves as F(s) = (d − 1)/(d + 1) F(s − 2).
double with_dashpot(double x, double t, double d, double (*start)(double)) {
  const auto f = [&](double s) {
    double factor = 0.5;
    for (; s > 1; s -= 2) factor *= (d - 1) / (d + 1);
    return factor * (s < 0 ? -start(-s) : start(s));
  };
  return f(t + x) - f(t - x);
}

void check_estimates(const std::string& mesh, double d, const std::string& text, double (*start)(double)) {
  std::string model = fmt::format(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 {}\nboundary left : u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\nD = 1/2*{} u(1)'^2\nstart u = {}\nrun 3\n",
      mesh, d, text);
  const std::pair<double, double> asked[] = {{0.6, 0.7}, {0.1, 2.9}, {0.37, 1.2}, {1, 2.6}, {0.85, 0.3}, {0.5, 2}};
  for (const auto& [x, t] : asked) model += fmt::format("expect u({}) at {} = 0 ± 1\n", x, t);
  Study study(SourceText("ends.lag", model));
  REQUIRE(study.field_equations());
  const std::vector<FieldQuestion> questions = questions_of(study);
  FieldRunOptions options;
  options.duration = 3;
  const auto run = run_coupled(*study.model(), *study.field_equations(), questions, options, study.diagnostics());
  REQUIRE(run);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const auto& [x, t] = asked[i];
    CAPTURE(text);
    CAPTURE(mesh);
    CAPTURE(x);
    CHECK(std::abs(run->answers[i].value - with_dashpot(x, t, d, start)) <= run->answers[i].error);
    CHECK(run->answers[i].error < 2e-2);
  }
}

}  // namespace

TEST_CASE("a start that does not fit a dashpot at an end in a higher derivative") {
  for (const std::string mesh : {"", "cells 4 order 6", "cells 12 order 4"})
    for (const double d : {1.0, 0.5}) {
      check_estimates(mesh, d, "x^3 (1 - x)^2", [](double x) { return x * x * x * (1 - x) * (1 - x); });
      check_estimates(mesh, d, "sin(pi x)^2", [](double x) { return std::pow(std::sin(std::numbers::pi * x), 2); });
    }
}
