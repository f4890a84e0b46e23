// What is said where events, contacts and friction end a run: a code, the place, the reason, exit code 3.
#include "json.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace cli_test;

namespace {

const std::string rod_with_start =
    "coord x, y : length\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\npoint P mass m at (x, y)\ngravity (0, -g)\n"
    "constraint x^2 + y^2 = l^2 name rod\nstart x = 0.6 m, y = -0.8 m\nrun 5 s\n";
const std::string ball =
    "coord z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m z'^2\nV = m g z\nstart z = 1 m\nrun 5 s\n";
const std::string clock_model = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x' = 1\nrun 5\n";

/// A rod on a rough floor, as Painlevé has it.
std::string rough_rod(const std::string& start) {
  return "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, μ = 1.6\ncoord x, y : length, θ : angle\n"
         "T = 1/2 m (x'^2 + y'^2) + 1/24 m l^2 θ'^2\nV = m g y\n"
         "contact y - l/2 sin θ >= 0 friction μ slip x' + l/2 sin θ θ' name tip\nstart " +
         start + "\nrun 1 s\n";
}
const std::string slides_into_it = rough_rod("θ = 40 deg, y = l/2 sin(40 [deg]), x' = -30 m/s");
const std::string has_two = rough_rod("θ = 60 deg, y = l/2 sin(60 [deg]), x' = -3 m/s, θ' = -20 rad/s, y' = -5 m/s");

struct Early {
  const char* name;
  std::string text;
  const char *code, *kind, *reason;
  int line;  // of the statement that ends it; 0: none is told
};

}  // namespace

TEST_CASE("simulate: what events, contacts and friction end a run for has a code, in text and in JSON") {
  const Early endings[] = {
      {"a set off a constraint", rod_with_start + "event low when x = 0 : set x = 0.1 m\n", "W0737", "impossible state",
       "sets a state that violates rod", 8},
      {"a set into a contact", ball + "contact z >= 0 name floor\nevent up when z = 0.5 m : set z = -1 cm\n", "W0737",
       "impossible state", "sets a state that violates the contact floor", 8},
      {"a set without a value", clock_model + "event up when x = 2 : set x' = sqrt(-x)\n", "W0737", "impossible state",
       "without a value", 6},
      {"sets that accumulate", ball + "event floor when z = 0 falling : set z' = -0.5 z'\n", "W0738",
       "events without end", "infinitely often up to t = 1.354", 7},
      {"events at a rate", clock_model + "event s when sin(1e9 t) = 0 : record\n", "W0738", "events without end",
       "1000000 are followed at most", 0},
      {"events that become denser", clock_model + "event s when sin(1/(1 - t)) = 0 : record\n", "W0738",
       "events without end", "1000000 are followed at most", 0},
      {"Painlevé's paradox on the way", slides_into_it, "W0739", "no motion fits",
       "with the friction of its slip the contact tip yields no more to its own force", 5},
      {"Painlevé's paradox at the start", has_two, "W0739", "no motion fits",
       "in the mode `tip sliding −` and in the mode `free`", 5},
  };
  const Folder folder;
  for (const Early& e : endings) {
    CAPTURE(e.name);
    const std::string model = folder.write("ends.lag", e.text);
    const Outcome text = maup({"simulate", model});
    CHECK(text.code == 3);
    CHECK(contains(text.err, std::string("warning ") + e.code));
    CHECK(contains(text.err, e.reason));
    CHECK(text.err.find(e.reason) == text.err.rfind(e.reason));  // once
    const Outcome json = maup({"simulate", model, "--json"});
    CHECK(json.code == 3);
    const Json document = json_of(json);
    CHECK(document["ok"] == false);
    CHECK(document["ended"]["kind"] == e.kind);
    REQUIRE(document["diagnostics"].size() == 1);
    const Json told = document["diagnostics"][0];
    CHECK(told["code"] == e.code);
    CHECK(told["reason"] == document["ended"]["reason"]);
    CHECK(contains(told["reason"].get<std::string>(), e.reason));
    if (e.line > 0) CHECK(told["line"] == e.line);
    CHECK(contains(maup({"explain", e.code}).out, e.code));
  }
}

TEST_CASE("simulate: what ends a run in many digits has the same codes") {
  const Folder folder;
  const std::string model = folder.write("ends.lag", rod_with_start + "event low when x = 0 : set x = 0.1 m\n");
  const Outcome run = maup({"simulate", model, "--precision", "quad", "--json"});
  CHECK(run.code == 3);
  const Json document = json_of(run);
  CHECK(document["ended"]["kind"] == "impossible state");
  REQUIRE(document["diagnostics"].size() == 1);
  CHECK(document["diagnostics"][0]["code"] == "W0737");
}

TEST_CASE(
    "simulate: a rod that slides into Painlevé's paradox ends where 1 + 3 cos² θ = 3 μ sin θ cos θ, with its state") {
  const Folder folder;
  const Json document = json_of(maup({"simulate", folder.write("rod.lag", slides_into_it), "--json"}));
  const Json last = document["final"];
  CHECK(last["state"]["θ"].get<double>() == doctest::Approx(0.82076098343).epsilon(1e-5));  // 47.026°
  for (const char* name : {"θ", "x", "y"}) {
    CAPTURE(name);
    REQUIRE(last["errors"][name].is_number());
    CHECK(last["errors"][name].get<double>() < 1e-5);
  }
  CHECK(document["energy_books"]["friction"].get<double>() > 100);
}

TEST_CASE("check: the closing line does not contradict a start without a motion") {
  const Folder folder;
  const Outcome stuck = maup({"check", folder.write("two.lag", has_two)});
  CHECK(contains(stuck.err, "W0731"));
  CHECK_FALSE(contains(stuck.out, "No mistakes found."));
  CHECK(contains(stuck.out, "No motion begins at this start; no other mistakes were found.\n"));
  CHECK(contains(maup({"check", folder.write("slides.lag", slides_into_it)}).out, "No mistakes found."));
}

TEST_CASE("simulate: a contact that closes while it slides is told once") {
  const Folder folder;
  const Outcome run = maup({"simulate", folder.write("falls.lag",
                                                     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\n"
                                                     "point P mass m at (x, z)\ngravity (0, -g)\n"
                                                     "contact z >= 0 friction 0.3 slip x' name floor\n"
                                                     "start z = 1 m, x' = 9 m/s\nrun 0.5 s\n")});
  CHECK(run.code == 0);
  CHECK(contains(run.out, "floor made → floor sliding +"));
  CHECK_FALSE(contains(run.out, "floor slip"));
}
