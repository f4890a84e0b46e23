// Rates: derivations in them in every notation, and rates as names wherever a velocity is.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace cli_test;

namespace {

const std::string quaternion_top = R"(system top
param A = 1 kg m^2, B = 2 kg m^2, C = 2.5 kg m^2
body sat inertia diag(A, B, C) rotation quaternion
)";
const std::string with_rates = "rates ω1, ω2, ω3 = sat.ω\nstart ω2 = 1 rad/s, ω3 = 0.01 rad/s\nrun 20 s\n";
const std::string without_rates = "system p\nparam m = 1 kg, l = 1 m\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nrun 1 s\n";

}  // namespace

TEST_CASE("a body whose equations are shorter in its rates is shown so, in q'' on request") {
  const auto shown = json_of(maup({"derive", "-", "--json"}, quaternion_top));
  CHECK(shown["form"] == "rates");
  REQUIRE(shown["equations"].size() == 3);
  CHECK(shown["equations"][0]["coordinate"] == "sat.ω.x");
  CHECK(shown["equations"][0]["plain"] == "A sat.ω.x' - (B - C) sat.ω.y sat.ω.z = 0");
  CHECK(shown["equations"][0]["latex"] == "A\\, \\dot{\\omega}_1 - (B - C)\\, \\omega_2\\, \\omega_3 = 0");
  CHECK(shown["kinematics"].size() == 4);
  CHECK(shown["kinematics"][0]["plain"] == "sat.qw' = -1/2 (sat.qx sat.ω.x + sat.qy sat.ω.y + sat.qz sat.ω.z)");
  CHECK(shown["certificate"]["checks"].back()["name"] == "rates_form");
  CHECK(shown["certificate"]["checks"].back()["verdict"] == "zero");
  const auto standard = json_of(maup({"derive", "-", "--json", "--form", "standard"}, quaternion_top));
  CHECK(standard["form"] == "standard");
  CHECK(standard["equations"].size() == 4);
}

TEST_CASE("rates that the model names are names in its equations") {
  const Outcome plain = maup({"derive", "-", "--plain"}, quaternion_top + with_rates);
  CHECK(contains(plain.out, "B ω2' + (A - C) ω1 ω3 = 0\n"));
  const Outcome text = maup({"derive", "-"}, quaternion_top + with_rates);
  CHECK(contains(text.out, "  L = 1/2 A ω1^2 + 1/2 B ω2^2 + 1/2 C ω3^2\n"));
  CHECK(contains(text.out, "  ∂L/∂ω2 = B ω2\n"));
  CHECK(contains(text.out, "rates_form "));
}

TEST_CASE("every line in rates passes as an expectation of the model") {
  std::string model = quaternion_top + with_rates, line;
  std::istringstream lines(maup({"derive", "-", "--plain"}, model).out);
  int count = 0;
  while (std::getline(lines, line)) {
    model += "expect equation " + line + "\n";
    ++count;
  }
  CHECK(count == 8);
  CHECK(maup({"test", "-"}, model).code == 0);
}

TEST_CASE("the path to the equations in rates goes by L in rates") {
  const Outcome steps = maup({"derive", "-", "--form", "rates", "--steps"}, quaternion_top + with_rates);
  CHECK(contains(steps.out, "\nLagrangian in rates\n  L = 1/2 A ω1^2 + 1/2 B ω2^2 + 1/2 C ω3^2 "));
  CHECK(contains(steps.out, "\nEquation of ω1\n  ∂L/∂ω1 = A ω1 "));
  CHECK(!contains(steps.out, "Equation of sat.qw"));
}

TEST_CASE("where there are no rates the form in them is refused") {
  CHECK(contains(maup({"derive", "-", "--form", "rates"}, without_rates).err, "E0694"));
  const std::string wind =
      "system wind\nparam m = 1 kg, c = 1 m/s\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
      "constraint x'^2 + y'^2 = c^2\nrates v = z'\nstart x' = 1 m/s\n";
  CHECK(contains(maup({"derive", "-", "--form", "rates"}, wind).err, "E0695"));
  CHECK(json_of(maup({"derive", "-", "--json"}, wind))["form"] == "standard");
}

