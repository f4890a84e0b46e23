// Degenerate Lagrangians from outside: what is told, what is left out, what every command makes of them.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace cli_test;

namespace {

const std::string predators = R"(dimensionless
param a = 1, b = 0.1, c = 1.5, d = 0.075
coord x, y : number
L = 1/2 (log(x) y'/y - log(y) x'/x) - (d x - c log(x) + b y - a log(y))
start x = 10, y = 5
run 6
)";
const std::string cawley =
    "dimensionless\ncoord x, y, z : number\nL = x' z' + 1/2 y z^2\nstart x = 0.3, x' = 0.7\nrun 1\n";

}  // namespace

TEST_CASE("a Lagrangian of the first order has equilibria, frequencies, periods and runs") {
  const auto modes = json_of(maup({"modes", "-", "--at", "x=20, y=10", "--json"}, predators));
  REQUIRE(modes["points"].size() == 1);
  CHECK(modes["points"][0]["multipliers"].empty());
  const Outcome text = maup({"modes", "-", "--at", "x=20, y=10"}, predators);
  CHECK(contains(text.out, "x = (x, y)\n"));
  CHECK_MESSAGE(text.code == 0, text.err);
  CHECK(contains(text.out, "1.2247448"));
  const Outcome orbit = maup({"orbits", "-", "--floquet", "--period", "5.4"}, predators);
  CHECK_MESSAGE(orbit.code == 0, orbit.err);
  CHECK(contains(orbit.out, "5.479716342"));
  const auto run = json_of(maup({"simulate", "-", "--json", "--duration", "15"}, predators));
  CHECK(std::abs(run["final"]["state"]["x"].get<double>() - 9.780002256569053638767) < 1e-10);
  CHECK(run["final"]["multipliers"].empty());
  const Outcome quad = maup({"simulate", "-", "--duration", "15", "--precision", "quad"}, predators);
  CHECK(contains(quad.out, "x = 9.780002256569053638"));
}

TEST_CASE(
    "a strict extremum of h_E, which a Lagrangian of the first order keeps, is stable; nothing else is said to be") {
  const auto verdict = [](const std::string& model, const std::string& at) {
    return json_of(maup({"modes", "-", "--at", at, "--json"}, model))["points"][0]["stability"];
  };
  const auto minimum = verdict(predators, "x=20, y=10");
  CHECK(minimum["verdict"] == "stable");
  CHECK(contains(minimum["reason"].get<std::string>(), "strict minimum"));
  const std::string first = "dimensionless\ncoord x, y, u, v : number\nL = x y' + u v' ";
  CHECK(contains(verdict(first + "+ x^2 + y^2 + u^2 + 3 v^2\n", "x=0, y=0, u=0, v=0")["reason"].get<std::string>(),
                 "strict maximum"));
  // The same eigenvalues ± i 2 and ± i 2 √3, and h_E is a saddle.
  CHECK(verdict(first + "+ x^2 + y^2 - u^2 - 3 v^2\n", "x=0, y=0, u=0, v=0")["verdict"] == "undecided");
  CHECK(verdict(first + "- x^2 + y^2 - u^2 - v^2\n", "x=0, y=0, u=0, v=0")["verdict"] == "unstable");
  // A flat direction: v^4 decides nothing by second derivatives.
  CHECK(verdict(first + "- x^2 - y^2 - u^2 - v^4\n", "x=0, y=0, u=0, v=0")["verdict"] == "undecided");
}

