// What other programs rely on.
#include "json.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace cli_test;

namespace {

Json document(const std::vector<std::string>& arguments, const std::string& input, int code = 0) {
  const Outcome outcome = maup(arguments, input);
  CHECK_MESSAGE(outcome.code == code, outcome.err, outcome.out);
  CHECK(outcome.err.empty());
  const Json json = json_of(outcome);
  REQUIRE(json.is_object());
  CHECK(json.at("schema") == 1);
  CHECK(json.at("command") == arguments.at(0));
  return json;
}

}  // namespace

TEST_CASE("check --json") {
  const Json json = document({"check", "-", "--json"}, pendulum);
  CHECK(json.at("coordinates") == Json::array({"θ"}));
  CHECK(json.at("freedoms") == 1);
  CHECK(json.at("instantaneous_freedoms") == 1);
  CHECK(json.at("constraints").empty());
  CHECK(json.at("diagnostics").empty());

  const Json wrong = document({"check", "-", "--json"}, std::string(pendulum) + "V = m g lenght\n", 1);
  REQUIRE(wrong.at("diagnostics").size() == 1);
  const Json& d = wrong.at("diagnostics").at(0);
  CHECK(d.at("severity") == "error");
  CHECK(d.at("line") == 8);
  CHECK(d.at("column") == 9);
  for (const char* key : {"code", "message", "help"}) CHECK(d.at(key).is_string());
}

TEST_CASE("derive --json") {
  const Json json = document({"derive", "-", "--json"}, pendulum);
  CHECK(json.at("coordinates") == Json::array({"θ"}));
  CHECK(json.at("equations").at(0).at("coordinate") == "θ");
  CHECK(json.at("equations").at(0).at("plain") == "m l^2 θ'' + m g l sin θ = 0");
  CHECK(contains(json.at("equations").at(0).at("latex"), "\\theta"));
  CHECK(json.at("mass_matrix") == Json::array({Json::array({"m l^2"})}));
  CHECK(json.at("momenta").at(0) == "m l^2 θ'");
  CHECK(json.at("momenta_latex").at(0) == "m\\, l^{2}\\, \\dot{\\theta}");
  CHECK(contains(json.at("energy_latex"), "\\frac{1}{2} m\\, l^{2}\\, \\dot{\\theta}^{2}"));
  CHECK(json.at("energy").is_string());
  CHECK(json.at("certificate").at("passed") == true);
  REQUIRE(json.at("certificate").at("checks").size() >= 4);
  for (const Json& check : json.at("certificate").at("checks")) {
    CHECK(check.at("points").get<int>() > 0);
    CHECK(check.at("error_bound").get<double>() <= 1);
  }
  const Json full = document({"derive", "-", "--json", "--certify", "full", "--steps"}, pendulum);
  CHECK(full.at("certificate").at("checks").size() > json.at("certificate").at("checks").size());
  CHECK(full.at("steps").size() > 8);
}

TEST_CASE("simulate --json agrees with the closed form") {
  // Harmonic oscillator, ω = 2 rad/s: x = cos 2t.
  const std::string model =
      "system o\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun 3 s\n";
  const Json json = document({"simulate", "-", "--json", "--at", "500ms,2 s"}, model);
  CHECK(json.at("final").at("t") == 3.0);
  CHECK(std::abs(json.at("final").at("state").at("x").get<double>() - std::cos(6.0)) < 1e-14);
  CHECK(std::abs(json.at("final").at("state").at("x'").get<double>() + 2 * std::sin(6.0)) < 2e-14);
  REQUIRE(json.at("at").size() == 2);
  CHECK(json.at("at").at(0).at("t") == 0.5);
  CHECK(std::abs(json.at("at").at(0).at("state").at("x").get<double>() - std::cos(1.0)) < 1e-15);
  CHECK(json.at("at").at(1).at("multipliers").is_object());
  const Json& statistics = json.at("statistics");
  CHECK(statistics.at("steps").get<int>() > 0);
  CHECK(statistics.at("order").get<int>() > 10);
  CHECK(statistics.at("backend") == "interpreter");
  CHECK(statistics.at("energy_drift").get<double>() < 1e-14);
  for (const char* key : {"seconds", "compile_seconds", "constraint_residual"}) CHECK(statistics.at(key).is_number());
  CHECK(json.at("events").is_array());
  CHECK(json.at("ended").at("reason") == "finished");

  const Json back = document({"simulate", "-", "--json", "--duration", "-3 s"}, model);
  CHECK(back.at("final").at("t") == -3.0);
  CHECK(std::abs(back.at("final").at("state").at("x").get<double>() - std::cos(6.0)) < 1e-14);
  const Json changed =
      document({"simulate", "-", "--json", "--set", "k=1 N/m", "--start", "x=2m", "--duration", "1"}, model);
  CHECK(std::abs(changed.at("final").at("state").at("x").get<double>() - 2 * std::cos(1.0)) < 1e-14);
  const Json until = document({"simulate", "-", "--json", "--until", "x = 0", "--within", "5 s"}, model);
  CHECK(std::abs(until.at("final").at("t").get<double>() - std::acos(-1.0) / 4) < 1e-14);
}

