// maup simulate --precision, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

const std::string oscillator =
    "system o\nparam m = 1 kg, k = 1 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun 2 s\n";

// cos 2 and cos 0.1, summed in Python's decimals.
const std::string cos2 =
    "-0.416146836547142386997568229500762189766000771075544890755149973781964936124079169074531777860169140";
const std::string cos01 =
    "0.99500416527802576609556198780387029483857622541508403595935274468526591021824046652966361852826";

}  // namespace

TEST_CASE("simulate --precision: all digits and no more, in text and JSON") {
  const Folder folder;
  const std::string model = folder.write("o.lag", oscillator);
  const Outcome quad = maup({"simulate", model, "--precision", "quad"});
  CHECK(quad.code == 0);
  CHECK(contains(quad.out, cos2.substr(0, 33)));
  CHECK_FALSE(contains(quad.out, cos2.substr(0, 37)));
  const Outcome text = maup({"simulate", model, "--precision", "100", "--at", "0.1s"});
  CHECK(text.code == 0);
  CHECK(contains(text.out, "t = 0.1 s"));
  CHECK(contains(text.out, cos01));
  CHECK(contains(text.out, cos2.substr(0, 98)));
  const Json json = json_of(maup({"simulate", model, "--precision", "100", "--at", "100 ms", "--json"}));
  CHECK(json.at("precision") == "100");
  CHECK(json.at("final").at("state").at("x").get<std::string>().substr(0, 98) == cos2.substr(0, 98));
  CHECK(json.at("final").at("digits").at("x") == 100);
  CHECK(json.at("at").at(0).at("t") == "0.1");
  CHECK(json.at("statistics").at("check_bits") == 448);
  CHECK(json.at("ok") == true);
}

TEST_CASE("precision and method as statements of the model, and overruled") {
  const Folder folder;
  const std::string quad = folder.write("quad.lag", oscillator + "precision quad\n");
  CHECK(contains(maup({"simulate", quad}).out, cos2.substr(0, 33)));
  CHECK(json_of(maup({"simulate", quad, "--json"})).at("precision") == "quad");
  CHECK_FALSE(contains(maup({"simulate", quad, "--precision", "double"}).out, cos2.substr(0, 20)));
  CHECK(json_of(maup({"simulate", quad, "--precision", "100", "--json"})).at("precision") == "100");
  const auto method_of = [](const Outcome& o) { return json_of(o).at("statistics").at("method").get<std::string>(); };
  const std::string steps = folder.write("steps.lag", oscillator + "method variational order 2 step 100 ms\n");
  CHECK(method_of(maup({"simulate", steps, "--json"})) == "variational");
  CHECK(json_of(maup({"simulate", steps, "--json"})).at("statistics").at("steps") == 20);
  CHECK(json_of(maup({"simulate", steps, "--step", "50ms", "--json"})).at("statistics").at("steps") == 40);
  CHECK(method_of(maup({"simulate", steps, "--method", "taylor", "--json"})) == "taylor");
  CHECK(method_of(maup({"simulate", steps, "--method", "auto", "--json"})) == "taylor");
  const Outcome both = maup({"simulate", folder.write("both.lag", oscillator + "precision quad\nmethod stiff\n")});
  CHECK(both.code == 1);
  CHECK(contains(both.err, "E0725"));
}

TEST_CASE("simulate --precision: a trajectory with all digits") {
  const Folder folder;
  const std::string model = folder.write("o.lag", oscillator);
  CHECK(maup({"simulate", model, "--precision", "quad", "--every", "0.1s", "-o", folder.path("o.csv")}).code == 0);
  const std::string csv = read(folder.path("o.csv"));
  CHECK(csv.rfind("t [s],x [m],x' [m/s],energy [J]\r\n0,1.0", 0) == 0);
  CHECK(contains(csv, "\r\n0.100000000000000000000000000000000," + cos01.substr(0, 33)));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 22);
}

TEST_CASE("simulate --precision: what is not possible") {
  const Folder folder;
  const std::string model = folder.write("o.lag", oscillator);
  const auto refused = [&](std::vector<std::string> more, const std::string& part, int code) {
    std::vector<std::string> arguments{"simulate", model, "--precision", "quad"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = maup(arguments);
    CAPTURE(part);
    CHECK(outcome.code == code);
    CHECK(contains(outcome.err, part));
    CHECK(outcome.out.empty());
  };
  refused({"--method", "stiff"}, "E0725", 1);
  refused({"--method", "variational", "--step", "1ms"}, "E0809", 2);
  refused({"--order", "500"}, "E0809", 2);
  refused({"--plot", folder.path("o.svg")}, "E0809", 2);
  refused({"-o", folder.path("o.npy")}, "E0810", 2);
  refused({"--at", "-1s"}, "E0706", 1);
  const Outcome unknown = maup({"simulate", model, "--precision", "octuple"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "octuple"));
  CHECK(folder.names().size() == 1);
}

TEST_CASE("simulate --precision: a collision, and Ctrl-C") {
  const Folder folder;
  const std::string fall = folder.write(
      "fall.lag", "system fall\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\nrun 3\n");
  const Outcome collision = maup({"simulate", fall, "--precision", "quad"});
  CHECK(collision.code == 3);
  CHECK(contains(collision.err, "collision"));
  const std::string model = folder.write("o.lag", oscillator);
  const Outcome stopped =
      shell("timeout -s INT 1 \"$MAUP\" simulate " + model + " --precision 100 --duration 1e7s; exit $?");
  CHECK(contains(stopped.err, "interrupted"));
}
