// Motions that no method can follow to their end: the run ends with the reason, the time and the state, in a bounded
// time.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace cli_test;

namespace {

struct Endless {
  const char* name;
  const char* text;
  double earliest, latest;  // when the run has to end
};

const std::string head = "system endless\ndimensionless\ncoord x : number\nT = 1/2 x'^2\n";

const Endless endless[] = {
    {"a force that oscillates without end near a point", "force x = sin(1/(x - 1))\nstart x' = 2\nrun 3\n", 0.45, 0.7},
    {"a force that oscillates without end near a time", "force x = sin(1/(t - 2))/(t - 2)\nrun 3\n", 1.9, 2.1},
    {"a switch that chatters: both sides push back", "force x = -sign(x + x')\nstart x = 1\nrun 20\n", 0.1, 20},
    {"switches that come ever faster: dry friction and a constant push back",
     "force x = -sign(x) - 0.5 sign(x')\nstart x = 1\nrun 20\n", 1, 20},
    {"a square wave without end near a time", "force x = sign(sin(1/(t - 2)))\nrun 3\n", 1.9, 2.1},
    {"steps below the spacing of t", "V = 1e12 x^2\nstart at 1e12\nstart x = 1\nrun 10\n", 1e12 - 1, 1e12 + 11},
    {"an energy beyond the range of double", "V = 1/2 x^2 + exp(700) exp(700 + 0 x)\nstart x' = 1\nrun 3\n", 3, 3},
    {"a coordinate that runs away in finite time, and one that oscillates across it ever faster",
     "coord y : number\nT += 1/2 y'^2\nV = -1/5 x^3 + 1/2 x^3 y^2\nstart x = 1, y = 0.1\nrun 100\n", 3.5, 3.9},
    {"a collision", "V = -1/abs(x)\nstart x = 1\nrun 5\n", 1.1, 1.12},
};

}  // namespace

TEST_CASE("a run that cannot go on says why and where, soon") {
  for (const Endless& e : endless) {
    const std::string name = e.name;
    const Folder folder;
    const Outcome run =
        shell("timeout 60 \"$MAUP\" simulate " + folder.write("endless.lag", head + e.text) + " --json");
    const auto document = nlohmann::json::parse(run.out, nullptr, false);
    std::string trouble;
    if (run.code == 124 || run.code == 130)
      trouble = "no end within a minute";
    else if (run.code != 3 || document.is_discarded() || document["ended"].value("reason", "").empty())
      trouble = "exit " + std::to_string(run.code) + " without a reason";
    else if (!document["final"]["state"]["x"].is_number() || !document["final"]["state"]["x'"].is_number())
      trouble = "no state";
    else if (const double t = document["final"]["t"]; !(t >= e.earliest && t <= e.latest))
      trouble = "it ends at t = " + std::to_string(t);
    CHECK_MESSAGE(trouble.empty(), name << ": " << trouble << " " << run.err);
  }
}

TEST_CASE("a long chaotic run is not taken for one whose steps go on shrinking") {
  const Folder folder;
  const std::string text =
      "system d\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord a, b : angle\npoint A mass m at l (sin a, -cos a)\n"
      "point B mass m at A + l (sin b, -cos b)\ngravity (0, -g)\nstart a = 120 deg, b = -10 deg\nrun 2000000 s\n";
  // The looks are at 4096, 8192, … steps; 3 s carry it past a million, and Ctrl-C ends it.
  const Outcome run = shell("timeout --signal=INT 3 \"$MAUP\" simulate " + folder.write("long.lag", text) +
                            " --no-errors --json --backend interpreter");
  const auto document = nlohmann::json::parse(run.out, nullptr, false);
  REQUIRE_FALSE(document.is_discarded());
  CHECK(document["ended"].value("reason", "").find("interrupted") != std::string::npos);
  CHECK(document["statistics"]["steps"] > 16384);
}

TEST_CASE("a run that no event helps to begin says why, and speaks of no contacts") {
  const Folder folder;
  const Outcome run =
      maup({"simulate", folder.write("root.lag", head + "force x = sqrt(t)\nevent a when x = 1 : record\n"
                                                        "run 3\n")});
  CHECK(run.code == 3);
  CHECK(contains(run.err + run.out, "not all of their derivatives are"));
  CHECK_FALSE(contains(run.err + run.out, "contacts"));
}

TEST_CASE("a load that leaves its bridge ends the run before its time: exit code 3, with the reason") {
  const Folder folder;
  const std::string bridge =
      "system bridge\ndimensionless\nfield w(x) : number on x = 0 .. 1 cells 2 order 5 boundary w = 0\n"
      "density = 1/2 w'^2 - 1/2 w_x^2\nforce w(t/2) = -1\n";
  const Outcome over = maup({"simulate", folder.write("over.lag", bridge + "run 3\n"), "--json"});
  CHECK(over.code == 3);
  CHECK(nlohmann::json::parse(over.out)["trouble"] == "w(t/2) leaves the domain");
  CHECK(maup({"simulate", folder.write("on.lag", bridge + "run 2\n")}).code == 0);
}

TEST_CASE("a time that no number of steps comes to is told, and is not waited for") {
  const std::string henon = PROJECT_DIR "/models/henon_heiles.lag";
  for (const char* options : {"simulate --duration 1e308s", "simulate --at 1e300s", "orbits --strobe 1e300s",
                              "orbits --floquet --period 1e300s"}) {
    const std::string words = options;
    const std::size_t blank = words.find(' ');
    const Outcome outcome = shell("timeout 60 \"$MAUP\" " + words.substr(0, blank) + " " + henon + words.substr(blank));
    CAPTURE(options);
    CHECK(outcome.code == 3);
    CHECK_MESSAGE(contains(outcome.err, "of them were left, and a run has 1e+08"), outcome.err);
  }
}
