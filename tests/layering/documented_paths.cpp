// Files and folders that the pages name are there.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <regex>

namespace {

namespace fs = std::filesystem;

std::vector<source_tree::File> pages() {
  const fs::path root = PROJECT_DIR;
  std::vector<source_tree::File> out;
  for (const char* page : {"ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"})
    out.push_back(source_tree::read(root / page));
  for (const char* folder : {"docs", "src", "apps", "tests", "models"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md" && entry.path().string().find("/node_modules/") == std::string::npos)
        out.push_back(source_tree::read(entry.path()));
  return out;
}

/// A page may leave out where its subject begins, and the ending of a source.
bool is_there(const std::string& name, const source_tree::File& page) {
  const fs::path root = PROJECT_DIR, own = root / fs::path(page.path).parent_path();
  for (const fs::path& base : {root, root / "src", root / "src/kernel", root / "src/symbolic", root / "tests",
                               root / "apps/maup", root / "include", root / "include/maupertuis", own})
    for (const char* ending : {"", ".cpp", ".hpp"})
      if (fs::exists(base / (name + ending))) return true;
  return false;
}

/// What is made by a build, or is no path of this tree.
bool is_elsewhere(const std::string& name) {
  return name.rfind("build", 0) == 0 || name.rfind("lib/", 0) == 0 || name.front() == '/' || name.front() == '.';
}

std::vector<std::string> missing(const source_tree::File& page) {
  static const std::regex path(R"(`([A-Za-z_0-9.\-]+(?:/[A-Za-z_0-9.\-]+)*/[A-Za-z_0-9.\-]*)`)");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < page.lines.size(); ++i)
    for (std::sregex_iterator it(page.lines[i].begin(), page.lines[i].end(), path), end; it != end; ++it)
      if (const std::string name = (*it)[1]; !is_elsewhere(name) && !is_there(name, page))
        found.push_back(page.path + ":" + std::to_string(i + 1) + ": there is no " + name);
  return found;
}

}  // namespace

TEST_CASE("folders and files that a page names exist") {
  const auto all = pages();
  REQUIRE(all.size() > 40);
  for (const source_tree::File& page : all)
    for (const std::string& line : missing(page)) FAIL_CHECK(line);
  CHECK(missing({"ARCHITECTURE.md", {"`unit/` mirrors `src/`; `regressions/`"}}) ==
        std::vector<std::string>{"ARCHITECTURE.md:1: there is no regressions/"});
}

TEST_CASE("ARCHITECTURE.md names every folder of the tests") {
  std::string text;
  for (const std::string& line : source_tree::read(fs::path(PROJECT_DIR) / "ARCHITECTURE.md").lines)
    text += line + "\n";
  for (const auto& entry : fs::directory_iterator(fs::path(PROJECT_DIR) / "tests"))
    if (entry.is_directory()) {
      const std::string name = "`" + entry.path().filename().string() + "/`";
      CHECK_MESSAGE(text.find(name) != std::string::npos, name);
    }
}
