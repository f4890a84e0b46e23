// maup compare and maup reduce, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

const std::string cartesian =
    "system cartesian\n"
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
    "coord x, y : length\n"
    "point bob mass m at (x, y)\n"
    "gravity (0, -g)\n"
    "constraint x^2 + y^2 = l^2 name rod\n"
    "start x = sqrt(3)/2 l, y = -l/2\n"
    "run 10 s\n";
const std::string map = "x = l sin θ, y = -l cos θ";

}  // namespace

TEST_CASE("compare: 0 when proved, 4 when not, with the witness") {
  const Folder folder;
  const std::string a = folder.write("cartesian.lag", cartesian), b = folder.write("pendulum.lag", pendulum);
  const Outcome same = maup({"compare", a, b, "--map", map});
  CHECK_MESSAGE(same.code == 0, same.err);
  CHECK(contains(same.out, "the same motion: proved"));
  CHECK(contains(same.out, "error bound"));
  CHECK(contains(same.out, "rank of the map 1"));
  CHECK(same.err.empty());

  const std::string wrong = folder.write("wrong.lag",
                                         "system wrong\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
                                         "T = 1/2 m l^2 θ'^2\nV = m g l cos θ\nstart θ = 60 deg\nrun 10 s\n");
  const Outcome differs = maup({"compare", b, wrong});
  CHECK(differs.code == 4);
  CHECK(contains(differs.out, "differs: the equation of θ"));
  CHECK(contains(differs.out, "θ'' = -8.4957092"));  // -g sin 60°, and + by the other
  CHECK(contains(differs.out, "8.4957092"));
  CHECK(maup({"compare", b, "-"}, pendulum).code == 0);
}

TEST_CASE("compare --json") {
  const Folder folder;
  const std::string a = folder.write("cartesian.lag", cartesian), b = folder.write("pendulum.lag", pendulum);
  const Outcome outcome = maup({"compare", a, b, "--map", map, "--json"});
  CHECK(outcome.code == 0);
  const Json json = json_of(outcome);
  REQUIRE(json.is_object());
  CHECK(json.at("schema") == 1);
  CHECK(json.at("verdict") == "same");
  CHECK(json.at("ok") == true);
  CHECK(json.at("map").at("y") == "-l cos θ");
  CHECK(json.at("error_bound").get<double>() < 1e-12);
  CHECK(json.at("freedoms") == Json::array({1, 1}));
  CHECK(json.at("rank") == 1);
  CHECK(json.at("energies") == "equal");
  CHECK(json.at("witness").is_null());
  CHECK(json.at("run").at("difference").get<double>() < 1e-12);
  CHECK(json.at("diagnostics").empty());

  const Json wrong = json_of(maup({"compare", a, b, "--map", "x = l sin θ, y = -cos θ", "--json"}));
  REQUIRE(wrong.is_object());
  CHECK(wrong.at("ok") == false);
  REQUIRE(wrong.at("diagnostics").size() == 1);
  CHECK(wrong.at("diagnostics").at(0).at("code") == "E0822");
  CHECK(wrong.at("diagnostics").at(0).at("file") == "--map");
  CHECK(wrong.at("diagnostics").at(0).at("column") == 18);
}

TEST_CASE("compare: mistakes of the map are shown in the map; files that cannot be read are usage") {
  const Folder folder;
  const std::string a = folder.write("cartesian.lag", cartesian), b = folder.write("pendulum.lag", pendulum);
  const Outcome missing = maup({"compare", a, b, "--map", "x = l sin θ"});
  CHECK(missing.code == 1);
  CHECK(contains(missing.err, "E0820"));
  CHECK(missing.out.empty());
  const Outcome unknown = maup({"compare", a, b, "--map", "x = l sin φ, y = -l cos θ"});
  CHECK(unknown.code == 1);
  CHECK(contains(unknown.err, "--map:1:11"));
  for (const char* text : {"", "x", "x =", "= l", "x = l sin θ,", "x = l sin θ; y = l", "x = (, y = )", "start x = 1",
                           "x = \"", "\n", "#"}) {
    CAPTURE(text);
    const Outcome outcome = maup({"compare", a, b, "--map", text});
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.err, "-- error E0"));
    CHECK_FALSE(contains(outcome.err, "internal error"));
  }
  CHECK(maup({"compare", a, folder.path("none.lag")}).code == 2);
  CHECK(maup({"compare", a}).code == 2);
  const Outcome wrong_model = maup({"compare", a, "-"}, "coord x : length\nT = 1/2 m x'^2\n");
  CHECK(wrong_model.code == 1);
  CHECK(contains(wrong_model.err, "-- error E0"));
}