TEST_CASE("many digits of a degenerate system begin on all that it asks of a state") {
  // A multiplier as a coordinate; the same circle as a constraint is the second way. y' is not written.
  const std::string plane = "dimensionless\ncoord x, y", start = "start x = 0.6, y = 0.8, x' = 1\nrun 1\n";
  const std::string as_coordinate = plane + ", z : number\nL = 1/2 x'^2 + 1/2 y'^2 - x + z (x^2 + y^2 - 1)\n" + start;
  const std::string as_constraint =
      plane + " : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = x\nconstraint x^2 + y^2 = 1\n" + start;
  const auto digits = [](const Outcome& run, const std::string& name) {
    const std::size_t at = run.out.find("\n  " + name + " = ");
    REQUIRE_MESSAGE(at != std::string::npos, run.err);
    return run.out.substr(at + 6 + name.size(), 28);
  };
  const auto quad = [](const std::string& model) { return maup({"simulate", "-", "--precision", "quad"}, model); };
  const Outcome one = quad(as_coordinate), other = quad(as_constraint);
  for (const char* name : {"x", "x'", "y", "y'"}) CHECK(digits(one, name) == digits(other, name));
  CHECK(contains(one.out, "  x = 0.99802985944634"));
}

TEST_CASE("many digits of a degenerate system begin where the run in double does, from a start that contradicts too") {
  const std::string model =
      "dimensionless\ncoord x, y, z : number\nL = 1/2 x'^2 + 1/2 y'^2 - x + z (x^2 + y^2 - 1)\n"
      "start x = 0.6, y = 0.8, x' = 1, y' = 5\nrun 1\n";
  const auto in_double = json_of(maup({"simulate", "-", "--json"}, model))["final"]["state"];
  const Outcome quad = maup({"simulate", "-", "--precision", "quad"}, model);
  CHECK(contains(quad.err, "W0701"));
  for (const char* name : {"x", "y", "z"}) {
    const std::size_t at = quad.out.find("\n  " + std::string(name) + " = ");
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(quad.out.substr(at + 6 + std::string(name).size())) ==
          doctest::Approx(in_double[name].get<double>()).epsilon(1e-12));
  }
}

TEST_CASE("constraints that are lost in rounding are said to be, and no number is said to vanish") {
  const Outcome told = maup({"check", "-"},
                            "dimensionless\ncoord x, y, z : number\nL = 29*x'^2*y^2/200 + 17*x'^2/20 + 19*x'*y'/100 + "
                            "99*y'^2/200 + z*(y - x)\nD = y'^2\nstart x = 3/20\nrun 3\n");
  CHECK(contains(told.err, "E0633"));
  CHECK(contains(told.err, "cannot be told from rounding"));
  CHECK_FALSE(contains(told.err, "1 is 0"));
}

TEST_CASE("variational steps of degenerate Lagrangians are refused, with and without relations between velocities") {
  for (const std::string& model :
       {predators,
        std::string(
            "dimensionless\ncoord x, z : number\nL = 1/2 x'^2 - 1/2 x^2 + z x - 1/2 z^2\nstart x = 1\nrun 1\n")}) {
    const Outcome refused = maup({"simulate", "-", "--method", "variational", "--step", "0.01"}, model);
    CHECK(refused.code != 0);
    CHECK(contains(refused.err, "E0731"));
    CHECK_FALSE(contains(refused.err, "singular"));
  }
}

TEST_CASE("models with degenerate Lagrangians are not compared") {
  const Folder folder;
  folder.write("first.lag", "dimensionless\ncoord x, y : number\nL = x y' - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 1\n");
  folder.write("second.lag", "dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + 1/2 y'^2 - 1/2 x^2 - 1/2 y^2\n");
  for (const auto& [a, b] : {std::pair{"first.lag", "second.lag"}, {"second.lag", "first.lag"}}) {
    const Outcome refused = maup({"compare", folder.path(a), folder.path(b)});
    CHECK(refused.code == 1);
    CHECK(contains(refused.err, "E0834"));
  }
}

