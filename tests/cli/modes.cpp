// maup modes, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

const std::string gallery = std::string(PROJECT_DIR) + "/models/";

Json document(const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"modes"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.push_back("--json");
  return json_of(maup(all));
}

}  // namespace

TEST_CASE("modes of a pendulum: formulas, frequency, verdict") {
  const Outcome all = maup({"modes", "-"}, pendulum);
  CHECK_MESSAGE(all.code == 0, all.err);
  CHECK(contains(all.out, "2 equilibria"));
  CHECK(contains(all.out, "θ = π"));
  CHECK(contains(all.out, "unstable: an eigenvalue has a positive real part"));
  CHECK(contains(all.out, "M = [ m l^2 ]"));
  CHECK(contains(all.out, "ω² = g/l"));
  const Outcome one = maup({"modes", "-", "--at", "θ=0", "--set", "l=2m"}, pendulum);
  CHECK_MESSAGE(one.code == 0, one.err);
  CHECK(contains(one.out, "stable: the Hessian of the potential is positive definite"));
}

TEST_CASE("values of a sweep without points are told") {
  const Outcome told = maup({"modes", "-", "--sweep", "l = -1 .. 1 m steps 3"}, pendulum);
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "no point was found at l = 0\n"));
  CHECK_FALSE(contains(maup({"modes", "-", "--sweep", "l = 1 .. 2 m steps 3"}, pendulum).out, "no point was found"));
}

TEST_CASE("a sweep tells the fold in which branches end") {
  const std::string node = "dimensionless\nparam a = 1\ncoord x : number\nL = 1/2 x'^2 + a x - (x - 2)^3/3\n";
  const Outcome told = maup({"modes", "-", "--sweep", "a = 1 .. -0.9 steps 9"}, node);
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(contains(told.out, "branches 1 and 2 meet in a fold at a = "));
  CHECK(contains(told.out, ": x = 2\n"));
  const Json json = Json::parse(maup({"modes", "-", "--sweep", "a = 1 .. -0.9 steps 9", "--json"}, node).out);
  REQUIRE(json.at("folds").size() == 1);
  CHECK(std::abs(json.at("folds")[0].at("value").get<double>()) < 1e-12);
  CHECK(json.at("folds")[0].at("branches") == Json::array({0, 1}));
}

TEST_CASE("mirror images are said once") {
  const auto times = [](const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  };
  const Outcome cone = maup({"modes", "-"},
                            "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ, φ : angle\n"
                            "T = 1/2 m l^2 (θ'^2 + sin(θ)^2 φ'^2)\nV = -m g l cos θ\n"
                            "start θ = 60 deg, φ' = 4.43 rad/s\n");
  REQUIRE_MESSAGE(cone.code == 0, cone.err);
  CHECK(contains(cone.out, "1 steady motion (Newton"));  // (θ, φ) and (−θ, φ + π) are one place, and no mirror image
  CHECK_FALSE(contains(cone.out, "θ = -"));
  CHECK(times(cone.out, "residual of the eigenvalue problem") == 1);
  // Wells of two depths are no images of each other.
  const std::string wells = "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nstart x = 1, y = 1\n";
  const Outcome even = maup({"modes", "-"}, wells + "V = (x^2 - 1)^2 + x y^2/4 + y^2\n");
  CHECK_MESSAGE(even.code == 0, even.err);
  CHECK_FALSE(contains(even.out, "mirror image"));
  const Outcome wells_alike = maup({"modes", "-"}, wells + "V = (x^2 - 1)^2 + x^2 y^2/4 + y^2\n");
  CHECK(times(wells_alike.out, "mirror image of 1, in x") == 1);
  CHECK(times(wells_alike.out, "residual of the eigenvalue problem") == 2);  // the saddle between them
}

TEST_CASE("modes --json: schema, points, matrices, modes") {
  const Json json = document({gallery + "coupled_pendulums.lag", "--at", "θ1=0, θ2=0"});
  CHECK(json.at("schema") == 1);
  CHECK(json.at("ok") == true);
  REQUIRE(json.at("points").size() == 1);
  const Json& point = json.at("points")[0];
  CHECK(point.at("at_rest") == true);
  CHECK(point.at("stability").at("verdict") == "stable");
  REQUIRE(point.at("modes").size() == 2);
  CHECK(std::abs(point.at("modes")[0].at("frequency").get<double>() - std::sqrt(9.81)) < 1e-13);
  CHECK(point.at("linearization").at("second_order").at("M")[0][0] == 1.0);
  CHECK(point.at("linearization").at("state_space").at("A").size() == 4);
}

