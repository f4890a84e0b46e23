// The layering of ARCHITECTURE.md, as written there, as linked by src/CMakeLists.txt, and as included by the sources.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

namespace {

using Names = std::set<std::string>;

struct Module {
  Names uses;     // the modules that its line names
  Names headers;  // its public headers
};
using Table = std::map<std::string, Module>;

Names words(const std::string& text) {
  std::istringstream in(text);
  Names out;
  for (std::string word; in >> word;) out.insert(word);
  return out;
}

/// Lines `| module | uses | public headers |` of ARCHITECTURE.md.
Table table_of_architecture() {
  Table table;
  const std::regex row(R"(\| `([a-z_/]+)` \| ?([a-z_/ ]*?) ?\| ?([a-z_. ]*?) ?\|)");
  for (const std::string& line : source_tree::read(std::string(PROJECT_DIR) + "/ARCHITECTURE.md").lines)
    if (std::smatch m; std::regex_match(line, m, row)) table[m[1]] = {words(m[2]), words(m[3])};
  return table;
}

/// Lines `maup_module(module LINKS uses)` of src/CMakeLists.txt, and `maup_plugin` for what the program opens at run
/// time.
std::map<std::string, Names> table_of_build() {
  std::map<std::string, Names> table;
  const std::regex call(R"(\bmaup_(?:module|plugin)\(([a-z_/]+)(?:\s+LINKS\s+([a-z_/\s]+?))?)"
                        R"((?:\s+(?:PRIVATE_LINKS|ALONE|TOGETHER|BATCH|COLD|CHECKED)[^)]*)?\))");
  std::string text;  // a call may go over several lines
  for (const std::string& line : source_tree::read(std::string(PROJECT_DIR) + "/src/CMakeLists.txt").lines)
    text += line + '\n';
  for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) table[(*it)[1]] = words((*it)[2]);
  return table;
}

/// A module and all that it uses, directly or through others.
Names reach(const std::string& module, const Table& table) {
  Names seen;
  std::vector<std::string> open{module};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!seen.insert(next).second) continue;
    if (const auto it = table.find(next); it != table.end())
      open.insert(open.end(), it->second.uses.begin(), it->second.uses.end());
  }
  return seen;
}

/// Readers of private headers from outside the family, each with its reason in ARCHITECTURE.md.
const std::set<std::pair<std::string, std::string>> confidants{{"disks", "kernel/program"},
                                                               {"disks", "kernel/series"},
                                                               {"disks", "kernel/reference"},
                                                               {"machine_code/llvm", "kernel/packed"},
                                                               {"machine_code/llvm", "kernel/lanes"},
                                                               {"machine_code/llvm", "kernel/straight_line"},
                                                               {"machine_code/llvm", "kernel/unrolled"},
                                                               {"certificate", "symbolic/evaluate"},
                                                               {"analysis/invariants", "symbolic/evaluate"},
                                                               {"fields", "symbolic/evaluate"},
                                                               {"integrator/extended", "kernel/extended"},
                                                               {"integrator/taylor", "disks"},
                                                               {"integrator/extended", "disks"}};

std::string top_folder(const std::string& module) { return module.substr(0, module.find('/')); }

/// The module whose folder, below src/, holds this path; the longest that fits.
std::string module_of_path(const std::string& path, const Table& table) {
  std::string best;
  for (const auto& [module, unused] : table)
    if (path.rfind(module + "/", 0) == 0 && module.size() > best.size()) best = module;
  return best;
}

std::string module_of_header(const std::string& header, const Table& table) {
  for (const auto& [module, row] : table)
    if (row.headers.count(header)) return module;
  return {};
}

/// What one file may not include, as `file:line: …`.
std::vector<std::string> violations(const source_tree::File& file, const std::string& module, const Table& table) {
  static const std::regex include(R"(\s*#\s*include\s*[<"]([^">]+)[">].*)");
  const Names allowed = reach(module, table);
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::smatch m;
    if (!std::regex_match(file.lines[i], m, include)) continue;
    const std::string included = m[1];
    const std::string place = file.path + ":" + std::to_string(i + 1) + ": ";
    if (included.rfind("maupertuis/", 0) == 0) {
      const std::string owner = module_of_header(included.substr(11), table);
      if (owner.empty())
        found.push_back(place + included + " stands in no line of the table in ARCHITECTURE.md");
      else if (!allowed.count(owner))
        found.push_back(place + module + " may not use " + owner + " (" + included + ")");
    } else if (const std::string owner = module_of_path(included, table); !owner.empty() && owner != module) {
      // Private headers stay within a family (kernel/series may read kernel/program's) and below in the table.
      const bool close = top_folder(owner) == top_folder(module) || confidants.count({module, owner}) ||
                         owner == "linear_algebra" || owner == "machine_code";
      if (!allowed.count(owner) || !close)
        found.push_back(place + module + " may not read the private header " + included);
    }
  }
  return found;
}

