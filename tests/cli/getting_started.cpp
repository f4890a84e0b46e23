// docs/manual/getting_started.md, command by command, in a fresh folder where there is nothing but the program.
#include "program.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <sstream>

using namespace cli_test;
namespace fs = std::filesystem;

namespace {

struct Step {
  std::string command;
  std::vector<std::string> shown;  // the lines that the page shows under it
};

std::vector<Step> steps_of(const std::string& page) {
  std::vector<Step> steps;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0)
      inside = !inside && line == "```";
    else if (inside && line.rfind("$ ", 0) == 0)
      steps.push_back({line.substr(2), {}});
    else if (inside && !steps.empty() && !line.empty())
      steps.back().shown.push_back(line);
    if (line.rfind("```", 0) == 0 && !inside)
      steps.push_back({"true", {}});  // what a block without a command shows belongs to none
  }
  return steps;
}

/// Times of computation differ from run to run.
bool is_timing(const std::string& line) { return contains(line, " steps of order "); }

}  // namespace

TEST_CASE("getting started works with the program alone, and shows what it shows") {
  const Folder folder;
  const std::string bin = folder.path("bin"), work = folder.path("work");
  fs::create_directories(bin);
  fs::create_directories(work);
  fs::copy_file(MAUP_PROGRAM, bin + "/maup");
  int commands = 0, lines = 0;
  for (const Step& step : steps_of(read(std::string(PROJECT_DIR) + "/docs/manual/getting_started.md"))) {
    CAPTURE(step.command);
    const Outcome outcome = shell("cd " + work + " && PATH=" + bin + ":/usr/bin:/bin && " + step.command);
    const bool wrong = contains(step.command, "check wrong.lag");
    CHECK(outcome.code == (wrong ? 1 : 0));
    commands += step.command != "true";
    if (step.command == "true") continue;
    for (const std::string& line : step.shown) {
      if (is_timing(line)) continue;
      ++lines;
      CAPTURE(line);
      CHECK(contains(outcome.out + outcome.err, line));
    }
  }
  CHECK(commands >= 11);
  CHECK(lines >= 30);
  for (const char* written : {"pendulum.lag", "motion.csv", "motion.svg", "angle.svg", "pendulum.html", "pendulum.svg"})
    CHECK(fs::exists(work + "/" + written));
}
