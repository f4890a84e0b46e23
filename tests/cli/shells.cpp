// What shells and `man` read is made from the tables of options: it names what --help names, and works in the shells
// themselves.
#include "program.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

using namespace cli_test;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// Of `maup --help`, without those of later versions.
std::vector<std::string> commands() {
  std::vector<std::string> out;
  const std::regex row("^  ([a-z]+) +[^ ].*");
  bool inside = false;
  for (const std::string& line : lines_of(maup({"--help"}).out)) {
    std::smatch match;
    if (line.rfind("  ", 0) != 0)
      inside = line == "Subcommands:" || line == "Commands:";
    else if (inside && std::regex_match(line, match, row))
      out.push_back(match[1]);
  }
  return out;
}

/// Of `maup COMMAND --help`.
std::set<std::string> long_options(const std::string& command) {
  std::set<std::string> out;
  const std::regex name("(--[a-zA-Z][a-zA-Z-]*)");
  for (const std::string& line : lines_of(maup({command, "--help"}).out)) {
    if (line.rfind("  -", 0) != 0) continue;
    const std::string head = line.substr(0, line.find("  ", 3));  // the names alone, without what is said of them
    for (std::sregex_iterator it(head.begin(), head.end(), name), end; it != end; ++it) out.insert((*it)[1]);
  }
  return out;
}

/// From `begin` to the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto from = text.find(begin);
  if (from == std::string::npos) return {};
  return text.substr(from, text.find(end, from + begin.size()) - from);
}

std::string lines_with(const std::string& text, const std::string& part) {
  std::string out;
  for (const std::string& line : lines_of(text))
    if (contains(line, part)) out += line + "\n";
  return out;
}

bool has_program(const std::string& name) {
  if (shell("command -v " + name + " >/dev/null").code == 0) return true;
  MESSAGE("skipped: " << name << " is not installed (scripts/packages test)");
  return false;
}

/// What Tab offers in bash after these words.
std::set<std::string> offered(const std::string& folder, const std::vector<std::string>& words) {
  const Folder own;
  std::string script = "cd '" + folder + "'\nsource <(" MAUP_PROGRAM " completions bash)\nCOMP_WORDS=(maup";
  for (const std::string& word : words) script += " '" + word + "'";
  script += ")\nCOMP_CWORD=" + std::to_string(words.size()) + "\n_maup\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  const Outcome outcome = shell("bash " + own.write("typed.bash", script));
  CHECK_MESSAGE(outcome.err.empty(), outcome.err);
  std::set<std::string> out;
  for (const std::string& word : lines_of(outcome.out))
    if (!word.empty()) out.insert(word);
  return out;
}

using Set = std::set<std::string>;

}  // namespace

TEST_CASE("completions and the manual page name every command and every option of --help") {
  const std::string zsh = maup({"completions", "zsh"}).out, fish = maup({"completions", "fish"}).out,
                    page = maup({"manual"}).out;
  const auto all = commands();
  REQUIRE(all.size() >= 18);
  const Folder folder;
  for (const std::string& command : all) {
    CAPTURE(command);
    CHECK(contains(zsh, "\n        " + command + ")\n"));
    CHECK(contains(fish, "-a " + command + " -d"));
    CHECK(contains(page, "\n.SS " + command + "\n"));
    const Set options = long_options(command), in_bash = offered(folder.path("."), {command, "--"});
    CHECK(options.size() >= 2);
    CHECK(in_bash == options);
    const std::string of_zsh = between(zsh, "\n        " + command + ")\n", ";;");
    const std::string of_fish = lines_with(fish, "'__fish_seen_subcommand_from " + command + "'");
    const std::string of_page = between(page, "\n.SS " + command + "\n", "\n.S");
    for (const std::string& option : options) {
      CAPTURE(option);
      CHECK(contains(of_zsh, option));
      CHECK(contains(of_fish, " -l " + option.substr(2) + " "));
      if (option != "--help") CHECK(contains(of_page, std::regex_replace(option, std::regex("-"), "\\-")));
    }
  }
}

TEST_CASE("bash: commands, options, words of an option, files of models") {
  const Folder folder;
  folder.write("arm.lag", "");
  folder.write("arm two.lag", "");
  folder.write("notes.txt", "");
  const std::string here = folder.path(".");
  CHECK(offered(here, {"si"}) == Set{"simulate"});
  CHECK(offered(here, {"--v"}) == Set{"--version"});
  CHECK(offered(here, {"simulate", "--method", ""}) == Set{"auto", "taylor", "variational", "stiff"});
  CHECK(offered(here, {"simulate", "--method", "=", "ta"}) == Set{"taylor"});
  CHECK(offered(here, {"simulate", "--method", "="}) == Set{"auto", "taylor", "variational", "stiff"});
  CHECK(offered(here, {"check", ""}) == Set{"arm.lag", "arm two.lag"});
  CHECK(offered(here, {"compare", "arm.lag", "ar"}) == Set{"arm.lag", "arm two.lag"});
  CHECK(offered(here, {"simulate", "arm.lag", "-o", ""}) == Set{"arm.lag", "arm two.lag", "notes.txt"});
  CHECK(offered(here, {"simulate", "arm.lag", "--at", ""}).empty());
  CHECK(offered(here, {"explain", "E080"}).count("E0801"));
  CHECK(offered(here, {"new", "pen"}) == Set{"pendulum"});
  CHECK(offered(here, {"completions", ""}) == Set{"bash", "zsh", "fish"});
}