TEST_CASE("modes where the constraints leave nothing that could move") {
  const Outcome held = maup({"modes", "-", "--at", "x=0, y=-1m"},
                            "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
                            "V = m g y\nconstraint x^2 + y^2 = l^2\nconstraint x = 0\nstart y = -1 m\n");
  CHECK_MESSAGE(held.code == 0, held.err);
  CHECK(contains(held.out, "the constraints leave nothing that could move, to first order"));
  CHECK(contains(held.out, "independent: none\n"));
  CHECK_FALSE(contains(held.out, "eigenvalue"));
}

TEST_CASE("modes --at a time of the motion") {
  const Outcome along = maup({"modes", "-", "--at", "1s"}, pendulum);
  CHECK_MESSAGE(along.code == 0, along.err);
  CHECK(contains(along.out, "not decided by the linearization: a point of a motion is no state of rest"));
}

TEST_CASE("modes --Q: a regulator, and what it needs") {
  const std::string cart = gallery + "balanced_cart.lag";
  if (json_of(maup({"doctor", "--json"})).at("regulator") == "needs LAPACK") {
    CHECK(contains(maup({"modes", cart, "--at", "θ=180deg", "--Q", "1"}).err, "E1315"));
    return;
  }
  const Json json = document({cart, "--at", "θ=180deg", "--Q", "1, 1, 0, 0", "--R", "0.1"});
  REQUIRE(json.contains("regulator"));
  const Json& r = json.at("regulator");
  CHECK(r.at("residual").get<double>() < 1e-12);
  for (const Json& pole : r.at("poles")) CHECK(pole[0].get<double>() < 0);
  CHECK(r.at("gain")[0].size() == 4);
  const auto code = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = maup(arguments);
    CHECK(outcome.code == (arguments.back() == "one" ? 2 : 1));  // no number at all is a mistake of the option alone
    return outcome.err.substr(outcome.err.find("error ") + 6, 5);
  };
  CHECK(code({"modes", cart, "--at", "θ=180deg", "--Q", "1, 1"}) == "E1311");
  CHECK(code({"modes", cart, "--at", "θ=180deg", "--Q", "1", "--R", "0"}) == "E1311");
  CHECK(code({"modes", cart, "--at", "θ=180deg", "--Q", "0"}) == "E1313");  // the cart drifts and costs nothing
  CHECK(code({"modes", cart, "--at", "θ=180deg", "--Q", "one"}) == "E0809");
  CHECK(code({"modes", gallery + "coupled_pendulums.lag", "--at", "θ1=0, θ2=0", "--Q", "1"}) == "E1310");
}

TEST_CASE("modes of a sweep: the bead leaves the lowest point at √(g/R)") {
  const Folder folder;
  const std::string csv = folder.path("locus.csv"), svg = folder.path("bifurcation.svg"),
                    roots = folder.path("roots.svg");
  const Outcome outcome = maup({"modes", gallery + "bead_on_hoop.lag", "--csv", csv, "--plot", svg, "--roots", roots});
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "Ω = 5.71839"));  // √(9.81/0.3)
  CHECK(contains(read(csv), "Ω [rad/s],branch,verdict,θ [rad],θ' [rad/s],re1,im1"));
  for (const std::string& picture : {svg, roots}) CHECK(contains(read(picture), "<svg"));
  const Outcome without = maup({"modes", "-", "--csv", csv}, pendulum);
  CHECK(without.code == 1);
  CHECK(contains(without.err, "E1320"));
}

TEST_CASE("modes: a stiffness that is a small difference of constants has its digits") {
  const Folder folder;
  const std::string model =
      folder.write("soft.lag",
                   "system soft\ndimensionless\nparam b = 0.001\ncoord x, y : number\n"
                   "L = x'^2/2 + y'^2/2 - 1e10 (cos(b) - 1 + b^2/2) (x - y)^2/2 - x^2/2\nstart x = 0.1\nrun 1\n");
  CHECK(contains(maup({"modes", model}).out, "0.0204081612"));  // in double 0.0204000
}

TEST_CASE("modes: what cannot be answered says why") {
  const Outcome nowhere = maup({"modes", "-", "--at", "θ=1"}, pendulum);
  CHECK(nowhere.code == 1);
  CHECK(contains(nowhere.err, "E1302"));
  CHECK(contains(nowhere.err, "θ = 0"));  // where Newton's method ends
  const Outcome longer =
      maup({"modes", PROJECT_DIR "/models/tumbling_satellite.lag", "--at", "sat.qx = 2, ω2 = 1 rad/s"});
  CHECK(longer.code == 1);
  CHECK(contains(longer.err, "break the norm of sat"));
  CHECK(contains(maup({"modes", "-", "--at", "ψ=1"}, pendulum).err, "E0224"));
  const Outcome fall = maup(
      {"modes", "-"}, "param m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\nstart z = 1 m\n");
  CHECK(fall.code == 1);
  CHECK(contains(fall.err, "E1301"));
}

