// A report comes within its budget, with the sections that fit.
#include "json.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace cli_test;

namespace report_budget {
namespace {

std::string chain(int links) {
  std::string text = "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", last;
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i);
    text += "coord a" + n + " : angle\npoint P" + n + " mass m at " + last + "l (sin a" + n + ", -cos a" + n + ")\n";
    last = "P" + n + " + ";
  }
  return text + "gravity (0, -g)\nstart a1 = 60 deg\nrun 10 s\n";
}

bool has(const nlohmann::json& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

TEST_CASE("an arm of seven joints: what does not come in time is left out, with a word on the page and beside it") {
  const Folder folder;
  const std::string model = PROJECT_DIR "/tests/problems/arm_seven_joints.lag", page = folder.path("arm.html");
  const Outcome outcome = maup({"report", model, "-o", page, "--budget", "1s", "--json"});
  CHECK(outcome.code == 0);
  CHECK(outcome.seconds < 30);  // 2 on a machine with nothing else to do
  const auto document = nlohmann::json::parse(outcome.out);
  REQUIRE(document["left_out"].size() > 0);
  const std::string html = read(page);
  for (const std::string name : document["left_out"]) {
    CAPTURE(name);
    CHECK(contains(html, "the section <code>" + name));
    CHECK_FALSE(has(document["sections"], name));
  }
  CHECK(contains(outcome.out, "W0813"));
  CHECK(contains(html, "</html>"));
}

TEST_CASE("a small model has all of its sections, and those that are chosen alone") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", std::string(pendulum) + "expect freedoms = 1\n"),
                    page = folder.path("page.html");
  const Outcome whole = maup({"report", model, "-o", page, "--budget", "none", "--json"});
  REQUIRE(whole.code == 0);
  const auto document = nlohmann::json::parse(whole.out);
  CHECK(document["left_out"].empty());
  const std::string whole_page = read(page);
  for (const char* name : {"equations", "motion", "modes", "conserved", "phase-space", "derivation", "expectations"}) {
    CAPTURE(name);
    CHECK(has(document["sections"], name));
    CHECK(contains(whole_page, std::string("<section id=\"") + name + "\""));
    const Outcome alone = maup({"report", model, "-o", page, "--sections", name, "--json"});
    CHECK(alone.code == 0);
    for (const char* other :
         {"equations", "motion", "modes", "conserved", "phase-space", "derivation", "expectations"}) {
      CAPTURE(other);
      CHECK(contains(read(page), std::string("<section id=\"") + other + "\"") == (std::string(name) == other));
    }
    CHECK(contains(read(page), "<section id=\"model\""));
    CHECK(contains(read(page), "<section id=\"certificate\""));
  }
  CHECK(maup({"report", model, "-o", page, "--sections", "equations,motion"}).code == 0);
}

TEST_CASE("unknown sections and budgets") {
  const Outcome outcome = maup({"report", "-", "-o", "-", "--sections", "equations,modse"}, pendulum);
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "has no section `modse`"));
  CHECK(contains(outcome.err, "Did you mean modes?"));
  for (const char* budget : {"0s", "-3s", "soon", "3kg", ""}) {
    CAPTURE(budget);
    CHECK(maup({"report", "-", "-o", "-", std::string("--budget=") + budget}, pendulum).code == 2);
  }
}

TEST_CASE("a budget too short for a certificate leaves no page; a run is shown as far as it came") {
  const Folder folder;
  const std::string model = folder.write("chain.lag", chain(20)), page = folder.path("chain.html");
  const Outcome none = maup({"report", model, "-o", page, "--budget", "1ms"});
  CHECK(none.code == 3);
  CHECK(contains(none.err, "E0814"));
  CHECK(folder.names() == std::vector<std::string>{"chain.lag"});
  const std::string one = folder.write("pendulum.lag", pendulum);
  const Outcome cut = maup({"report", one, "-o", page, "--sections", "motion", "--duration", "100000000s", "--every",
                            "1000s", "--budget", "6s"});
  CHECK(cut.code == 0);
  CHECK(contains(cut.err, "The run ended early: its share of the budget of 6s was used up"));
  CHECK(contains(read(page), "was used up"));
}

}  // namespace report_budget