TEST_CASE("zsh and fish read their completions, and fish offers what bash offers") {
  const Folder folder;
  folder.write("arm.lag", "");
  const std::string prefix = "cd " + folder.path(".") + " && ";
  if (has_program("zsh")) {
    CHECK(shell(prefix + "$MAUP completions zsh > _maup && zsh -n _maup").code == 0);
  }
  if (has_program("fish")) {
    CHECK(shell(prefix + "$MAUP completions fish > maup.fish && fish --no-execute maup.fish").code == 0);
    const auto fish = [&](const std::string& line) {
      return shell(prefix + "fish -c 'source maup.fish; complete -C \"" + line + "\"' | cut -f1 | sort | tr '\\n' ' '")
          .out;
    };
    CHECK(fish("maup si") == "simulate ");
    CHECK(fish("maup simulate --method ") == "auto stiff taylor variational ");
    CHECK(fish("maup check ar") == "arm.lag ");
    CHECK(fish("maup explain E0801") == "E0801 ");
  }
}

TEST_CASE(
    "the manual page: no mistake of its markup, the exit codes of the manual, every variable of the environment that "
    "is read") {
  const Folder folder;
  const std::string page = maup({"manual"}).out;
  const std::string path = folder.write("maup.1", page);
  if (has_program("mandoc")) {
    const Outcome lint = shell("mandoc -T lint -W warning " + path + " | grep -v 'missing date'");
    CHECK_MESSAGE(lint.out.empty(), lint.out);
    const Outcome shown = shell("mandoc -T utf8 " + path + " | col -b");
    for (const char* part : {"--duration", "θ'=1 rad/s", "maup new pendulum", "EXIT STATUS", "NO_COLOR"})
      CHECK_MESSAGE(contains(shown.out, part), part);
  }
  // | 3 | the run failed: … |
  const std::string manual = read(std::string(PROJECT_DIR) + "/docs/manual/command_line.md");
  const std::regex row("\n\\| ([0-9]+) \\| ([^|]*) \\|(?=\n)");
  std::size_t rows = 0;
  for (std::sregex_iterator it(manual.begin(), manual.end(), row), end; it != end; ++it, ++rows) {
    const std::string text = std::regex_replace((*it)[2].str(), std::regex("-"), "\\-");
    CHECK_MESSAGE(contains(page, ".TP\n\\fB" + (*it)[1].str() + "\\fR\n" + text + ".\n"), text);
  }
  CHECK(rows == 7);
  const Outcome variables =
      shell("cd " PROJECT_DIR " && grep -rhoE 'getenv\\(\"[A-Z_]+' src apps include | sed 's/.*\"//' | sort -u");
  CHECK(lines_of(variables.out).size() >= 5);
  for (const std::string& name : lines_of(variables.out)) CHECK_MESSAGE(contains(page, "\n.B " + name + "\n"), name);
}

TEST_CASE("completions and the manual as JSON; a shell that nobody knows") {
  CHECK(contains(maup({"completions", "bash", "--json"}).out, "\"text\": \"# Completion of maup for bash"));
  CHECK(contains(maup({"manual", "--json"}).out, "\"command\": \"manual\""));
  CHECK(maup({"completions", "tcsh"}).code == 2);
}

TEST_CASE("file managers know models: the type, what opens them, icons") {
  const Folder folder;
  const std::string top = PROJECT_DIR, packaging = std::string(BUILD_DIR) + "/packaging/";
  if (has_program("desktop-file-validate")) {
    const Outcome outcome = shell("desktop-file-validate " + packaging + "maupertuis.desktop");
    CHECK_MESSAGE((outcome.code == 0 && outcome.out.empty()), outcome.out);
  }
  if (has_program("update-mime-database")) {
    CHECK(shell("mkdir -p " + folder.path("mime/packages") + " && cp " + top + "/packaging/maupertuis.xml " +
                folder.path("mime/packages") + " && update-mime-database " + folder.path("mime"))
              .code == 0);
    CHECK(contains(read(folder.path("mime/globs2")), "text/x-maupertuis:*.lag"));
  }
  for (const char* icon : {"maupertuis", "text-x-maupertuis"})
    CHECK(shell("xmllint --noout " + top + "/packaging/" + icon + ".svg").code == 0);
  CHECK(shell("sh -n " + packaging + "show_model").code == 0);
}