TEST_CASE("models whose events set the state are not compared") {
  const Folder folder;
  const std::string plain = "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\nrun 10\n";
  folder.write("plain.lag", plain);
  folder.write("kicked.lag", plain + "event kick when x = 0 falling : set x' = 2 x'\n");
  folder.write("told.lag", plain + "event e when x = 0 falling : record\n");
  for (const auto& [a, b] : {std::pair{"plain.lag", "kicked.lag"}, {"kicked.lag", "plain.lag"}}) {
    const Outcome refused = maup({"compare", folder.path(a), folder.path(b)});
    CHECK(refused.code == 1);
    CHECK(contains(refused.err, "E0835"));
  }
  CHECK(maup({"compare", folder.path("plain.lag"), folder.path("told.lag")}).code == 0);
}

TEST_CASE("what depends on free functions is left out, and said") {
  const Outcome run = maup({"simulate", "-"}, cawley);
  CHECK(contains(run.err, "W0622"));
  CHECK(contains(run.err, "N0630"));
  const auto json = json_of(maup({"simulate", "-", "--json"}, cawley));
  CHECK(json["final"]["state"].contains("x"));
  CHECK_FALSE(json["final"]["state"].contains("y"));
  CHECK_FALSE(json["final"]["errors"].contains("y'"));
  const Outcome many = maup({"simulate", "-", "--precision", "quad"}, cawley);
  CHECK(many.code != 0);
  CHECK(contains(many.err, "E0631"));
  const Outcome chosen = maup({"simulate", "-"}, cawley + "gauge y = 1 + t\n");
  CHECK(contains(chosen.out, "y = 2"));
}

TEST_CASE("what is asked of one motion is refused where functions stay free, and answered with a gauge") {
  const std::string open =
      "dimensionless\nparam k = 4\ncoord r, θ, z : number\nL = 1/2 r'^2 + 1/2 r^2 (θ' - z)^2 - 1/2 k r^2\n"
      "start r = 1, r' = 0.1\nrun 3\n";
  const std::string chosen = open + "gauge z = 0\n";
  const auto refuses = [](const Outcome& outcome) {
    CHECK_MESSAGE(outcome.code != 0, outcome.out);
    CHECK_MESSAGE(contains(outcome.err, "E0631"), outcome.err);
    CHECK(outcome.out.empty());
  };
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"orbits", "-", "--section", "r = 0", "--duration", "9"},
                                             {"orbits", "-", "--lyapunov", "--duration", "9"},
                                             {"modes", "-"}}) {
    refuses(maup(command, open));
    CHECK(maup(command, chosen).code == 0);
  }
  refuses(maup({"simulate", "-", "--until", "z = 1", "--within", "3"}, open));
  refuses(maup({"simulate", "-"}, open + "event turned when θ = 1 : record\n"));
  refuses(maup({"simulate", "-"}, open + "event passed when r = 0.5 : set r' = z\n"));
  // r is cos 2t + sin 2t / 20 for every choice, and so are the instants at which it passes 1/2.
  const std::string event = "event passed when r = 0.5 : record\n";
  for (const std::string& model : {open, chosen}) {
    const auto run = json_of(maup({"simulate", "-", "--json"}, model + event));
    REQUIRE(run["events"].size() == 2);
    for (const auto& passed : run["events"]) {
      const double t = passed["t"].get<double>();
      CHECK(std::abs(std::cos(2 * t) + std::sin(2 * t) / 20 - 0.5) < 1e-14);
    }
  }
  const Outcome frequencies = maup({"test", "-"}, open + "expect frequencies at r = 0, z = 0 : 1 rel 1e-9\n");
  CHECK(frequencies.code == 4);
  CHECK(contains(frequencies.out, "found     any value\n    It depends on functions of time"));
}

