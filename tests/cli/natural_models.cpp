// Natural models that ended commands with a signal once.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

TEST_CASE("action: free ends of which constraints leave nothing") {
  const Folder folder;
  const std::string model =
      folder.write("ends.lag",
                   "system ends\ndimensionless\ncoord x, y : number\nL = x'^2/2 + y'^2/2\nconstraint y = 1\n"
                   "path from (0, free) at 0 to (1, free) at 1\n");
  const Outcome run = shell("timeout 60 \"$MAUP\" action " + model);
  CHECK(run.code == 0);
  CHECK(run.out.find("a minimum of S (index 0)") != std::string::npos);
}

TEST_CASE("report: a constraint that is not linear in velocities, and an integral that is expected") {
  const Folder folder;
  const std::string model =
      folder.write("speed.lag",
                   "system speed\ndimensionless\nparam m = 1\ncoord x, y : number\npoint P mass m at (x, y)\n"
                   "constraint x'^2 + y'^2 = 1\nstart x' = 0.6, y' = 0.8\nrun 1\nexpect integral x' - y'\n");
  const Outcome run = shell("timeout 60 \"$MAUP\" report " + model + " -o " + folder.path("speed.html"));
  CHECK(run.code == 0);
}

TEST_CASE("invariants: a robot whose frames hold derivatives") {
  const Outcome run = shell("timeout 200 \"$MAUP\" invariants " PROJECT_DIR "/tests/problems/urdf_panda.lag");
  CHECK(run.code == 0);
}

TEST_CASE("action: ends that leave a free particle a translation have an index, by both counts") {
  const Folder folder;
  const std::string ends[] = {"(0 m, free) at 0 to (1 m, free) at 1000 s", "(free, free) at 0 to (free, free) at 1 ms",
                              "(free, 1 m) at 0 to (free, 3 m) at 7 s"};
  for (const char* mass : {"1 kg", "1e-6 kg", "1e6 kg"})
    for (const std::string& e : ends) {
      CAPTURE(e);
      const Outcome run =
          maup({"action", "-", "--ends", e, "--paths", "2"},
               std::string("system free\nparam m = ") + mass + "\ncoord x, y : length\npoint P mass m at (x, y)\n");
      CHECK(run.code == 0);
      CHECK_MESSAGE(run.err.empty(), run.err);
      CHECK(run.out.find("index 0") != std::string::npos);
      CHECK(run.out.find("DISAGREE") == std::string::npos);
    }
}

TEST_CASE("derive: L with a condition between a coordinate and its velocity is certified or refused for its jump") {
  const char* const jumps[] = {"piecewise(x < x' : x'^2, else : x'^2/2)", "x'^2/2 - max(x, x')",
                               "x'^2/2 + min(x, x')^2"};
  const char* const smooth[] = {"x'^2/2 + piecewise(x < x' : (x' - x)^2, else : 0)", "x'^2/2 + max(x' - x, 0)^2",
                                "x'^2/2 + abs(x' - x)^3"};
  for (const char* l : jumps)
    CHECK(maup({"derive", "-"}, std::string("system s\ndimensionless\ncoord x : number\nL = ") + l + "\n")
              .err.find("error E043") != std::string::npos);
  for (const char* l : smooth) {
    CAPTURE(l);
    const Outcome run =
        maup({"derive", "-"}, std::string("system s\ndimensionless\ncoord x : number\nL = ") + l + "\n");
    CHECK(run.code == 0);
    CHECK(run.out.find("Certificate: passed") != std::string::npos);
  }
}

TEST_CASE("a force that begins as a root of time is told from one that is infinite") {
  const Folder folder;
  const auto run = [&](const char* force) {
    return maup({"simulate", folder.write("a.lag", "dimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = " +
                                                       std::string(force) + "\nstart x = 1\nrun 5\n")});
  };
  const Outcome root = run("sqrt(max(t - 2, 0))"), pole = run("1/max(t - 2, 0)");
  CHECK(root.code != 0);
  CHECK(contains(root.err, "The accelerations are finite here"));
  CHECK(pole.code != 0);
  CHECK(contains(pole.err, "A force or an acceleration is infinite or undefined here"));
}

TEST_CASE("check tells the time of a start that is not 0") {
  const Folder folder;
  const std::string model = folder.write(
      "late.lag", "system late\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nstart at 1 s, x = 1 m\n");
  CHECK(contains(maup({"check", model}).out, "t = 1 s, x = 1 m"));
}
