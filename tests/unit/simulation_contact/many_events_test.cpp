// Events that would be more than a run follows: within one step, at a steady rate, ever denser; and searches for them
// that would not come back.
#include "run_text.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

using namespace maupertuis;

namespace {

/// x = t.
std::string clock_with(const std::string& condition, const std::string& action) {
  return "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x' = 1\nevent s when " + condition + " : " + action +
         "\n";
}

const std::string turn_round = "set x' = -x'";

}  // namespace

TEST_CASE("recorded events within one long step end the run when more come than are followed") {
  for (const std::string rate : {"1e7", "1e12"}) {
    CAPTURE(rate);
    ModelText m(clock_with("sin(" + rate + " t) = 0", "record"));
    const auto r = run(m, 100);
    CHECK(r.ending == Ending::Unending);
    CHECK(r.reason.find("1000000 are followed at most") != std::string::npos);
    CHECK(r.happenings.size() < 10'000);
    CHECK(r.final.q[0] == doctest::Approx(r.final.t).epsilon(1e-14));
  }
}

TEST_CASE("as many events as are followed are no reason, and none is left out where a step ends between them") {
  const double pi = std::acos(-1.0);
  const auto r = run_text(clock_with("sin(1e4 t) = 0", "record"), pi * 1.00005);
  REQUIRE(count(r, Happening::Kind::Event) == 10'001);  // with the one at t = 0
  double off = 0;
  for (std::size_t k = 0; k < r.happenings.size(); ++k)
    off = std::max(off, std::abs(r.happenings[k].t - static_cast<double>(k) * pi * 1e-4));
  CHECK(off < 1e-14);
}

TEST_CASE("events that become ever denser end the run soon, whatever they do") {
  for (const std::string action : {std::string("record"), turn_round}) {
    CAPTURE(action);
    ModelText m(clock_with("sin(1/(1 - t)) = 0", action));
    const auto r = run(m, 2);
    CHECK(r.ending == Ending::Unending);
    CHECK(r.happenings.size() < 10'000);
    CHECK(r.final.t < 1);
  }
  // A rate that grows, and comes to no more than are followed.
  CHECK(run_text(clock_with("sin(5e3 t^2) = 0", "record"), 2).happenings.size() == 6'367);
}

TEST_CASE("a run that may be stopped before its time is not judged by what would come after") {
  const auto r = run_text(clock_with("sin(1e4 t) = 0", "record") + "event enough when t = 2 : stop\n", 1e6);
  CHECK(r.ending == Ending::Stopped);
  CHECK(r.final.t == 2);
}

TEST_CASE("a function that swings a billion times a second without a zero leaves time for an interrupt") {
  StopFlag stop{false};
  SimulationOptions options;
  options.interrupt = &stop;
  ModelText m(clock_with("sin(1e9 t) = 2", "record"));
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop = true;
  });
  const auto r = run(m, 100, options);
  later.join();
  CHECK(r.ending == Ending::Interrupted);
  CHECK(r.final.t > 0);
}

TEST_CASE("a swing that rounding of a long step hides is looked for in shorter ones") {
  ModelText m(clock_with("sin(1e12 t) = 0", "record"));
  const auto r = run(m, 1e4);
  CHECK(r.ending == Ending::Unending);
  CHECK(r.happenings.size() < 10'000);
}
