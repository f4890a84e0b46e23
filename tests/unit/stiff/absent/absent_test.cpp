// Of a build without SUNDIALS.
#include "../../model_text.hpp"

#include <maupertuis/simulation.hpp>
#include <maupertuis/stiff.hpp>

using namespace maupertuis;

TEST_CASE("without SUNDIALS the stiff method is refused with its reason") {
  CHECK_FALSE(has_stiff_method());
  ModelText m("system oscillator\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\n");
  SimulationOptions options;
  options.duration = 1;
  options.method = StepMethod::Stiff;
  CHECK_FALSE(simulate(m.model, m.equations, options, m.diagnostics));
  REQUIRE(m.diagnostics.items().size() == 1);
  CHECK(m.diagnostics.items()[0].code == "E0723");
}
