// The examples of the catalogue, as a reader would try them: the wrong text gives its code, the right one no error.
#include "json.hpp"
#include "program.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace {
namespace examples_of_codes {

using cli_test::contains;
using cli_test::Folder;
using cli_test::Json;
using cli_test::Outcome;

/// What the command lines of the examples name: they are tried in a folder that holds it.
const std::map<std::string, std::string>& files() {
  const std::string pendulum = cli_test::pendulum;
  const auto with = [&](const char* what, const char* other) {
    return std::regex_replace(pendulum, std::regex(what), other);
  };
  static const std::map<std::string, std::string> all = {
      {"pendulum.lag", pendulum},
      {"angle.lag", pendulum},
      {"longer.lag", with("l = 1 m", "l = 2 m")},
      {"renamed.lag", with("\\bl\\b", "r")},
      {"cartesian.lag",
       "system cartesian\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\n"
       "point bob mass m at (x, y)\nconstraint x^2 + y^2 = l^2\ngravity (0, -g)\nstart x = 0.6 m, y = -0.8 m\n"},
      {"latin1.lag", "coord x : length\nparam m = 1 kg  # la masse du mod\xe8le\nT = 1/2 m x'^2\n"},
      {"picture.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)},
      {"models/pendulum.lag", pendulum}};
  return all;
}

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
  bool is_command_line() const { return std::regex_search(text, std::regex("^(maup|iconv|MAUPERTUIS_\\w+=\\S+) ")); }
  /// Every model that it names, but for one that is not there on purpose.
  bool names_known_files() const {
    const std::regex model("[\\w/*]+\\.lag");
    for (std::sregex_iterator at(text.begin(), text.end(), model), end; at != end; ++at)
      if (std::set<std::string>{"penduluum.lag", "models/*.lag", "second.lag", "utf8.lag"}.count(at->str()) == 0 &&
          files().count(at->str()) == 0)
        return false;
    return !cli_test::contains(text, "studio") && !cli_test::contains(text, "doctor");
  }
  Outcome run() const {
    const Folder folder;
    std::filesystem::create_directory(folder.path("models"));
    for (const auto& [name, content] : files()) folder.write(name, content);
    const std::string there = "cd '" + folder.path("") + "' && maup() { \"$MAUP\" \"$@\"; } && ";
    if (is_command_line()) return cli_test::shell(there + text);
    folder.write("example.lag", text);
    std::string line = "maup " + command.front() + " example.lag";
    for (std::size_t i = 1; i < command.size(); ++i) line += " '" + command[i] + "'";
    return cli_test::shell(there + line);
  }

  std::string text;
  bool named = false;
  std::vector<std::string> command;
};

std::string shown(const Example& example, const Outcome& outcome) {
  return example.text + "\n" + outcome.out + outcome.err + "\nexit code " + std::to_string(outcome.code);
}

/// A build without LAPACK has no regulator (E1315), and other messages; a mesh that fits into no memory (E0649) may fit
/// into that of a large machine.
bool is_told_otherwise_here(const std::string& code) {
  if (code == "E0649") return true;
  static const std::string doctor = cli_test::maup({"doctor"}).out;
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
  if (!example.named && !example.is_command_line())
    return;  // a few lines about the grammar or the names: no whole model
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
    if (wrong.text.empty() || is_told_otherwise_here(code)) continue;
    if (wrong.is_command_line() && !(wrong.names_known_files() && right.names_known_files())) continue;
    ++tried;
    check_wrong(code, wrong);
    if (!right.text.empty()) check_right(code, right);
  }
  CHECK(tried > 280);
}

}  // namespace examples_of_codes
}  // namespace
