// Every code block of the documents says what it is, and is carried out or read accordingly: commands are run and their
// output is compared, models are checked and tested, C++ is compiled, options are looked up, other languages are read
// by their own readers. Formulas are set by site/source/formula.mjs, which refuses what it does not know (tests/site).
#include "blocks.hpp"
#include "program.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>

using namespace cli_test;
using namespace documents_test;
namespace fs = std::filesystem;

namespace {

const std::string root = PROJECT_DIR;

std::vector<Block> all_blocks() {
  std::vector<Block> all;
  for (const std::string& file : documents())
    for (Block& block : blocks_of(file, read(root + "/" + file))) all.push_back(std::move(block));
  return all;
}

bool begins_with(const std::string& text, const std::string& part) { return text.rfind(part, 0) == 0; }

// ------------------------------------------------------------------------------------------- commands and models

/// Where the commands of a document are run: a folder with the program in PATH and, but for "Getting started", which
/// begins with nothing else, the models of the gallery.
class Workplace {
 public:
  explicit Workplace(const std::string& file) {
    fs::create_directories(folder_.path("build/bin"));
    fs::create_directories(path());
    fs::copy_file(MAUP_PROGRAM, folder_.path("build/bin/maup"));
    if (contains(file, "getting_started")) return;
    fs::copy(root + "/models", path() + "/models", fs::copy_options::recursive);
    for (const auto& entry : fs::directory_iterator(root + "/models"))
      if (entry.path().extension() == ".lag") fs::copy(entry.path(), path() / entry.path().filename());
    fs::create_directory_symlink(folder_.path("build"), path() / fs::path("build"));
  }
  fs::path place(const std::string& name) const { return path() / fs::path(name); }
  std::string path() const { return folder_.path("work"); }

  Outcome run(const std::string& command) const {
    return shell("cd '" + path() + "' && export PATH='" + folder_.path("build/bin") + "':/usr/bin:/bin HOME='" +
                 path() + "' && " + command);
  }

