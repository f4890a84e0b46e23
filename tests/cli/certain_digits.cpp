// Numbers with what is known of them, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace certain_digits_test {
namespace {

const std::string oscillator =
    "system o\nparam m = 0.3 kg, k = 1.1 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x^2 + "
    "y^2)\nstart x = 0.1 m\nrun 7 s\n";
const std::string chaotic =
    "system d\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord a, b : angle\npoint A mass m at l (sin a, -cos a)\n"
    "point B mass m at A + l (sin b, -cos b)\ngravity (0, -g)\nstart a = 120 deg, b = -10 deg\n";

}  // namespace

TEST_CASE("simulate prints each number with its certain digits; equal runs print equal digits") {
  const Folder folder;
  const std::string model = folder.write("o.lag", oscillator);
  const Outcome text = maup({"simulate", model, "--at", "0s"});
  CHECK(text.code == 0);
  CHECK(contains(text.out, "t = 0 s\n  x = 0.1 m\n  x' = 0 m/s\n  y = 0 m\n"));  // given: exact
  CHECK(contains(maup({"simulate", model, "--at", "0.3s"}).out, "t = 0.3 s\n"));
  const std::string last = text.out.substr(text.out.find("t = 7 s"));
  CHECK(contains(last, "  x = 0.0669"));
  CHECK(last[last.find(')') - 2] == '(');
  CHECK(contains(last, "  y = 0 m\n  y' = 0 m/s\n"));  // zero by symmetry
  const auto states = [](const std::string& out) { return out.substr(0, out.find(" steps of order")); };
  CHECK(states(maup({"simulate", model, "--at", "0s"}).out) == states(text.out));
  const Outcome plain = maup({"simulate", model, "--no-errors"});
  CHECK_FALSE(contains(plain.out.substr(0, plain.out.find(" steps")), "("));
  CHECK(contains(plain.out, "x = 0.0669"));
  CHECK_FALSE(contains(plain.out, "companions"));
}

TEST_CASE("simulate --json and -o --errors carry the errors") {
  const Folder folder;
  const std::string model = folder.write("o.lag", oscillator), csv = folder.path("o.csv");
  const Json json = json_of(maup({"simulate", model, "--json", "--errors", "-o", csv}));
  const Json& errors = json.at("final").at("errors");
  const double x = errors.at("x");
  const double off = json.at("final").at("state").at("x").get<double>() -
                     static_cast<double>(0.1L * std::cos(7 * std::sqrt(1.1L / 0.3L)));
  CHECK(std::abs(off) <= x + 1e-17);
  CHECK(x < 1e-14);
  CHECK(errors.at("y") == 0);
  CHECK_FALSE(errors.contains("t"));
  CHECK(json.at("uncertain").is_null());
  CHECK(json.at("statistics").at("companions") == 7);
  const std::string rows = read(csv);
  CHECK(rows.rfind("t [s],x [m],y [m],x' [m/s],y' [m/s],energy [J],error(x) [m],error(y) [m],error(x') [m/s],error(y') "
                   "[m/s],error(energy) [J]\r\n"
                   "0,0.10000000000000001,0,0,0,",
                   0) == 0);
  CHECK_FALSE(json_of(maup({"simulate", model, "--json", "--no-errors"})).at("final").contains("errors"));
  CHECK(maup({"simulate", model, "--errors"}).code == 2);
  CHECK(maup({"simulate", model, "--errors", "--no-errors", "-o", csv}).code == 2);
  CHECK(maup({"simulate", model, "--no-errors", "--precision", "quad"}).code == 2);
}

TEST_CASE("a chaotic run says from when on nothing is certain, and no digit is printed then") {
  const Folder folder;
  const std::string model = folder.write("d.lag", chaotic + "run 60 s\n");
  const Outcome text = maup({"simulate", model});
  CHECK(text.code == 0);
  CHECK(contains(text.out, "  a' = ?  (no digit is certain)\n"));
  CHECK(contains(text.out, " on nothing is certain of this motion.\n"));
  const Json json = json_of(maup({"simulate", model, "--json"}));
  CHECK(json.at("final").at("errors").at("a'").is_null());
  CHECK(json.at("uncertain").at("everything") == true);
  const double from = json.at("uncertain").at("from");
  CHECK(from > 25);
  CHECK(from < 60);
}

TEST_CASE("run until: the located time has an error") {
  const std::string fall =
      "system f\nparam m = 1 kg, g = 9.81 m/s^2\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\nstart y = 100 m\nrun "
      "until y = 0 within 60 s\n";
  const Outcome text = maup({"simulate", "-"}, fall);
  CHECK(contains(text.out, "t = 4.5152364098573"));
  CHECK(contains(text.out, ") s\n"));
  const Json json = json_of(maup({"simulate", "-", "--json"}, fall));
  CHECK(json.at("final").at("errors").at("t").get<double>() > 0);
  CHECK(json.at("final").at("errors").at("t").get<double>() < 1e-13);
}

TEST_CASE("test says when an expectation asks for more digits than are known") {
  const Folder folder;
  const std::string known =
      folder.write("known.lag", chaotic + "run 20 s\nexpect b at 20 s = -5.0034073 rad ± 1e-6 rad\n");
  const Outcome clean = maup({"test", known});
  CHECK(clean.code == 0);
  CHECK_FALSE(contains(clean.out, "digits"));
  // The value of this very run, at a time at which some six digits are known, with a tolerance a thousand times below
  // that.
  const Json run = json_of(maup({"simulate", "-", "--json"}, chaotic + "run 20 s\n"));
  const double b = run.at("final").at("state").at("b"), error = run.at("final").at("errors").at("b");
  const auto asks = [&](double value, double tolerance) {
    return maup({"test", "-"}, chaotic + "run 20 s\nexpect b at 20 s = " + std::to_string(value) + " rad ± " +
                                   Json(tolerance).dump() + " rad\n");
  };
  const double rounded = std::stod(std::to_string(b));
  const double off = std::abs(rounded - b);
  const Outcome close = asks(rounded, 1.001 * off);
  if (error > 1.001 * off) CHECK(contains(close.out, "digits than"));
  const Outcome lost = maup({"test", "-"}, chaotic + "run 60 s\nexpect b' at 60 s = 0 rad/s ± 1000 rad/s\n");
  CHECK(lost.code == 4);
  CHECK(contains(lost.out, "no digit is certain"));
  CHECK(maup({"test", "--no-errors", "-"}, chaotic + "run 60 s\nexpect b' at 60 s = 0 rad/s ± 1000 rad/s\n").code == 0);
}

TEST_CASE("plots shade what is not certain") {
  const Folder folder;
  const std::string model = folder.write("d.lag", chaotic + "run 60 s\n");
  const Outcome shaded = maup({"plot", model, "--y", "a'"}), plain = maup({"plot", model, "--y", "a'", "--no-errors"});
  CHECK(contains(shaded.out, "<path class=\"band s1\""));
  CHECK_FALSE(contains(plain.out, "<path class=\"band"));
  CHECK(contains(maup({"plot", model, "--x", "a", "--y", "a'"}).out, "class=\"curve lost"));
}

}  // namespace certain_digits_test
