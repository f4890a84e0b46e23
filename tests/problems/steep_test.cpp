// tests/problems/steep: each model is right at its tolerance, or refused where that is right (README.md there).
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "../cli/program.hpp"

using namespace cli_test;

namespace {

std::vector<std::filesystem::path> models() {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator(PROJECT_DIR "/tests/problems/steep"))
    if (entry.path().extension() == ".lag") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// What follows `# word: ` in the text of a model.
std::string comment(const std::string& text, const std::string& word) {
  std::smatch found;
  return std::regex_search(text, found, std::regex("\n# " + word + ": ([^\n]*)")) ? found[1].str() : std::string();
}

/// Empty where the outcome is right; otherwise what is wrong.
std::string trouble_of_refusal(const std::string& path) {
  const Outcome check = maup({"check", path}), run = maup({"simulate", path});
  if (check.code != 1) return "`check` accepts it";
  return run.code == 1 && contains(run.err, "error E04")
             ? ""
             : "`simulate` does not refuse it with an error E04…: exit " + std::to_string(run.code);
}

std::string trouble_of_condition(const std::string& path, const std::string& right, bool touched) {
  const Outcome run = maup({"simulate", path, "--json"});
  const nlohmann::json document = nlohmann::json::parse(run.out, nullptr, false);
  if (document.is_discarded() || !document.contains("ended"))
    return "no run: exit " + std::to_string(run.code) + " " + run.err;
  const std::string kind = document["ended"]["kind"];
  const double t = document["final"]["t"];
  const std::string found = kind + " at t = " + std::to_string(t);
  if (right == "not met") return kind == "until not reached" ? "" : found;
  const double expected = std::stod(right.substr(right.find('=') + 1));
  // A double root is known to the square root of a double's precision.
  const double tolerance = (touched ? 1e-7 : 1e-9) * std::max(1.0, std::abs(expected));
  return kind == "until reached" && std::abs(t - expected) <= tolerance ? "" : found;
}

std::string trouble_of_expectations(const std::string& path) {
  const Outcome run = maup({"test", path});
  return run.code == 0 ? "" : "exit " + std::to_string(run.code) + "\n" + run.out + run.err;
}

std::string trouble_of(const std::filesystem::path& path) {
  const std::string text = read(path);
  if (!comment(text, "must be refused").empty()) return trouble_of_refusal(path);
  if (const std::string right = comment(text, "right"); !right.empty())
    return trouble_of_condition(path, right, contains(text, "touched"));
  if (!contains(text, "\nexpect ")) return "the model does not say what is right";
  return trouble_of_expectations(path);
}

}  // namespace

TEST_CASE("steep models are right, or end with a reason where they have none") {
  const auto all = models();
  CHECK(all.size() >= 45);
  for (const auto& path : all) {
    const std::string name = path.stem();
    const std::string trouble = trouble_of(path);
    CHECK_MESSAGE(trouble.empty(), name << ": " << trouble);
  }
}