 private:
  Folder folder_;
};

/// Times of computation differ from run to run.
bool is_timing(const std::string& line) { return contains(line, " steps of order "); }

void run_console(const Workplace& workplace, const Block& block) {
  for (Command& command : commands_of(block)) {
    CAPTURE(command.line);
    const Outcome outcome = workplace.run(command.line);
    const std::string came = outcome.out + outcome.err;
    CAPTURE(came);
    const bool refused = !command.shown.empty() && begins_with(command.shown.front(), "-- error");
    CHECK(outcome.code == (refused ? 1 : 0));
    for (std::string& line : command.shown)
      if (is_timing(line)) line = "…";
    std::string missing;
    CHECK_MESSAGE(shows(command.shown, came, missing), missing);
  }
}

/// A line with a remark behind it is one command.
void run_shell(const Workplace& workplace, const Block& block) {
  for (const std::string& line : block.text) {
    CAPTURE(line);
    const Outcome outcome = workplace.run(line);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
  }
}

/// What needs root, the network or much time is not run; but the targets, scripts and files that it names exist.
void read_shell(const Block& block) {
  const std::string makefile = "\n" + read(root + "/Makefile");
  CHECK(shell("bash -n <<'END'\n" + block.joined() + "END").code == 0);
  for (const std::string& line : block.text) {
    CAPTURE(line);
    std::istringstream words(line.substr(0, line.find(" #")));
    std::string program, word;
    words >> program;
    if (begins_with(program, "scripts/")) CHECK(fs::exists(root + "/" + program));
    if (program == "make")
      while (words >> word)
        if (!contains(word, "=")) CHECK_MESSAGE(contains(makefile, "\n" + word + ":"), word);
    CHECK((begins_with(program, "scripts/") ||
           std::set<std::string>{"make", "apt", "export", "mkdir", "code", "docker"}.count(program)));
  }
}

std::string name_of_system(const Block& block) {
  std::smatch match;
  const std::string text = block.joined();
  return std::regex_search(text, match, std::regex("(?:^|\n)system (\\w+)")) ? match[1].str() : "nameless";
}

/// A whole model: it has no mistakes and passes its tests. It is written under the name of its system, so that commands
/// below it find it. Where that system is there, from the gallery or from `maup new`, the document shows lines of it.
void check_model(const Workplace& workplace, const Block& block) {
  const fs::path file = workplace.place((block.word.empty() ? name_of_system(block) + ".lag" : block.word));
  const std::string text = fs::exists(file) ? read(file.string()) : std::string();
  if (contains(text, block.text.front())) {
    for (const std::string& line : block.text) CHECK_MESSAGE(contains(text, line.substr(0, line.find("  #"))), line);
  } else {
    std::ofstream(file, std::ios::binary) << block.joined();
  }
  if (!block.word.empty()) return;  // one that is wrong on purpose, for the command below it
  const Outcome checked = workplace.run("maup check '" + file.string() + "'");
  CAPTURE(checked.err);
  CHECK(checked.code == 0);
  if (!contains(block.joined(), "\nexpect ")) return;
  const Outcome tested = workplace.run("maup test '" + file.string() + "'");
  CAPTURE(tested.out);
  CHECK(tested.code == 0);
}

/// Lines of the language without the names that they need: the grammar takes them.
void parse_statements(const Block& block) {
  const Outcome outcome = maup({"check", "-", "--json"}, block.joined());
  CAPTURE(outcome.out);
  CHECK(outcome.code == 1);
  CHECK(contains(outcome.out, "\"code\": \"E02"));  // names that are not declared, so that the names were read
  CHECK_FALSE(contains(outcome.out, "\"code\": \"E01"));
}

// ------------------------------------------------------------------------------------------------ other languages

/// `maup COMMAND MODEL [--option …]`: every command and option exists.
void look_up_options(const Block& block) {
  static const std::regex option("(^|[^-\\w])(--?[a-z][\\w-]*)");
  std::string command, help;
  for (const std::string& line : block.text) {
    CAPTURE(line);
    if (begins_with(line, "maup ")) {
      std::istringstream words(line.substr(5));
      words >> command;
      help = command == "COMMAND" ? maup({"--help"}).out : maup({command, "--help"}).out;
      CHECK_FALSE(help.empty());
    }
    for (std::sregex_iterator at(line.begin(), line.end(), option), end; at != end; ++at)
      CHECK_MESSAGE(contains(help, (*at)[2].str()), (*at)[2].str());
  }
}

void parse_by(const std::string& reader, const Block& block) {
  const Folder folder;
  const Outcome outcome = shell(reader + " < '" + folder.write("block", block.joined()) + "'");
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
}

/// Languages of editors: brackets and quotes close, and what they load from this repository is there.
void balance(const Block& block) {
  std::string open;
  bool quoted = false, ok = true;
  for (const char c : block.joined()) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '(' || c == '[' || c == '{') open += c;
    if (c == ')' || c == ']' || c == '}') {
      ok = ok && !open.empty() && open.back() == (c == ')' ? '(' : c == ']' ? '[' : '{');
      if (!open.empty()) open.pop_back();
    }
  }
  CHECK((ok && open.empty() && !quoted));
  std::smatch match;
  const std::string text = block.joined();
  if (std::regex_search(text, match, std::regex("/path/to/maupertuis/([\\w/]+)")))
    CHECK(fs::exists(root + "/" + match[1].str()));
}

/// What data look like that the program gives or takes: the names in quotes stand so in the sources.
void look_up_names(const Block& block) {
  static const std::string sources = [] {
    std::string all;
    for (const char* folder : {"/src", "/apps"})
      for (const auto& entry : fs::recursive_directory_iterator(root + folder))
        if (entry.path().extension() == ".cpp") all += read(entry.path().string());
    return all;
  }();
  static const std::regex name("\"([a-z_]+)\"[,:}|]");
  const std::string text = block.joined();
  for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
    CHECK_MESSAGE(contains(sources, (*at)[1].str() + "\""), (*at)[1].str());
}

/// All blocks of C++ in one translation unit, each a function; names that the documents take for granted are in
/// snippets.hpp.
std::string translation_unit(const std::vector<Block>& blocks) {
  std::string head = "#include \"" + root + "/tests/documents/snippets.hpp\"\n", body;
  int number = 0;
  for (const Block& block : blocks) {
    body += "void block_" + std::to_string(++number) + "() {\n#line " + std::to_string(block.line) + " \"" +
            block.file + "\"\n";
    for (const std::string& line : block.text) {
      if (begins_with(line, "#include")) head += line + "\n";
      body += begins_with(line, "#include") ? "\n" : line + "\n";
    }
    body += "}\n";
  }
  return head + "using namespace maupertuis;\n" + body;
}