TEST_CASE("derive and hamiltonian tell the constraints of both sides") {
  const Outcome derived = maup({"derive", "-"}, cawley);
  CHECK(contains(derived.out, "Constraints of the Lagrangian\n  0 = z    (first generation)\n"));
  CHECK(contains(derived.out, "2 single out a motion"));
  const auto json = json_of(maup({"derive", "-", "--json"}, cawley));
  CHECK(json["degenerate"]["free"].size() == 1);
  CHECK(json["degenerate"]["motions"] == 2);
  const Outcome dirac = maup({"hamiltonian", "-"}, cawley);
  CHECK(contains(dirac.out, "Secondary constraints\n  z = 0\n"));
  CHECK(contains(dirac.out, "Dirac's conjecture"));
  // Both counts are of L, whatever a gauge leaves open: here a constant rotation.
  const Outcome turned = maup({"hamiltonian", "-"},
                              "dimensionless\ncoord x, y, w : number\n"
                              "L = 1/2 ((x' - w y)^2 + (y' + w x)^2) - 1/2 (x^2 + y^2)\ngauge w = 1 + t\n");
  CHECK(contains(turned.out, "without the gauge count alike: 2 numbers"));
  CHECK_FALSE(contains(turned.out, "conjecture"));
  const auto phase = json_of(maup({"hamiltonian", "-", "--json", "--dirac-bracket", "x", "y"}, predators));
  CHECK(phase["dirac"]["second_class"] == 2);
  CHECK(phase["brackets"][0]["kind"] == "dirac");
  CHECK(phase["brackets"][0]["plain"] == "-x y");
  const Outcome none = maup({"hamiltonian", "-", "--dirac-bracket", "x", "p_x"},
                            "dimensionless\ncoord x : number\nL = 1/2 x'^2\nrun 1\n");
  CHECK(none.code != 0);
  CHECK(contains(none.err, "E1106"));
}

TEST_CASE("invariants of a degenerate system, and those that no free function of time moves") {
  const Outcome found = maup({"invariants", "-", "--no-drift"}, predators);
  CHECK(found.code == 0);
  CHECK(contains(found.out, "energy"));
  // The world line by any clock e: momenta and the boost are those of every choice; x' alone is not conserved.
  const auto open = json_of(maup({"invariants", "-", "--json"},
                                 "dimensionless\nparam m = 1.1\ncoord T, x, e : number\n"
                                 "L = (x'^2 - T'^2)/(2 e) - 1/2 e m^2\nstart e = 1, x' = 0.7, T' = sqrt(1.7)\n"));
  std::set<std::string> integrals;
  for (const auto& integral : open["integrals"]) integrals.insert(integral["plain"]);
  CHECK(integrals == std::set<std::string>{"-T'/e", "x'/e", "T x'/e - x T'/e"});
}

TEST_CASE("check lists rates by what they are") {
  const std::string text =
      "param m = 1 kg, I = 1 kg m^2\ncoord x, y : length, ψ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\n"
      "rates v = x' cos ψ + y' sin ψ, s = y' cos ψ - x' sin ψ, w = ψ'\n";
  CHECK(contains(maup({"check", "-"}, text).out, "rates                 v = cos ψ x' + sin ψ y'\n"));
  CHECK(json_of(maup({"check", "-", "--json"}, text))["rates"].size() == 3);
}

namespace {

const std::string two_carts_with_gauge =
    "dimensionless\ncoord x, y, A : number\npoint P at (x - y, 0)\n"
    "L = 1/2 (x' - A)^2 + 1/2 (y' - A)^2 - 1/2 (x - y)^2\nstart x = 1, y = 0, x' = 0.3, y' = -0.3\nrun 2\n";
const std::string relativistic = "dimensionless\ncoord T, x, y : number\nL = -sqrt(T'^2 - x'^2 - y'^2)";

}  // namespace