TEST_CASE("test --json") {
  const Json json =
      document({"test", "-", "--json"}, std::string(pendulum) + "expect freedoms = 1\nexpect freedoms = 2\n", 4);
  CHECK(json.at("passed") == 1);
  CHECK(json.at("failed") == 1);
  REQUIRE(json.at("expectations").size() == 2);
  CHECK(json.at("expectations").at(0).at("line") == 8);
  CHECK(json.at("expectations").at(0).at("passed") == true);
  CHECK(json.at("expectations").at(1).at("passed") == false);
  for (const char* key : {"text", "actual", "expected", "tolerance"})
    CHECK(json.at("expectations").at(1).contains(key));
}

TEST_CASE("every command speaks JSON, and a failure is a document too") {
  const Folder folder;
  CHECK(document({"fmt", "-", "--json"}, pendulum).at("files").at(0).at("text").is_string());
  CHECK(document({"explain", "--json"}, "").at("codes").size() > 60);
  CHECK(document({"explain", "E0801", "--json"}, "").at("code") == "E0801");
  CHECK(document({"doctor", "--json"}, "").at("version").is_string());
  CHECK(document({"plot", "-", "--json"}, pendulum).at("svg").is_string());
  CHECK(document({"new", "pendulum", "-o", folder.path("p.lag"), "--json"}, "").at("ok") == true);
  CHECK(document({"report", "-", "-o", folder.path("p.html"), "--json"}, pendulum).at("file") == folder.path("p.html"));
  CHECK(document({"export", "-", "--json"}, pendulum, 1).at("diagnostics").at(0).at("code") == "E0806");
  for (const char* command : {"check", "derive", "simulate", "plot", "report"}) {
    CAPTURE(command);
    CHECK(document({command, "/no/such/file.lag", "--json"}, "", 2).at("diagnostics").at(0).at("code") == "E0801");
  }
}

TEST_CASE("invariants --json: integrals with their proofs, what holds between them, the basis") {
  const Outcome outcome = maup({"invariants", PROJECT_DIR "/models/kepler.lag", "--json"});
  CHECK(outcome.code == 0);
  const Json document = json_of(outcome);
  CHECK(document["schema"] == 1);
  CHECK(document["command"] == "invariants");
  REQUIRE(document["integrals"].size() == 4);
  for (const Json& integral : document["integrals"]) {
    CHECK(integral["certificate"]["verdict"] == "zero");
    CHECK(integral["certificate"]["error_bound"].get<double>() < 1e-15);
    CHECK(integral["drift"].get<double>() < 1e-12);
  }
  CHECK(document["integrals"][0]["name"] == "energy");
  CHECK(document["integrals"][2]["kind"] == "hidden");
  CHECK(document["independent"] == 3);
  CHECK(document["relations"].size() == 1);
  CHECK(document["completely_integrable"] == true);
  CHECK(document["point_symmetries_bound"] == document["point_symmetries"]);
  CHECK(document["basis"].size() >= 2);
}