void read_block(const Block& block) {
  if (block.kind == "usage") return look_up_options(block);
  if (block.kind == "shape") return look_up_names(block);
  if (block.kind == "python") return parse_by("python3 -c 'import ast, sys; ast.parse(sys.stdin.read())'", block);
  if (block.kind == "toml") return parse_by("python3 -c 'import sys, tomllib; tomllib.loads(sys.stdin.read())'", block);
  if (block.kind == "cmake") {
    const std::string used = read(root + "/tests/consumer/outside/CMakeLists.txt");
    for (const std::string& line : block.text)  // the test `consumer` runs those of a program outside
      CHECK_MESSAGE((contains(used, "maupertuis::maupertuis") &&
                     (begins_with(line, "find_package(maupertuis") || begins_with(line, "target_link_libraries("))),
                    line);
    return;
  }
  if (block.kind == "vim" || block.kind == "lua" || block.kind == "elisp") return balance(block);
  // Pictures made of letters show nothing that could be carried out; formulas are set by tests/site.
  CHECK_MESSAGE((block.kind == "diagram" || block.kind == "formula" || block.kind == "cpp"),
                "a block of the unknown kind `" << block.kind << "`");
}

}  // namespace

TEST_CASE("every code block of the documents says what it is, and is so") {
  std::map<std::string, int> seen;
  std::map<std::string, std::unique_ptr<Workplace>> workplaces;
  for (const Block& block : all_blocks()) {
    CAPTURE(block.place());
    ++seen[block.kind];
    CHECK_FALSE(block.text.empty());
    const bool runs = block.kind == "console" || block.kind == "lag" || block.kind == "sh";
    std::unique_ptr<Workplace>& workplace = workplaces[block.file];
    if (runs && !workplace) workplace = std::make_unique<Workplace>(block.file);
    if (block.kind == "console")
      run_console(*workplace, block);
    else if (block.kind == "lag" && block.word == "statements")
      parse_statements(block);
    else if (block.kind == "lag")
      check_model(*workplace, block);
    else if (block.kind == "sh" && block.word.empty())
      run_shell(*workplace, block);
    else if (block.kind == "sh")
      read_shell(block);
    else
      read_block(block);
  }
  CHECK(seen[""] == 0);
  for (const auto& [kind, least] :
       std::map<std::string, int>{{"console", 12}, {"lag", 17}, {"sh", 8}, {"usage", 8}, {"formula", 30}, {"cpp", 4}})
    CHECK_MESSAGE(seen[kind] >= least, kind << ": " << seen[kind]);
  std::string counts;
  for (const auto& [kind, count] : seen) counts += kind + " " + std::to_string(count) + "  ";
  MESSAGE(counts);
  for (const char* written : {"pendulum.lag", "motion.csv", "motion.svg", "angle.svg", "pendulum.html", "pendulum.svg"})
    CHECK(fs::exists(workplaces.at("docs/manual/getting_started.md")->place(written)));
}

TEST_CASE("the C++ of the documents compiles against the public headers") {
  std::vector<Block> blocks;
  for (Block& block : all_blocks())
    if (block.kind == "cpp") blocks.push_back(std::move(block));
  const Folder folder;
  const std::string file = folder.write("blocks.cpp", translation_unit(blocks));
  const Outcome outcome = shell("ulimit -v unlimited; '" CXX_COMPILER "' -std=c++20 -fsyntax-only -I '" + root +
                                "/include' '" + file + "'");
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
}

TEST_CASE("the reader of blocks sees what is wrong") {
  const auto blocks = blocks_of(
      "x.md",
      "a\n\n    indented\n\n```lag\nsystem s\n```\n- item\n\n    of the list\n\nb\n\n```sh install\nmake x\n```\n");
  REQUIRE(blocks.size() == 3);
  CHECK((blocks[0].kind.empty() && blocks[0].line == 3 && blocks[0].text == std::vector<std::string>{"indented"}));
  CHECK((blocks[1].kind == "lag" && blocks[1].line == 6));
  CHECK((blocks[2].kind == "sh" && blocks[2].word == "install"));
  std::string missing;
  CHECK(shows({"a", "c"}, "0\na\n\nc\nd\n", missing));
  CHECK_FALSE(shows({"a", "c"}, "a\nb\nc\n", missing));
  CHECK(missing == "c");
  CHECK(shows({"a", "…", "c"}, "a\nb\nc\n", missing));
  CHECK(shows({"off by … at t = …"}, "off by 2e-16 at t = 3\n", missing));
  CHECK_FALSE(shows({"off by … at t = 4"}, "off by 2e-16 at t = 3\n", missing));
  CHECK_FALSE(shows({"by …"}, "off by 2\n", missing));
  CHECK(shows({"x = 1.25(3) m"}, "x = 1.252(9) m\n", missing));
  CHECK_FALSE(shows({"x = 1.25(3) m"}, "x = 1.29(1) m\n", missing));
  CHECK_FALSE(shows({"x = 1.25(3) m"}, "x = 1.25 m\n", missing));
}