TEST_CASE("integrals are written in rates where these are shorter") {
  const Outcome found = maup({"invariants", "-"}, quaternion_top + with_rates);
  CHECK(contains(found.out, "1/2 A ω1^2 + 1/2 B ω2^2 + 1/2 C ω3^2\n     energy"));
  CHECK(!contains(found.out, "sat.qw'"));
}

TEST_CASE("rates are starts, columns, events and points of modes") {
  const Folder folder;
  const std::string csv = folder.path("rates.csv");
  const std::string model = quaternion_top + with_rates + "event turn when ω2 = 0 falling : record\n";
  const Outcome run = maup({"simulate", "-", "--start", "ω2=2rad/s", "--columns", "ω2,ω1", "-o", csv}, model);
  CHECK(run.code == 0);
  CHECK(contains(run.out, "turn event"));
  const std::string rows = shell("head -2 " + csv).out;
  CHECK(rows == "t [s],ω2 [rad/s],ω1 [rad/s]\r\n0,2,0\r\n");
  const std::string euler =
      "system top\nparam A = 1 kg m^2, B = 2 kg m^2, C = 3 kg m^2\ncoord φ, θ, ψ : angle\n"
      "body sat inertia diag(A, B, C) rotation euler zxz (φ, θ, ψ)\nrates ω1, ω2, ω3 = sat.ω\n";
  const Outcome modes = maup({"modes", "-", "--at", "θ=90deg, ω2=1rad/s"}, euler);
  CHECK(contains(modes.out, "growth"));
  CHECK(contains(modes.out, " 0.57735 "));  // √((B − A)(C − B)/(A C))
  CHECK(contains(maup({"modes", "-", "--at", "θ=0, ω2=1rad/s"}, euler).err, "E0223"));
}

TEST_CASE("linearizations and the ends of runs are told in the rates of the model") {
  // A sleigh at the speed v: w' = -m a v w/(J + m a²) = -2 w; v' = a w².
  const std::string sleigh =
      "dimensionless\ncoord x, y, θ : number\nparam a = 0.3, m = 2, J = 0.12\n"
      "T = 1/2 m ((x' - a θ' sin θ)^2 + (y' + a θ' cos θ)^2) + 1/2 J θ'^2\nconstraint x' sin θ = y' cos θ\n"
      "rates v = x' cos θ + y' sin θ, w = θ'\nstart v = 1, θ = 0.4\nrun 1\n";
  // What is not given of the point is 0, and v is 1 there: the start, at θ = 0.4, is no part of it.
  const auto there = json_of(maup({"modes", "-", "--at", "v=1", "--json"}, sleigh))["points"][0]["state"];
  CHECK(there["x'"] == 1);
  CHECK(std::abs(there["y'"].get<double>()) < 1e-15);
  CHECK(maup({"test", "-"}, sleigh + "expect A in (v, w) at v = 1, θ = 0.4 : ((0, 0), (0, -2)) ± 1e-9\n"
                                     "expect A in (θ, w) at v = 1, θ = 0.4 : ((0, 1), (0, -2)) ± 1e-9\n")
            .code == 0);
  CHECK(maup({"test", "-"}, sleigh + "expect A in (v, w) at v = 1, θ = 0.4 : ((0, 0), (0, -1)) ± 1e-9\n").code == 4);
  CHECK(contains(maup({"test", "-"}, sleigh + "expect A in (v, θ') at v = 1, θ = 0.4 : ((0, 0), (0, -2)) ± 1e-9\n").out,
                 "no state where the rates are"));
  const Outcome modes = maup({"modes", "-", "--at", "v=1, θ=0.4"}, sleigh);
  CHECK(contains(modes.out, "z' = A z,  z = (x, y, θ, v, w)\n"));
  const auto linear =
      json_of(maup({"modes", "-", "--at", "v=1, θ=0.4", "--json"}, sleigh))["points"][0]["linearization"];
  CHECK(linear["in_rates"]["states"].back() == "w");
  CHECK(linear["measured"].is_null());
  const auto final = json_of(maup({"simulate", "-", "--json"}, sleigh + "start w = 0.5\n"))["final"];
  // v² + (J + m a²)/m w² is the energy, which stays.
  const double v = final["state"]["v"].get<double>(), w = final["state"]["w"].get<double>();
  CHECK(std::abs(v * v + 0.15 * w * w - (1 + 0.15 * 0.25)) < 1e-14);
  CHECK(w == final["state"]["θ'"].get<double>());
  CHECK(final["errors"]["v"].get<double>() < 1e-12);
}

