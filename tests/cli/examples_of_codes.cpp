// The examples of the catalogue, as a reader would try them: the wrong text gives its code, the right one no error.
#include "json.hpp"
#include "program.hpp"

#include <doctest/doctest.h>

#include <regex>
#include <sstream>

namespace {
namespace examples_of_codes {

using cli_test::contains;
using cli_test::Folder;
using cli_test::Json;
using cli_test::Outcome;

/// The first line of a model says with which command it is tried, "# maup orbits --floquet"; without one it is `check`.
struct Example {
  explicit Example(const std::string& written) : text(written) {
    std::istringstream line(text.substr(0, text.find('\n')));
    std::string hash, program;
    named = line >> hash >> program && hash == "#" && program == "maup";
    if (named)
      for (std::string word; line >> word;) command.push_back(word);
    else
      command = {"check"};
  }
  /// A command line about files of the reader's own.
  bool is_command_line() const { return text.rfind("maup ", 0) == 0 || text.rfind("MAUPERTUIS_", 0) == 0; }
  Outcome run() const {
    const Folder folder;
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.begin() + 1, folder.write("example.lag", text));
    return cli_test::maup(arguments);
  }

  std::string text;
  bool named = false;
  std::vector<std::string> command;
};

std::string shown(const Example& example, const Outcome& outcome) {
  return example.text + "\n" + outcome.out + outcome.err + "\nexit code " + std::to_string(outcome.code);
}

/// A build without SUNDIALS or LAPACK has no stiff method, or no regulator (E1315), and other messages; a mesh that fits
/// into no memory (E0649) may fit into that of a large machine.
bool is_told_otherwise_here(const std::string& code) {
  if (code == "E0649") return true;
  static const std::string doctor = cli_test::maup({"doctor"}).out;
  if (contains(doctor, "stiff needs SUNDIALS") && code == "N0702") return true;
  return contains(doctor, "needs LAPACK") && code >= "E1310" && code <= "E1314";
}

void check_wrong(const std::string& code, const Example& example) {
  const Outcome outcome = example.run();
  CHECK_MESSAGE(contains(outcome.out + outcome.err, code), shown(example, outcome));
}

void check_right(const std::string& code, const Example& example) {
  const Outcome outcome = example.run();
  const std::string all = outcome.out + outcome.err;
  CHECK_MESSAGE(!contains(all, code), shown(example, outcome));
  if (!example.named) return;  // a few lines about the grammar or the names: no whole model
  CHECK_MESSAGE(outcome.code == 0, shown(example, outcome));
  CHECK_MESSAGE(!std::regex_search(all, std::regex("error E[0-9]{4}")), shown(example, outcome));
}

TEST_CASE("the examples of every code, by the command that they name") {
  const Json catalogue = cli_test::json_of(cli_test::maup({"explain", "--json"}));
  std::size_t tried = 0;
  for (const Json& entry : catalogue["codes"]) {
    const std::string code = entry["code"];
    CAPTURE(code);
    const Example wrong{entry["wrong"]}, right{entry["right"]};
    if (wrong.is_command_line() || wrong.text.empty() || is_told_otherwise_here(code)) continue;
    ++tried;
    check_wrong(code, wrong);
    if (!right.text.empty()) check_right(code, right);
  }
  CHECK(tried > 250);
}

}  // namespace examples_of_codes
}  // namespace
