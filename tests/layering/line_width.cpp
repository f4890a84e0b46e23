// Sources, scripts and what builds them keep to 120 columns.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

namespace {

namespace fs = std::filesystem;

constexpr std::size_t widest = 120;

/// Columns of UTF-8 text: continuation bytes take none, nor do the accents that stand above a letter (U+0300 to
/// U+036F).
std::size_t columns(const std::string& line) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const unsigned byte = static_cast<unsigned char>(line[i]);
    const unsigned next = i + 1 < line.size() ? static_cast<unsigned char>(line[i + 1]) : 0;
    const bool accent = byte == 0xcc || (byte == 0xcd && next < 0xb0);
    if ((byte & 0xc0) != 0x80 && !accent) ++count;
  }
  return count;
}

/// What is written by hand, line by line. Models, pages, data and what a test expects are not.
bool is_source(const fs::path& file) {
  static const std::set<std::string> endings{".cpp",  ".hpp", ".py", ".js",    ".mjs", ".ts", ".css",
                                             ".html", ".sh",  ".in", ".cmake", ".vim", ".el"};
  static const std::set<std::string> names{"CMakeLists.txt", "Makefile", "Dockerfile"};
  const fs::path folder = file.parent_path().filename();
  return endings.count(file.extension().string()) || names.count(file.filename().string()) ||
         (folder == "scripts" && !file.has_extension());
}

bool is_made(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name == "node_modules" || name == "dist" || name == "__pycache__" || name.rfind("build", 0) == 0;
}

std::vector<source_tree::File> sources() {
  std::vector<source_tree::File> files;
  const fs::path root = PROJECT_DIR;
  for (const auto& entry : fs::directory_iterator(root))
    if (entry.is_regular_file() && is_source(entry.path())) files.push_back(source_tree::read(entry.path()));
  for (const char* top : {"apps", "benchmarks", "cmake", "editors", "include", "packaging", "scripts", "site", "src",
                          "studio", "tests"}) {
    fs::recursive_directory_iterator it(root / top);
    for (const fs::recursive_directory_iterator end; it != end; ++it)
      if (it->is_directory() && is_made(it->path()))
        it.disable_recursion_pending();
      else if (it->is_regular_file() && is_source(it->path()))
        files.push_back(source_tree::read(it->path()));
  }
  return files;
}

std::vector<std::string> too_wide(const source_tree::File& file) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i)
    if (const std::size_t width = columns(file.lines[i]); width > widest)
      found.push_back(file.path + ":" + std::to_string(i + 1) + ": " + std::to_string(width) + " columns");
  return found;
}

}  // namespace

TEST_CASE("no line of a source or script is wider than 120 columns") {
  const auto files = sources();
  for (const char* path : {"Makefile", "CMakeLists.txt", "scripts/gallery", "scripts/precise.py", "cmake/Modules.cmake",
                           "src/report/page/scene.js", "site/source/prose.mjs", "studio/src/study.ts",
                           "src/report/page/style.css", "src/base/rational.cpp", "packaging/maupertuis.desktop.in"})
    CHECK_MESSAGE(std::any_of(files.begin(), files.end(), [&](const auto& file) { return file.path == path; }), path);
  for (const source_tree::File& file : files)
    for (const std::string& line : too_wide(file)) FAIL_CHECK(line);
}

TEST_CASE("columns are counted, not bytes") {
  CHECK(columns("θ̇ = ω, q̈ → 0") == 12);
  std::string wide;
  for (int i = 0; i < 120; ++i) wide += "θ";
  CHECK(too_wide({"x.cpp", {wide}}).empty());
  CHECK(too_wide({"x.cpp", {"", wide + "θ"}}) == std::vector<std::string>{"x.cpp:2: 121 columns"});
}
