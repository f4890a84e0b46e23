// maup simulate and check of constrained models, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

const std::string rod =
    "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
    "-g)\n"
    "constraint x^2 + y^2 = l^2 name rod\nstart x = 1 m\nrun 3 s\n";

}  // namespace

TEST_CASE("simulate: reactions and multipliers in text and JSON") {
  const Folder folder;
  const std::string model = folder.write("rod.lag", rod);
  const Outcome text = maup({"simulate", model});
  CHECK(text.code == 0);
  CHECK(contains(text.out, "reaction(rod)"));
  CHECK(contains(text.out, "constraint residual"));
  const Outcome json = maup({"simulate", model, "--json", "--at", "1s"});
  const Json at = json_of(json).at("at").at(0);
  const double y = at.at("state").at("y"), lambda = at.at("multipliers").at("λ_rod"),
               tension = at.at("reactions").at("reaction(rod)");
  CHECK(tension == doctest::Approx(-3 * 9.81 * y).epsilon(1e-11));
  CHECK(lambda == doctest::Approx(-tension / 2).epsilon(1e-12));
}

TEST_CASE("simulate: each method, and what each refuses") {
  const Folder folder;
  const std::string model = folder.write("rod.lag", rod);
  CHECK(contains(maup({"simulate", model, "--method", "variational", "--step", "10ms"}).out,
                 "variational method, order 4"));
  const Outcome stiff = maup({"simulate", model, "--method", "stiff", "--json"});
  CHECK(json_of(stiff).at("statistics").at("method") == "stiff");
  const Outcome no_step = maup({"simulate", model, "--method", "variational"});
  CHECK(no_step.code != 0);
  CHECK(contains(no_step.err, "E0721"));
  CHECK(contains(no_step.err, "needs the length of its step"));
  const Outcome short_step = maup({"simulate", model, "--method", "variational", "--step", "1e-300s"});
  CHECK(contains(short_step.err, "E0721"));
  CHECK(contains(short_step.err, "too short for this run"));
  const Outcome stray = maup({"simulate", model, "--step", "10ms"});
  CHECK(stray.code == 2);
  CHECK(contains(stray.err, "--method variational"));
  const std::string skate =
      folder.write("skate.lag",
                   "system skate\nparam m = 1 kg, J = 1 kg m^2\ncoord x, y : length, θ : angle\n"
                   "T = 1/2 m (x'^2 + y'^2) + 1/2 J θ'^2\nconstraint x' sin θ = y' cos θ name blade\n"
                   "start x' = 1 m/s, θ' = 1 rad/s\nrun 1 s\n");
  const Outcome refused = maup({"simulate", skate, "--method", "variational", "--step", "10ms"});
  CHECK(refused.code != 0);
  CHECK(contains(refused.err, "E0720"));
}

TEST_CASE("simulate: a singular configuration ends the run with the reason, and what was computed is kept") {
  const Folder folder;
  const std::string model = folder.write("linkage.lag",
                                         "system linkage\nparam l = 1 m, d = 2 m, J = 1 kg m^2\ncoord a, b, c : "
                                         "angle\nT = 1/2 J (a'^2 + b'^2 + c'^2)\nV = 3 [J] sin a\n"
                                         "constraint l cos a + d cos c = d + l cos b name horizontal\nconstraint l sin "
                                         "a + d sin c = l sin b name vertical\n"
                                         "start a = 60 deg, b = 60 deg, a' = -1 rad/s\nrun 5 s\n");
  const Outcome run = maup({"simulate", model, "--json"});
  CHECK(run.code == 3);
  const Json document = json_of(run);
  CHECK(document.at("ended").at("kind") == "singular constraints");
  CHECK(document.at("final").at("t").get<double>() > 0.5);
  CHECK(document.at("statistics").at("energy_drift").get<double>() < 1e-12);
}

TEST_CASE("simulate: multipliers that are not determined are null") {
  const Folder folder;
  std::string twice = rod;
  twice.insert(twice.find("start"), "constraint 2 x^2 + 2 y^2 = 2 l^2 name wire\n");
  const std::string model = folder.write("twice.lag", twice);
  const Json document = json_of(maup({"simulate", model, "--json"}));
  CHECK(document.at("final").at("multipliers").at("λ_rod").is_null());
  CHECK(contains(maup({"simulate", model}).out, "not determined"));
}

TEST_CASE("check: freedoms, classes, and a start that cannot be") {
  const Folder folder;
  const Json document = json_of(maup({"check", folder.write("rod.lag", rod), "--json"}));
  CHECK(document.at("freedoms") == 1);
  CHECK(document.at("instantaneous_freedoms") == 1);
  CHECK(document.at("constraints").at(0).at("class") == "holonomic");
  std::string exactly = rod;
  exactly.replace(exactly.find("start x = 1 m"), 13, "start exactly x = 2 m");
  const Outcome refused = maup({"check", folder.write("exactly.lag", exactly)});
  CHECK(refused.code == 1);
  CHECK(contains(refused.err, "E0707"));
}
