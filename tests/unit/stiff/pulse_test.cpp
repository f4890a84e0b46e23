// Steps do not jump over what acts between the points at which they look at forces.
#include "../model_text.hpp"
#include "simulation/function_kernels.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/stiff.hpp>

#include <cmath>

namespace {

using namespace maupertuis;

struct End {
  double x = 0, v = 0, t = 0;
  std::size_t steps = 0, rejected = 0;
  StepEnding ending = StepEnding::None;
};

End run(const std::string& text, double q, double v, double end, double tolerance = 1e-10) {
  const ModelText m("system m\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n" + text);
  StiffOptions options;
  options.tolerance = tolerance;
  options.maximum_steps = 200000;
  StiffStepper stepper(motion_functions(m.equations, {{}, {}, {m.equations.power}}), parameter_values(*m.system),
                       options);
  stepper.start(0, {&q, 1}, {&v, 1});
  End out;
  while (stepper.time() != end && out.ending == StepEnding::None) out.ending = stepper.step(end).ending;
  out.x = stepper.q()[0], out.v = stepper.v()[0], out.t = stepper.time();
  out.steps = stepper.steps(), out.rejected = stepper.rejected();
  return out;
}

}  // namespace

TEST_CASE("a pulse on a particle at rest: error functions") {
  const End end = run("force x = 3 exp(-((t - 6)/0.05)^2)\n", 0, 0, 10);
  CHECK(end.ending == StepEnding::None);
  CHECK(end.x == doctest::Approx(1.06347231054330962).epsilon(1e-10));
  CHECK(end.v == doctest::Approx(0.265868077635827404).epsilon(1e-10));
}

TEST_CASE("a pulse of 1e-4 where time in double is known to 1e-13 costs no thousands of steps") {
  const End end = run("force x = 1000 exp(-((t - 1000.3)/0.0001)^2)\n", 0, 0.1, 2000, 1e-12);
  CHECK(end.ending == StepEnding::None);
  CHECK(end.v == doctest::Approx(0.1 + 0.1772453850905516).epsilon(1e-8));  // 0.1 sqrt(pi)
  CHECK(end.x == doctest::Approx(200 + 0.1772453850905516 * 999.7).epsilon(1e-8));
  CHECK(end.steps < 1000);
}

TEST_CASE("a wall of 1e-4, far away") {
  // Turned back at x = 300 - 1e-4 sqrt(log 10); Taylor's steps tell where it is then.
  const End end = run("V = 5 exp(-((x - 300)/0.0001)^2)\n", 0, 1, 400, 1e-12);
  CHECK(end.x == doctest::Approx(199.99978098).epsilon(1e-9));
  CHECK(end.v == doctest::Approx(-1).epsilon(1e-8));
}

TEST_CASE("a window of 0.02, a wall and a gate of place") {
  const End window = run("force x = piecewise(t < 4 : 0, t < 4.02 : 30, else : 0)\n", 0, 0, 12);
  CHECK(window.rejected > 0);
  CHECK(window.v == doctest::Approx(0.6).epsilon(1e-7));
  CHECK(window.x == doctest::Approx(0.6 * (0.01 + 12 - 4.02)).epsilon(1e-7));
  const End wall = run("V = exp(8 (x - 6))\n", 0, 1, 20);
  CHECK(wall.x == doctest::Approx(-7.82671320486001367).epsilon(1e-6));
  CHECK(wall.v == doctest::Approx(-1.0).epsilon(1e-7));
  const End gate = run("force x = 0.5 step(exp(-100 (x - 3)^2) - 0.5)\n", 0, 1, 10);
  CHECK(gate.x == doctest::Approx(10.5606159549414748).epsilon(1e-6));
}

TEST_CASE("a product of high power: (x/5)^40") {
  const End end = run("V = (x/5)^40\n", 0, 1, 30);
  CHECK(0.5 * end.v * end.v + std::pow(end.x / 5, 40) == doctest::Approx(0.5).epsilon(1e-5));
  CHECK(std::abs(end.x) < 5);
}

TEST_CASE("smooth and stiff motions lose no step") {
  const End oscillator = run("V = 1/2 x^2\nforce x = 0.3 cos(2 t)\n", 1, 0, 20);
  CHECK(oscillator.rejected == 0);
  const End stiff = run("param k = 1e8, c = 1e6\nV = 1/2 k x^2\nD = 1/2 c x'^2\nforce x = k cos t\n", 0, 0, 10, 1e-9);
  CHECK(stiff.rejected == 0);
  CHECK(stiff.steps < 120);
  const End van_der_pol = run("force x = 1e3 (1 - x^2) x' - x\n", 2, 0, 500, 1e-8);
  CHECK(van_der_pol.rejected <= 2);
}
