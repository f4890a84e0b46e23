#include <maupertuis/degenerate.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

TEST_CASE("What has no inertia takes part in the shapes of modes") {
  // Maxwell's element: 0.5 y' = x − y, so that x'' = −(x − y) and a motion exp(−t) has y = 2 x; a translation moves
  // both. Two springs in series, k and K: y = k x/(k + K).
  struct Known {
    const char* text;
    double ratio;  // y/x of the last mode
  };
  for (const Known& known : {Known{"T = 1/2 x'^2\nV = 1/2 (x - y)^2\nD = 1/2*0.5*y'^2\nstart x = 1\n", 2},
                             Known{"T = 1/2 x'^2\nV = 1/2 (x - y)^2 + 1/2*3*y^2\nstart x = 1\n", 0.25}}) {
    Study study(SourceText("massless.lag", std::string("dimensionless\ncoord x, y : number\n") + known.text));
    REQUIRE(study.equations());
    PointEquations at(solvable_equations(*study.equations()));
    Diagnostics diagnostics;
    const Expr zero = study.model()->system.context->number(0);
    const auto result =
        modal_study_at(at, {0, {0, 0}, {0, 0}}, {{0, 0, zero, {}, {}}, {1, 0, zero, {}, {}}}, diagnostics);
    REQUIRE(result);
    REQUIRE(!result->entries.empty());
    const Mode& last = result->entries.front().analysis.modes.back();
    CHECK(std::abs(last.shape[1] / last.shape[0] - known.ratio) < 1e-6);
  }
}
