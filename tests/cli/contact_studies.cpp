// Commands beside simulate on models with contacts, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace contact_studies {
namespace {

const std::string gallery = std::string(PROJECT_DIR) + "/models/";

}  // namespace

TEST_CASE("orbits of a block that sticks and slips: text, and no more exponents than directions") {
  const Outcome text = maup({"orbits", gallery + "stick_slip.lag", "--floquet"});
  CHECK_MESSAGE(text.code == 0, text.err);
  CHECK(contains(text.out, "period              0.63521477735 s"));
  CHECK(contains(text.out, "after a period neighbours are in the same motion"));
  const Outcome modes = maup({"modes", gallery + "impact_oscillator.lag", "--orbit", "--json"});
  CHECK(std::abs(json_of(modes).at("floquet").at("trace").get<double>() + 1.1490793095920596) < 1e-11);
}

TEST_CASE("modes of a model with contacts: rest in its modes, and what needs one of them") {
  const Json held = json_of(maup({"modes", gallery + "block_on_incline.lag", "--json"}));
  CHECK(held.at("resting").size() == 1);
  CHECK(held.at("resting")[0].at("mode") == "plane sticking");
  const Json& friction = held.at("resting")[0].at("points")[0].at("static_friction")[0];
  CHECK(friction.at("force").get<double>() <= friction.at("limit").get<double>());
  const Outcome one = maup({"modes", gallery + "bouncing_ball.lag", "--at", "z=0", "--json"});
  CHECK(json_of(one).at("diagnostics")[0].at("code") == "E0270");
  const Outcome mode = maup({"modes", gallery + "bouncing_ball.lag", "--mode", "floor", "--at", "z=0"});
  CHECK_MESSAGE(mode.code == 0, mode.err);
}

TEST_CASE("invariants of a model with contacts: modes and impacts") {
  const Json found = json_of(maup({"invariants", gallery + "stacked_balls.lag", "--no-drift", "--json"}));
  bool energy = false;
  for (const Json& integral : found.at("integrals")) {
    CHECK(integral.at("through_modes").at("modes").size() >= 2);
    energy = energy || integral.at("name") == "energy";
  }
  CHECK(energy);
}

TEST_CASE("what is expected of a model with contacts holds in all of its modes") {
  const std::string ball =
      "system ball\nparam m = 1 kg, g = 9.81 m/s^2, k = 40 N/m\ncoord x, z : length\npoint P mass m at (x, z)\n"
      "gravity (0, -g)\nV += 1/2 k x^2\ncontact z >= 0 restitution 0.8 name floor\nstart z = 1 m\nrun 1 s\n";
  const auto verdict = [&](const std::string& line) { return maup({"test", "-"}, ball + "expect " + line + "\n"); };
  CHECK(verdict("conserved 1/2 m x'^2 + 1/2 k x^2").code == 0);
  const Outcome energy = verdict("conserved 1/2 m (x'^2 + z'^2) + 1/2 k x^2 + m g z");
  CHECK(energy.code == 4);
  CHECK(contains(energy.out + energy.err, "Impacts on floor change it."));
  CHECK(verdict("1/2 m (x'^2 + z'^2) + 1/2 k x^2 + m g z not conserved").code == 0);
  CHECK(verdict("equilibrium at x = 0, z = 0 is stable").code == 0);
  const Outcome frequency = verdict("frequencies at x = 0, z = 0 : 6.324555320336759 rad/s rel 1e-12");
  CHECK_MESSAGE(frequency.code == 0, frequency.out);
}

TEST_CASE("an empty mode is none, and impulses are told with their unit") {
  const Outcome none = maup({"simulate", gallery + "bouncing_ball.lag", "--mode", "", "--json"});
  CHECK(none.code != 0);
  CHECK(json_of(none).at("diagnostics")[0].at("code") == "E0269");
  CHECK(maup({"simulate", gallery + "bouncing_ball.lag"}).out.find("impulse 7.973 kg m/s\n") != std::string::npos);
}

TEST_CASE("impacts in many digits are told with their digits") {
  const Json run = json_of(maup({"simulate", gallery + "bouncing_ball.lag", "--precision", "quad", "--json"}));
  const Json& first = run.at("happenings")[0];
  CHECK(first.at("kind") == "impact");
  CHECK(first.at("digits").get<int>() > 30);
  CHECK(std::abs(std::stod(first.at("t").get<std::string>()) - std::sqrt(2 / 9.81)) < 1e-15);
}

TEST_CASE("what an event sets or stops is no part of one smooth motion: refused, or told to be left out") {
  const Folder folder;
  const std::string path = folder.write(
      "kick.lag",
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nevent kick when x = 0 falling : set x' = -2 x'\n"
      "start x = 1\nrun 10\npath from 0 at 0 to 0.5 at 1\n");
  const auto code_of = [&](std::vector<std::string> command) {
    command.insert(command.begin() + 1, path);
    command.push_back("--json");
    return json_of(maup(command)).at("diagnostics")[0].at("code").get<std::string>();
  };
  CHECK(code_of({"action", "--motion"}) == "E0271");
  CHECK(code_of({"action", "--periodic"}) == "E0271");
  CHECK(code_of({"hamiltonian", "--integrate"}) == "E0271");
  CHECK(code_of({"action"}) == "N0272");
  CHECK(code_of({"modes"}) == "N0272");
  CHECK(json_of(maup({"action", path, "--path", "x = t", "--from", "0", "--to", "1", "--json"}))
            .at("diagnostics")
            .empty());
  CHECK(json_of(maup({"hamiltonian", path, "--json"})).at("diagnostics").empty());
}

TEST_CASE("hamiltonian, action, compare and reduce want one mode") {
  const std::string ball = gallery + "bouncing_ball.lag";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"hamiltonian", ball}, std::vector<std::string>{"action", ball, "--motion"},
        std::vector<std::string>{"compare", ball, ball}, std::vector<std::string>{"reduce", ball}}) {
    std::vector<std::string> all = command;
    all.push_back("--json");
    const Outcome refused = maup(all);
    CAPTURE(command.front());
    CHECK(refused.code == 1);
    CHECK(json_of(refused).at("diagnostics")[0].at("code") == (command.front() == "compare" ? "E0835" : "E0270"));
  }
}

}  // namespace contact_studies
