// maup orbits, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

const std::string henon_heiles =
    "system hh \"Hénon and Heiles\"\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
    "V = 1/2 (x^2 + y^2) + x^2 y - 1/3 y^3\nstart x' = 0.5, y = 0.1\nrun 200\n";

std::string code_of(const Outcome& outcome) {
  const Json document = json_of(outcome);
  REQUIRE(document.at("diagnostics").size() == 1);
  return document.at("diagnostics")[0].at("code");
}

}  // namespace

TEST_CASE("orbits --floquet: the pendulum's period, text and document") {
  const Folder folder;
  const std::string model = folder.write("p.lag", pendulum);
  const Outcome text = maup({"orbits", model, "--floquet"});
  CHECK_MESSAGE(text.code == 0, text.err);
  CHECK(contains(text.out, "period              2.15"));
  CHECK(contains(text.out, "trivial             1 and 1"));
  CHECK(contains(text.out, "the symplectic form is preserved"));
  const Json document = json_of(maup({"orbits", model, "--floquet", "--json", "--set", "l=2m"}));
  CHECK(document.at("schema") == 1);
  CHECK(document.at("ok") == true);
  const Json& f = document.at("floquet");
  CHECK(std::abs(f.at("period").get<double>() - 4 * std::sqrt(2 / 9.81) * std::comp_ellint_1(0.5)) < 1e-12);
  CHECK(f.at("trivial") == 2);
  CHECK(f.at("multipliers").size() == 2);
  CHECK(f.at("stability") == "neutral");
}

TEST_CASE("orbits --section: table, CSV, picture of many motions at one energy") {
  const Folder folder;
  const std::string model = folder.write("hh.lag", henon_heiles), csv = folder.path("s.csv"),
                    svg = folder.path("s.svg");
  const Outcome one = maup({"orbits", model, "--section", "x = 0 rising", "--crossings", "20"});
  CHECK_MESSAGE(one.code == 0, one.err);
  CHECK(contains(one.out, "section x = 0 rising, 20 crossings of 1 motion"));
  CHECK(contains(one.out, "and 8 more"));
  const Outcome many = maup({"orbits", model, "--section", "x = 0 rising", "--starts", "9", "--crossings", "30",
                             "--energy", "0.125", "-o", csv, "--plot", svg, "--json"});
  CHECK_MESSAGE(many.code == 0, many.err);
  const Json section = json_of(many).at("section");
  CHECK(section.at("orbits").size() == 9);
  CHECK(section.at("crossings").size() == 270);
  for (const Json& o : section.at("orbits")) {
    CHECK(std::abs(o.at("energy").get<double>() - 0.125) < 1e-15);
    CHECK(o.at("energy_drift").get<double>() < 1e-13);
  }
  CHECK(contains(read(csv), "t [s],orbit,number,x,y,x',y'\r\n"));
  CHECK(contains(read(svg), "class=\"dots"));
  CHECK(contains(read(svg), "class=\"outline\""));
  CHECK(contains(read(svg), "E = 0.125"));
}

TEST_CASE("orbits --lyapunov: the sum rule in text and document, the averages as CSV") {
  const Folder folder;
  const std::string model = folder.write("hh.lag", henon_heiles), csv = folder.path("l.csv");
  const Outcome text = maup({"orbits", model, "--lyapunov", "-o", csv});
  CHECK_MESSAGE(text.code == 0, text.err);
  CHECK(contains(text.out, "(Liouville, to "));
  CHECK(contains(read(csv), "t [s],λ1,λ2,λ3,λ4\r\n"));
  const Json l = json_of(maup({"orbits", model, "--lyapunov", "--duration", "100s", "--json"})).at("lyapunov");
  CHECK(l.at("exponents").size() == 4);
  CHECK(std::abs(l.at("sum").get<double>()) < 1e-9);
  CHECK(l.at("expected_sum") == 0.0);
  CHECK(l.at("sum_rule_residual").get<double>() < 1e-9);
  CHECK(json_of(maup({"orbits", model, "--lyapunov", "--exponents", "1", "--json"}))
            .at("lyapunov")
            .at("exponents")
            .size() == 1);
}

