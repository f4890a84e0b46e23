// A variational step says so where a force acts between its nodes.
#include "support.hpp"

#include <doctest/doctest.h>

#include <string>

namespace {

using namespace maupertuis;

struct End {
  double x = 0, v = 0, t = 0;
  Step last;
};

End run_to_its_end(const std::string& text, double q, double v, double end, double step, int order) {
  const Variational m("system m\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n" + text);
  VariationalStepper stepper = m.stepper(step, order);
  stepper.start(0, {&q, 1}, {&v, 1});
  End out;
  while (stepper.time() != end && out.last.ending == StepEnding::None) out.last = stepper.step(end);
  out.x = stepper.q()[0], out.v = stepper.v()[0], out.t = stepper.time();
  return out;
}

const char* const pulse = "force x = 3 exp(-((t - 6)/0.05)^2)\n";

}  // namespace

TEST_CASE("a pulse between the nodes ends the run before it, with the reason; shorter steps see it") {
  for (const int order : {2, 4, 8}) {
    CAPTURE(order);
    const End coarse = run_to_its_end(pulse, 0, 0, 10, 2, order);
    CHECK(coarse.last.ending == StepEnding::NoConvergence);
    CHECK(coarse.last.reason.find("between the nodes") != std::string::npos);
    CHECK(coarse.t <= 6);
    CHECK(coarse.t >= 4);
    CHECK(coarse.x == 0);  // the step that missed it is not kept
  }
  const End fine = run_to_its_end(pulse, 0, 0, 10, 0.01, 6);
  CHECK(fine.last.ending == StepEnding::None);
  CHECK(fine.x == doctest::Approx(1.06347231054330962).epsilon(1e-8));
}

TEST_CASE("a pulse beside gravity, a window and a wall are seen too") {
  CHECK(run_to_its_end("V = 9.81 x\nforce x = 30 exp(-((t - 6)/0.05)^2)\n", 0, 0, 10, 0.5, 4).last.ending ==
        StepEnding::NoConvergence);
  CHECK(run_to_its_end("force x = piecewise(t < 4.25 : 0, t < 4.27 : 30, else : 0)\n", 0, 0, 10, 0.5, 4).last.ending ==
        StepEnding::NoConvergence);
  // A node within the window takes it for half of the step.
  CHECK(run_to_its_end("force x = piecewise(t < 4.1 : 0, t < 4.12 : 30, else : 0)\n", 0, 0, 10, 0.5, 4).last.ending ==
        StepEnding::NoConvergence);
  CHECK(run_to_its_end("V = exp(-((x - 6.3)/0.02)^2)\n", 0, 1, 20, 0.5, 4).last.ending == StepEnding::NoConvergence);
  CHECK(run_to_its_end("force x = sin(400 t)\n", 0, 0, 1, 0.1, 4).last.ending == StepEnding::NoConvergence);
}

TEST_CASE("coarse steps of smooth motions go on, and steps over switches") {
  for (const int order : {2, 4, 6, 8, 10, 12}) {
    CAPTURE(order);
    CHECK(run_to_its_end("V = 1/2 x^2\n", 1, 0, 200, 0.8, order).last.ending == StepEnding::None);
    CHECK(run_to_its_end("V = -cos x\nD = 0.05 x'^2\nforce x = 0.4 cos(0.7 t)\n", 1, 0, 100, 0.5, order).last.ending ==
          StepEnding::None);
    CHECK(run_to_its_end("V = 9.81 x\n", 0, 3, 10, 0.5, order).last.ending == StepEnding::None);
    CHECK(run_to_its_end("force x = -sign(x) - 0.2 x\n", 1, 0, 20, 0.01, order).last.ending == StepEnding::None);
  }
}