TEST_CASE("reduce writes a model that check, test and compare accept") {
  const Folder folder;
  const std::string a = folder.write("cartesian.lag", cartesian + "expect reaction rod at 2 s = 14.7 N ± 100 N\n");
  const std::string small = folder.path("small.lag");
  const Outcome written = maup({"reduce", a, "-o", small});
  CHECK_MESSAGE(written.code == 0, written.err);
  CHECK(contains(written.out, "the same motion: proved"));
  CHECK(contains(read(small), "coord θ : angle\n"));
  CHECK(contains(read(small), "start θ = 60 deg\n"));
  CHECK(maup({"check", small}).code == 0);
  CHECK(maup({"fmt", "--check", small}).code == 0);
  CHECK(maup({"test", small}).code == 0);
  CHECK(maup({"compare", a, small}).code == 0);
  const Outcome printed = maup({"reduce", "-"}, cartesian);
  CHECK(printed.code == 0);
  CHECK(contains(printed.out, "let x = l sin θ, y = -l cos θ\n"));
  CHECK(contains(printed.err, "proved"));
  CHECK(maup({"check", "-"}, printed.out).code == 0);
}

TEST_CASE("reduce: what is not elementary is refused with the proposal") {
  const std::string loop =
      "system loop\nparam m = 1 kg, a = 1 m, b = 2 m, g = 9.81 m/s^2\ncoord α, β, γ : angle\n"
      "point A mass m at a (cos α, sin α)\npoint B mass m at A + b (cos β, sin β)\ngravity (0, -g)\n"
      "constraint a cos α + b cos β - b cos γ = b\nconstraint a sin α + b sin β = b sin γ\nstart α = 60 deg\nrun 1 s\n";
  const Folder folder;
  const Outcome outcome = maup({"reduce", "-", "-o", folder.path("small.lag")}, loop);
  CHECK(outcome.code == 1);
  CHECK(contains(outcome.err, "E0831"));
  CHECK(contains(outcome.err, "as independent"));
  CHECK(folder.names().empty());
  const Json json = json_of(maup({"reduce", "-", "--json"}, loop));
  REQUIRE(json.is_object());
  CHECK(json.at("ok") == false);
  CHECK(json.at("text").is_null());
  CHECK(json.at("independent").size() == 1);
  CHECK(json.at("dependent").size() == 2);
  CHECK(maup({"reduce", "-"}, pendulum).code == 1);
  CHECK(maup({"reduce", folder.path("none.lag")}).code == 2);
}

TEST_CASE("compare: 5 for evidence without a proof, 4 where only one is defined") {
  const Folder folder;
  const std::string a = folder.write("cartesian.lag", cartesian), b = folder.write("pendulum.lag", pendulum);
  const Outcome evidence = maup({"compare", b, a, "--map", "θ = atan2(x, -y)"});
  CHECK_MESSAGE(evidence.code == 5, evidence.err);
  CHECK(contains(evidence.out, "by evidence and not proved: holds to 60 digits"));
  const Json json = json_of(maup({"compare", b, a, "--map", "θ = atan2(x, -y)", "--json"}));
  CHECK(json.at("verdict") == "evidence");
  CHECK(json.at("ok") == false);
  const std::string head = "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x = 1\nrun 0.5\n";
  const Outcome domain = maup({"compare", folder.write("both.lag", head + "V = log(x^2)\n"),
                               folder.write("right.lag", head + "V = 2 log(x)\n")});
  CHECK(domain.code == 4);
  CHECK(contains(domain.out, "they agree where both are"));
}

TEST_CASE("energies that jump are refused before anything is derived or run") {
  const Folder folder;
  const std::string model = folder.write(
      "step.lag",
      "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 0.4 step(x - 1)\nstart x' = 1\nrun 3\n");
  for (const char* command : {"check", "derive", "simulate"}) {
    const Outcome outcome = maup({command, model});
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.err, "V jumps by 0.4 where x = 1"));
  }
}