TEST_CASE("orbits: a system without a drive, without chaos, and without a name") {
  const std::string hoop =
      "param m = 1 kg, R = 0.5 m, g = 9.81 m/s^2, Ω = 3 rad/s\ncoord θ : angle\n"
      "point P mass m at R (sin θ cos(Ω t), sin θ sin(Ω t), -cos θ)\ngravity (0, 0, -g)\nstart θ = 0.1 rad\nrun 5 s\n";
  const Outcome floquet = maup({"orbits", "-", "--floquet"}, hoop);
  CHECK(contains(floquet.out, "the model: a periodic motion"));
  CHECK_FALSE(contains(floquet.out, "of the drive"));
  CHECK(contains(maup({"orbits", "-", "--lyapunov", "--duration", "100s"}, hoop).out, "  not chaotic  "));
  const Json l = json_of(maup({"orbits", "-", "--lyapunov", "--json"}, hoop)).at("lyapunov");
  CHECK(l.at("chaos") == "excluded");
  const Json conserves = json_of(maup({"orbits", "-", "--lyapunov", "--json"},
                                      "dimensionless\ncoord x, y : number\nL = y x' - (exp(x) - x + exp(y) - y)\n"
                                      "start x = 0.5\nrun 50\n"));
  CHECK(conserves.at("lyapunov").at("kaplan_yorke").is_null());
  const Folder folder;
  const std::string model = folder.write("h.lag", hoop), svg = folder.path("s.svg");
  CHECK(maup({"orbits", model, "--section", "θ = 0 rising", "--crossings", "5", "--plot", svg}).code == 0);
  CHECK(contains(read(svg), ">section "));
  CHECK(contains(read(svg), "<svg"));
}

TEST_CASE("orbits --floquet: multipliers that rounding hides") {
  const std::string text =
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2)\nD = 20 x'^2 + c y'^2\n"
      "force x = cos(t)\nrun 10\n";
  const Outcome one = maup({"orbits", "-", "--floquet"}, "param c = 0.1\n" + text),
                two = maup({"orbits", "-", "--floquet"}, "param c = 20\n" + text);
  CHECK(contains(one.out, "log|μ|/T = -39.975, by the divergence"));  // −20 − √399
  CHECK(contains(two.out, "2, lost in the rounding of dΦ"));
}

TEST_CASE("orbits --floquet: the time of a start that is not the model's") {
  const Outcome riding =
      maup({"orbits", "-", "--floquet"},
           "dimensionless\ncoord y : number\nL = 1/2 y'^2 - y\ncontact y >= 0.4 sin(t) restitution 0.5 name table\n"
           "start y = 0, y' = 0.4\nrun 60\n");
  CHECK(contains(riding.out, "start               t = "));
  CHECK(contains(riding.out, "0, of 2 directions that contacts and friction hold"));
}

TEST_CASE("orbits: times that are parts of π, and sections of an angle that turns") {
  const Folder folder;
  const std::string rotor = folder.write(
      "rotor.lag", "system rotor\ndimensionless\ncoord a, b : angle\nL = 1/2 (a'^2 + b'^2)\nstart a' = 3\nrun 10\n");
  for (const auto& [text, time] : {std::pair("pi", "3.14159265"), std::pair("2 pi/3 s", "2.09439510"),
                                   std::pair("-2*pi/-3", "2.09439510"), std::pair("0.5 π ms", "0.00157079632")}) {
    const Outcome strobe = maup({"orbits", rotor, "--strobe", text, "--crossings", "1", "--json"});
    CAPTURE(strobe.out);
    CHECK(contains(strobe.out, time));
  }
  CHECK(contains(maup({"orbits", rotor, "--section", "a = 1 rising", "--crossings", "9"}).out, "9 crossings"));
  const Outcome none = maup({"orbits", rotor, "--section", "2 a = 1 falling", "--longest", "10s"});
  CHECK(contains(none.err, "sin(a) = 0"));
}

TEST_CASE("orbits: what cannot be had, and wrong usage") {
  const Folder folder;
  const std::string model = folder.write("hh.lag", henon_heiles);
  const auto refused = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"orbits", model});
    options.push_back("--json");
    return maup(options);
  };
  CHECK(maup({"orbits", model}).code == 2);
  CHECK(maup({"orbits", model, "--floquet", "--lyapunov"}).code == 2);
  CHECK(maup({"orbits", model, "--floquet", "--period", "3kg"}).code == 2);
  CHECK(maup({"orbits", model, "--section", "x = 0", "--plot", "a.gif"}).code == 2);
  const Outcome never = refused({"--section", "x = 7", "--longest", "100s"});
  CHECK(never.code == 3);
  CHECK(code_of(never) == "E1405");
  CHECK(code_of(refused({"--section", "x' = 0", "--starts", "4"})) == "E1407");
  CHECK(code_of(refused({"--strobe", "0s"})) == "E1406");
  for (const char* no_time : {"pi kg", "pi/0", "2 pi/", "pie", "-pi"})
    CHECK(maup({"orbits", model, "--strobe", no_time}).code == 2);
  CHECK(code_of(refused({"--floquet", "--start", "x'=0", "--start", "y=0"})) == "E1402");
  CHECK(code_of(refused({"--floquet", "--period", "1e-300s"})) == "E1406");  // it moves, and not in so short a time
  const Outcome unknown = refused({"--section", "z = 0"});
  CHECK(unknown.code == 2);
  CHECK(code_of(unknown) == "E0201");
  const Outcome jump =
      maup({"orbits", "-", "--lyapunov", "--json"},
           "system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = abs(x)\nstart x = 1\nrun 10\n");
  CHECK(jump.code == 3);
  CHECK(code_of(jump) == "E1403");
}