TEST_CASE("expect frequencies and equilibria: passed and failed") {
  const std::string model =
      std::string(pendulum) +
      "expect frequencies at θ = 0 : 0.498488 Hz rel 1e-6\nexpect equilibrium at θ = 0 is stable\n";
  CHECK(maup({"test", "-"}, model).code == 0);
  const Outcome wrong =
      maup({"test", "-"},
           std::string(pendulum) +
               "expect frequencies at θ = 0 : 0.5 Hz rel 1e-5\nexpect equilibrium at θ = 180 deg is stable\n");
  CHECK(wrong.code == 4);
  CHECK(contains(wrong.out, "0.4984"));
  CHECK(contains(wrong.out, "unstable"));
}

TEST_CASE("modes of a chain of a hundred links") {
  const Folder folder;
  const std::string path = folder.write("chain.lag", maup({"new", "chain", "--links", "100", "-o", "-"}).out);
  const Json json = document({path, "--at", "θ1=0"});
  CHECK(json.at("ok") == true);
}

TEST_CASE("modes with what is measured: acceleration of a cart, force in a rod") {
  const Json cart = document({gallery + "balanced_cart.lag", "--at", "θ=180deg", "--y", "x''", "x + l sin θ"});
  const Json& y = cart["points"][0]["linearization"]["measured"];
  CHECK(y["D"] == Json::parse("[[0.5], [0.0]]"));  // (M + m - m) x'' = u at the top: M = 2 kg
  CHECK(y["C"][1][0] == 1.0);
  const Outcome rod = maup({"modes", gallery + "cartesian_pendulum.lag", "--at", "0.3s", "--y", "reaction(rod)"});
  CHECK_MESSAGE(rod.code == 0, rod.err);
  CHECK(contains(rod.out, "y = reaction(rod)"));
  const Outcome unknown = maup({"modes", "-", "--y", "zz"}, pendulum);
  CHECK(unknown.code != 0);
  CHECK(contains(unknown.err, "`zz` is not declared"));
}

TEST_CASE("an output without a value or a derivative at the point is refused, and no number is shown") {
  const auto refused = [](const std::vector<std::string>& arguments, const char* what) {
    CAPTURE(what);
    std::vector<std::string> all{"modes", gallery + "pendulum.lag"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome told = maup(all);
    CHECK(told.code == 2);
    CHECK(told.out.empty());
    CHECK(contains(told.err, "E1306"));
    CHECK_MESSAGE(contains(told.err, what), told.err);
    all.push_back("--json");
    const Json json = json_of(maup(all));
    CHECK(json["ok"] == false);
    CHECK(!json.contains("points"));
  };
  refused({"--at", "θ=0", "--y", "1/θ"}, "y = 1/θ has no value at θ = 0");
  refused({"--at", "θ=0", "--y", "sin(θ)/θ"}, "has no value at θ = 0");
  refused({"--at", "θ=0", "--y", "√θ"}, "y = √θ has no derivative at θ = 0");
  refused({"--at", "θ=0", "--y", "abs(θ)"}, "y = abs(θ) has no derivative at θ = 0");  // C was [0 0]
  refused({"--at", "θ=0", "--y", "sign(θ)"}, "y = sign(θ) has no derivative");
  refused({"--y", "θ", "1/(θ - pi)"}, "y = 1/(θ - pi) has no value at θ = π");  // one of two equilibria
  CHECK(maup({"modes", gallery + "pendulum.lag", "--at", "0.3s", "--y", "1/θ", "abs(θ)"}).code == 0);
  CHECK(maup({"modes", gallery + "pendulum.lag", "--at", "θ=0", "--y", "θ abs(θ)"}).code == 0);  // smooth enough
}

TEST_CASE("modes: options without what they belong to") {
  CHECK(maup({"modes", "-", "--R", "2"}, pendulum).code == 2);
  const Outcome locus =
      maup({"modes", gallery + "bead_on_hoop.lag", "--sweep", "Ω = 0 .. 12 rad/s steps 3", "--y", "θ"});
  CHECK(locus.code == 2);
  CHECK(contains(locus.err, "A locus"));
}

TEST_CASE("modes of a periodic motion are its Floquet multipliers") {
  const Json orbit = document({gallery + "pendulum.lag", "--orbit"});
  REQUIRE(orbit["floquet"]["multipliers"].size() == 2);
  CHECK(std::abs(orbit["floquet"]["period"].get<double>() - 2.1528746668805) < 1e-10);  // 4 K(1/2) sqrt(l/g) of 60°
  CHECK(maup({"modes", gallery + "pendulum.lag", "--orbit", "3kg"}).code == 2);
  CHECK(maup({"modes", gallery + "pendulum.lag", "--orbit", "--at", "θ=0"}).code == 2);
}
