#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <cmath>

/// A damper that takes all that arrives, beside d'Alembert's solution: what fits the end in no higher derivative stays
/// in the mesh, and its error has to be told.
using namespace maupertuis;

TEST_CASE("waves into a damper that matches the string: estimates hold starts that do not fit it") {
  // u = (f(x − t) + f(x + t))/2 with f odd about 0 and nothing from beyond 1.
  const auto f = [](double x) {
    const double a = std::abs(x);
    return a >= 1 ? 0 : std::copysign(a * a * a * (1 - a) * (1 - a), x);
  };
  const auto exact = [&](double x, double t) { return (f(x - t) + f(x + t)) / 2; };
  Study study(SourceText("matched.lag",
                         "dimensionless\nfield u(x) : number on x = 0 .. 1\nboundary left : u = 0\n"
                         "density = 1/2 u'^2 - 1/2 u_x^2\nD = 1/2 u(1)'^2\nstart u = x^3 (1 - x)^2\nrun 3\n"
                         "expect u(0.6) at 0.7 = 0 ± 1\nexpect u(0.3) at 0.9 = 0 ± 1\nexpect u(0.1) at 2.9 = 0 ± 1\n"
                         "expect u(0.8) at 1.3 = 0 ± 1\n"));
  REQUIRE(study.field_equations());
  std::vector<FieldQuestion> questions;
  for (const Expectation& e : study.model()->experiment.expectations) {
    const auto& at = std::get<expectation::ValueAt>(e.kind);
    questions.push_back({at.subject, false, evaluate(at.time, {})});
  }
  FieldRunOptions options;
  options.duration = 3;
  const auto run = run_coupled(*study.model(), *study.field_equations(), questions, options, study.diagnostics());
  REQUIRE(run);
  const double places[] = {0.6, 0.3, 0.1, 0.8};
  CHECK(exact(0.6, 0.7) == doctest::Approx(-0.000405).epsilon(1e-12));
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(places[i]);
    CHECK(std::abs(run->answers[i].value - exact(places[i], questions[i].time)) <= run->answers[i].error);
    CHECK(run->answers[i].error < 1e-3);
  }
}