TEST_CASE("a blade and a disk that go round a circle are steady motions in rates") {
  const std::string blade =
      "dimensionless\ncoord x, y : number, θ : angle\nparam m = 1, J = 1/2\nT = 1/2 m (x'^2 + y'^2) + 1/2 J θ'^2\n"
      "constraint x' sin θ - y' cos θ = 0 name blade\nrates v = x' cos θ + y' sin θ, w = θ'\nstart v = 1, w = 2\n";
  CHECK(maup({"test", "-"}, blade + "expect A in (v, w) at v = 1, w = 2 : ((0, 0), (0, 0)) ± 1e-12\n").code == 0);
  // The force across is m v w.
  CHECK(contains(maup({"modes", "-", "--at", "v=1, w=2"}, blade).out, "blade -2"));
  // 5 r ω1' + 6 r ω2 ω3 - r ω2² cot θ + 4 g cos θ = 0, ω2' = (2 ω3 - ω2 cot θ) ω1, 3 ω3' = 2 ω1 ω2 (Routh).
  const std::string disk = std::string(PROJECT_DIR) + "/models/leaning_disk.lag";
  const double theta = 70 * std::acos(-1.0) / 180, r = 0.3, g = 9.81, cot = 1 / std::tan(theta);
  const double turn = 1.5, w2 = turn * std::sin(theta);
  const double w3 = (w2 * w2 * r * cot - 4 * g * std::cos(theta)) / (6 * r * w2);
  char line[700];
  std::snprintf(line, sizeof line,
                "\nexpect A in (ω1, ω2, ω3) at θ = 70 deg, ω1 = 0 rad/s, ω2 = %.17g rad/s, ω3 = %.17g rad/s :\n"
                "    ((0, %.17g, %.17g), (%.17g, 0, 0), (%.17g, 0, 0)) ± 1e-9\n",
                w2, w3, (2 * w2 * cot - 6 * w3) / 5, -6 * w2 / 5, 2 * w3 - w2 * cot, 2 * w2 / 3);
  const Outcome circle = maup({"test", "-"}, read(disk) + line);
  CHECK_MESSAGE(circle.code == 0, circle.out, circle.err);
  // The wobble, of the rates alone and of the lean: ω² = 47.9029.
  const double square = (6 * w3 * (2 * w3 - w2 * cot) + 4 * w2 * w2 - 2 * w2 * cot * (2 * w3 - w2 * cot) +
                         w2 * w2 / std::pow(std::sin(theta), 2) - 4 * g * std::sin(theta) / r) /
                        5;
  char wobble[40];
  std::snprintf(wobble, sizeof wobble, "%.8f", std::sqrt(square));
  const Outcome modes = maup({"modes", disk, "--at", "θ=70deg, φ'=1.5 rad/s, ψ'=-5.7172259171592269 rad/s"});
  CHECK(contains(modes.out, std::string(wobble)));
  CHECK(contains(modes.out, "z' = A z,  z = (x, y, φ, θ, ψ, ω1, ω2, ω3)"));
}
