// When steps count as limited by stability.
#include "simulation/stiffness.hpp"

#include <doctest/doctest.h>

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
    step.switches = switches;
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

TEST_CASE("two windows of short steps, of which many are left, are stiffness") {
  CHECK(Watched().seen_after(0.019, 2000) == 800);
  CHECK(Watched().seen_after(0.021, 2000) == 0);         // no shorter than the motion asks for
  CHECK(Watched().seen_after(0.01, 900, 8 + 199) == 0);  // 19 900 steps are left
  CHECK(Watched().seen_after(0.01, 900, 8 + 201) == 800);
}

TEST_CASE("after a switch the windows begin anew, with the first step behind it") {
  Watched w;
  for (int k = 0; k < 300; ++k) w.step(10);
  w.step(0.5, 1);
  CHECK(w.seen_after(0.01, 2000) == 800);
}
