// How often a report wants rows.
#include <maupertuis/report.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("a report asks for rows as an animation needs them, unless someone said otherwise") {
  Model model;
  model.system.context = std::make_shared<Context>();
  Context& c = *model.system.context;
  model.experiment.duration = c.number(100);
  CHECK(report_run(model, {}).output_every.value() == doctest::Approx(0.02));
  model.experiment.duration = c.number(100000);
  CHECK(report_run(model, {}).output_every.value() == doctest::Approx(10));
  SimulationOptions options;
  options.output_every = 3;
  CHECK(report_run(model, options).output_every == 3.0);
  options = {};
  options.duration = -2;
  CHECK(report_run(model, options).output_every.value() == doctest::Approx(0.002));
  model.experiment.output_every = c.number(1);
  CHECK_FALSE(report_run(model, {}).output_every);
}