TEST_CASE("formulas that do not depend on free functions have values in every output, others are refused") {
  const Folder folder;
  // x - y swings with ω² = 2 from 1 with the rate 0.6, whatever A is; x' - A is half its rate.
  const double w = std::sqrt(2.0), at_2 = std::cos(2 * w) + 0.6 / w * std::sin(2 * w);
  const double rate = -w * std::sin(2 * w) + 0.6 * std::cos(2 * w);
  const auto final = json_of(maup({"simulate", "-", "--json"}, two_carts_with_gauge))["final"];
  CHECK(std::abs(final["state"]["x - y"].get<double>() - at_2) < 1e-14);
  CHECK(std::abs(final["state"]["x' - y'"].get<double>() - rate) < 1e-14);
  CHECK(std::abs(final["state"]["p_x"].get<double>() - rate / 2) < 1e-14);
  CHECK(final["errors"]["x - y"].get<double>() < 1e-13);
  CHECK_FALSE(final["state"].contains("x"));
  const auto columns = [&](const std::string& formulas) {
    return maup({"simulate", "-", "--every", "2", "--errors", "-o", folder.path("rows.csv"), "--columns", formulas},
                two_carts_with_gauge);
  };
  CHECK(columns("P.x, (x-y)^2, x' - A, x'' - y''").code == 0);
  const std::string rows = read(folder.path("rows.csv"));
  const std::string last = rows.substr(rows.rfind("\n2,") + 3);
  CHECK(std::abs(std::stod(last) - at_2) < 1e-14);
  CHECK(std::abs(std::stod(last.substr(last.find(',') + 1)) - at_2 * at_2) < 1e-14);
  std::string third = last;
  for (int k = 0; k < 3; ++k) third = third.substr(third.find(',') + 1);
  CHECK(std::abs(std::stod(third) + 2 * at_2) < 1e-14);
  for (const char* open : {"x", "x + y", "x' + y'", "x''"}) {
    const Outcome refused = columns(open);
    CHECK(refused.code != 0);
    CHECK_MESSAGE(contains(refused.err, "E0631"), refused.err);
  }
  CHECK(maup({"plot", "-", "--y", "x-y", "-o", folder.path("plot.svg")}, two_carts_with_gauge).code == 0);
  CHECK(maup({"test", "-"}, two_carts_with_gauge + "expect x'' - y'' at 0 = -2 rel 1e-12\n").code == 0);
  CHECK(contains(maup({"test", "-"}, two_carts_with_gauge + "expect x'' at 0 = 1 rel 1e-9\n").err, "free"));
}

TEST_CASE("drawings show what does not depend on free functions") {
  const Folder folder;
  const std::string film = folder.path("film.svg");
  CHECK(maup({"animate", "-", "-o", film}, two_carts_with_gauge + "draw O - P\n").code == 0);
  const Outcome open = maup({"animate", "-", "-o", film},
                            "dimensionless\ncoord x, y, A : number\npoint P at (x, 0)\n"
                            "L = 1/2 (x' - A)^2 + 1/2 (y' - A)^2 - 1/2 (x - y)^2\nstart x = 1\nrun 2\n");
  CHECK(contains(open.err, "E0631"));
  CHECK_FALSE(contains(open.err, "E0843"));
}

TEST_CASE("a gauge too many is told, with the one that it clashes with") {
  const auto refused = [](const std::string& text, const char* gauges) {
    const Outcome outcome = maup({"check", "-"}, text);
    CHECK(contains(outcome.err, "E0626"));
    CHECK_MESSAGE(contains(outcome.err, gauges), outcome.err);
  };
  refused(two_carts_with_gauge + "gauge A = 0\ngauge x = 0\n", "one too many beside `A = 0`");
  const std::string two = "dimensionless\ncoord x, y, A, B : number\nL = 1/2 (x' - A)^2 + 1/2 (y' - B)^2\n";
  refused(two + "gauge A = 0\ngauge A = sin(t)\n", "one too many beside `A = 0`");
  refused(two + "gauge B = x\ngauge A = 0\ngauge A = sin(t)\n", "one too many beside `A = 0`");
  CHECK(maup({"check", "-"}, two + "gauge A = 0\ngauge B = x\n").code == 0);
}