std::vector<std::string> violations_below(const std::string& folder, const Table& table) {
  std::vector<std::string> found;
  for (const source_tree::File& file : source_tree::sources({folder})) {
    const bool is_public = folder == "include";
    const std::string module =
        is_public ? module_of_header(file.path.substr(std::string("include/maupertuis/").size()), table)
                  : module_of_path(file.path.substr(std::string("src/").size()), table);
    if (module.empty()) {
      found.push_back(file.path + ":1: belongs to no module of the table in ARCHITECTURE.md");
      continue;
    }
    const auto more = violations(file, module, table);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

void expect_none(const std::vector<std::string>& found) {
  for (const std::string& line : found) FAIL_CHECK(line);
}

}  // namespace

TEST_CASE("the table of ARCHITECTURE.md is the one that the build links") {
  const Table written = table_of_architecture();
  const auto linked = table_of_build();
  REQUIRE(written.size() > 15);
  CHECK(written.size() == linked.size());
  for (const auto& [module, uses] : linked) {
    CAPTURE(module);
    REQUIRE(written.count(module) == 1);
    CHECK(written.at(module).uses == uses);
  }
}

TEST_CASE("no module includes what its line does not allow") {
  const Table table = table_of_architecture();
  expect_none(violations_below("src", table));
  expect_none(violations_below("include", table));
}

TEST_CASE("a forbidden include is seen") {
  const Table table = table_of_architecture();
  const source_tree::File upwards{"src/base/x.cpp", {"#include <vector>", "#include <maupertuis/simulation.hpp>"}};
  REQUIRE(violations(upwards, "base", table).size() == 1);
  CHECK(violations(upwards, "base", table)[0].rfind("src/base/x.cpp:2: base may not use simulation", 0) == 0);
  const source_tree::File sideways{"src/kernel/series/x.cpp", {"#include \"system/elaboration.hpp\""}};
  CHECK(violations(sideways, "kernel/series", table).size() == 1);
  const source_tree::File own{"src/kernel/series/x.cpp",
                              {"#include \"kernel/series/x.hpp\"", "#include \"kernel/program/y.hpp\""}};
  CHECK(violations(own, "kernel/series", table).empty());
}

TEST_CASE("no cycle: every module is reached only from above") {
  const Table table = table_of_architecture();
  for (const auto& [module, row] : table)
    for (const std::string& used : row.uses) {
      CAPTURE(module);
      CAPTURE(used);
      CHECK(reach(used, table).count(module) == 0);
    }
}

TEST_CASE("the command line sees include/ alone") {
  static const std::regex include(R"(\s*#\s*include\s*"([^"]+)\".*)");
  const std::filesystem::path own = std::filesystem::path(PROJECT_DIR) / "apps/maup";
  for (const source_tree::File& file : source_tree::sources({"apps/maup"}))
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      if (std::smatch m; std::regex_match(file.lines[i], m, include) && !std::filesystem::exists(own / m[1].str()))
        FAIL_CHECK(file.path << ":" << i + 1 << ": " << m[1].str() << " is no header of apps/maup");
}

TEST_CASE("what is dear to compile is included in few places") {
  struct Library {
    std::string headers;
    std::set<std::string> readers;  // files, or folders with a slash at the end
  };
  // Sources may store and multiply matrices as they like; factorizations are compiled once. The kernels' matrices are
  // views of their own.
  const std::vector<Library> libraries{
      {R"re(eigen3/Eigen/(Dense|LU|QR|SVD|Cholesky|Eigenvalues))re", {"src/linear_algebra/", "src/kernel/dense/"}},
      {R"re(CLI/.*)re", {"apps/maup/options.cpp", "apps/maup/option_table.cpp"}},
      {R"re(boost/multiprecision/.*)re",
       {"src/symbolic/evaluate/real100.hpp", "src/kernel/extended/number.hpp", "src/base/rational.cpp"}}};
  for (const Library& library : libraries) {
    const std::regex include("\\s*#\\s*include\\s*[<\"]" + library.headers + "[>\"].*");
    std::size_t inside = 0;
    for (const source_tree::File& file : source_tree::sources({"src", "include", "apps"}))
      for (std::size_t i = 0; i < file.lines.size(); ++i) {
        if (!std::regex_match(file.lines[i], include)) continue;
        const bool allowed = std::any_of(library.readers.begin(), library.readers.end(),
                                         [&](const std::string& reader) { return file.path.rfind(reader, 0) == 0; });
        if (allowed)
          ++inside;
        else
          FAIL_CHECK(file.path << ":" << i + 1 << ": " << file.lines[i]);
      }
    CHECK(inside > 0);
  }
}

TEST_CASE("LLVM is included in one folder") {
  const std::regex include(R"(\s*#\s*include\s*<(llvm|llvm-c)/.*)");
  std::size_t inside = 0;
  for (const source_tree::File& file : source_tree::sources({"src", "include", "apps"}))
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      if (!std::regex_match(file.lines[i], include)) continue;
      if (file.path.rfind("src/machine_code/llvm/", 0) == 0)
        ++inside;
      else
        FAIL_CHECK(file.path << ":" << i + 1 << ": " << file.lines[i]);
    }
  CHECK(inside > 0);
}

TEST_CASE("public headers stay light, and the core compiles for a browser") {
  // Debian's emscripten brings libc++ 13, which has none of these.
  const std::regex not_in_core(R"(.*(<ranges>|<format>|<source_location>|<memory_resource>|std::bit_cast|)"
                               R"(std::jthread|std::views|std::ranges).*)");
  const std::regex not_in_headers(R"(\s*#\s*include\s*<(fmt/|boost/|Eigen/|eigen3/|nlohmann/|llvm/|CLI/).*)");
  for (const source_tree::File& file : source_tree::sources({"src", "include"})) {
    const bool header = file.path.rfind("include/", 0) == 0;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const bool wrong =
          std::regex_match(file.lines[i], not_in_core) || (header && std::regex_match(file.lines[i], not_in_headers));
      if (wrong) FAIL_CHECK(file.path << ":" << i + 1 << ": " << file.lines[i]);
    }
  }
}
