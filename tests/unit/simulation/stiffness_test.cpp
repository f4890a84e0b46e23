// When steps count as limited by stability.
#include "simulation/stiffness.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

namespace {

/// Steps of one length along v = 1, a = 1: the time scale of the motion is 1.
struct Watched {
  StiffnessWatch watch;
  double t = 0;

  bool step(double length, int switches = 0, double end = 1e6) {
    Sample start;
    start.v = {1};
    start.a = {1};
    Step step;
    step.begin = t;
    step.end = t += length;
    step.switches.assign(static_cast<std::size_t>(switches), 0);
    return watch.sees_stiffness(start, step, end);
  }
  /// The number of steps after which it is seen; 0: never within `most`.
  int seen_after(double length, int most, double end = 1e6) {
    for (int k = 1; k <= most; ++k)
      if (step(length, 0, end)) return k;
    return 0;
  }
};

}  // namespace

TEST_CASE("steps far shorter than the time scale, of which many are left, are stiffness") {
  CHECK(Watched().seen_after(0.99e-4, 4000) == 1600);
  CHECK(Watched().seen_after(1.01e-4, 4000) == 0);             // as many as cost no more than the implicit ones
  CHECK(Watched().seen_after(5e-5, 1900, 0.08 + 0.995) == 0);  // 19 900 steps are left
  CHECK(Watched().seen_after(5e-5, 1900, 0.08 + 1.005) == 1600);
}

TEST_CASE("a moment without acceleration is no long time scale") {
  StiffnessWatch watch;
  const double h = 3e-4;
  for (int k = 0; k < 30'000; ++k) {  // x = cos t
    const double t = k * h;
    Step step;
    step.begin = t, step.end = t + h;
    CHECK_FALSE(watch.sees_stiffness({t, {std::cos(t)}, {-std::sin(t)}, {-std::cos(t)}, {}, {}, {}}, step, 1e6));
  }
}

TEST_CASE("after a switch the windows begin anew, with the first step behind it") {
  Watched w;
  for (int k = 0; k < 300; ++k) w.step(10);
  w.step(0.5, 1);
  CHECK(w.seen_after(5e-5, 4000) == 1600);
}