TEST_CASE("a relativistic particle starts along an axis, in its region of timelike velocities") {
  // p_x = γ v falls by 0.3 a second from γ_0/2; x = (√(1 + p_0²) − √(1 + p²))/0.3.
  const auto state = json_of(
      maup({"simulate", "-", "--json"}, relativistic + " - 0.3*x*T'\nstart T' = 1, x' = 0.5\ngauge T = t\nrun 1\n"));
  const double p0 = 0.5 / std::sqrt(0.75), p1 = p0 - 0.3;
  CHECK(std::abs(state["final"]["state"]["x'"].get<double>() - p1 / std::sqrt(1 + p1 * p1)) < 1e-14);
  CHECK(std::abs(state["final"]["state"]["x"].get<double>() - (std::sqrt(1 + p0 * p0) - std::sqrt(1 + p1 * p1)) / 0.3) <
        1e-14);
  // Without a gauge its momenta have values, and 2 freedoms are physical.
  const std::string open = relativistic + "\nstart T' = 1, x' = 0.5\nrun 1\n";
  const auto free = json_of(maup({"simulate", "-", "--json"}, open));
  CHECK(std::abs(free["final"]["state"]["p_x"].get<double>() - p0) < 1e-14);
  CHECK(contains(maup({"hamiltonian", "-"}, open).out, "4 physical dimensions, 2 freedoms"));
}

TEST_CASE("an energy function that vanishes at every state has no drift") {
  const Outcome run = maup({"simulate", "-"},
                           "dimensionless\ncoord x, y : number\nL = sqrt(2*(1 - x^2/2 - y^2/2)*(x'^2 + y'^2))\n"
                           "start x = 0.5, x' = 0.1, y' = 1\nrun 1\ngauge y = t\n");
  CHECK(contains(run.out, "h_E = 0 at every state"));
  CHECK_FALSE(contains(run.out, "drift"));
}

TEST_CASE("where h_E vanishes at every state no drift of it is told") {
  const std::string optics = "dimensionless\ncoord x, y : number\nL = sqrt(x'^2 + y'^2)/y\ngauge x = t\n";
  const Outcome circle = maup({"simulate", "-"}, optics + "start x = 0, y = 2, x' = 1\nrun 1.5\n");
  CHECK(circle.code == 0);
  CHECK(contains(circle.out, "y = 1.32287565553229"));  // y² = 4 − x²
  CHECK(contains(circle.out, "h_E = 0 at every state"));
  CHECK_FALSE(contains(circle.err, "W0734"));
}

TEST_CASE("one function is free where two were told, and a gauge for it excludes no motion") {
  const std::string chain =
      "dimensionless\ncoord x, y, z : number\nL = 1/2 ((y' - exp(x))^2 + (z' - y)^2)\nstart x = 1\n";
  const auto free = maup({"check", "-"}, chain);
  CHECK(contains(free.err, "one function of time is free"));
  CHECK(contains(free.err, "Every state of a motion has y' - exp(x) = 0 and y - z' = 0"));
  const auto chosen = maup({"simulate", "-", "--duration", "1"}, chain + "gauge z = sin(t) + t^2\n");
  CHECK_MESSAGE(chosen.code == 0, chosen.err);
  CHECK(contains(chosen.out, "y = 2.54030230586814"));  // cos 1 + 2 = 2.5403023058681398
}

TEST_CASE("a branch of the constraints is named on both sides, and what is told holds on it") {
  const std::string pushed = "dimensionless\ncoord x, y, z : number\nL = 1/2 (x' + y z)^2 + 1/2 y^2\nrun 1\n";
  const Outcome moving = maup({"simulate", "-", "--start", "x'=1", "--start", "z=0"}, pushed);
  CHECK(moving.code == 0);
  CHECK(contains(moving.err, "N0634"));
  CHECK_FALSE(contains(moving.out, "h_E = 0 at every state"));
  CHECK(contains(moving.out, "z = 0\n"));
  const Outcome phase = maup({"hamiltonian", "-", "--start", "x'=1"}, pushed);
  CHECK(contains(phase.out, "Branches"));
  CHECK_FALSE(contains(phase.out, "conjecture"));
}
