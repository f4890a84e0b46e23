// Sources of one folder are compiled several at a time (cmake/Modules.cmake): file-local functions of one name are then
// one set of overloads, and the other file's may fit better. So names differ where the numbers of parameters do not.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <map>
#include <regex>

namespace {

/// The parameters of the function whose bracket opens at `open`; commas of templates and initializers are inside.
int parameters_after(const std::string& text, std::size_t open) {
  int depth = 0, commas = 0;
  bool any = false;
  for (std::size_t i = open; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '(' || c == '<' || c == '{' || c == '[') ++depth;
    if (c == ')' || c == '>' || c == '}' || c == ']') --depth;
    if (depth == 0) break;
    commas += c == ',' && depth == 1;
    any = any || (depth >= 1 && i > open && c != ' ' && c != '\n');
  }
  return any ? commas + 1 : 0;
}

/// "name/parameters" of each function that a file defines in `namespace { … }`.
std::vector<std::string> local_functions(const source_tree::File& file) {
  static const std::regex head(R"re(([A-Za-z_][\w:<>, *&]*[ *&>])([a-z_]\w*)\(.*)re");
  std::vector<std::string> found;
  bool local = false;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string& line = file.lines[i];
    if (line == "namespace {") local = true;
    if (line == "}  // namespace") local = false;
    std::smatch m;
    if (!local || !std::regex_match(line, m, head) || m[1].str().rfind("using", 0) == 0) continue;
    std::string text = line;
    for (std::size_t k = i + 1; k < file.lines.size() && k < i + 6; ++k) text += "\n" + file.lines[k];
    found.push_back(m[2].str() + "/" +
                    std::to_string(parameters_after(text, static_cast<std::size_t>(m.position(2) + m.length(2)))));
  }
  return found;
}

/// The printers, which write the same things for LaTeX, MathML and plain text, are compiled alone (src/CMakeLists.txt).
bool is_alone(const std::string& path) {
  return path == "src/symbolic/print/mathml.cpp" || path == "src/symbolic/print/plain.cpp";
}

}  // namespace

TEST_CASE("file-local functions of one folder have names of their own") {
  std::map<std::pair<std::string, std::string>, std::string> first;  // folder, function → file
  std::size_t seen = 0;
  for (const source_tree::File& file : source_tree::sources({"src", "apps"})) {
    if (std::filesystem::path(file.path).extension() != ".cpp" || is_alone(file.path)) continue;
    const std::string folder = file.path.rfind("apps/maup", 0) == 0 && file.path.rfind("apps/maup-", 0) != 0
                                   ? "apps/maup"
                                   : std::filesystem::path(file.path).parent_path().string();
    for (const std::string& function : local_functions(file)) {
      ++seen;
      const auto [at, is_new] = first.emplace(std::pair{folder, function}, file.path);
      if (!is_new && at->second != file.path)
        FAIL_CHECK(file.path << " and " << at->second << " have a file-local function each: " << function);
    }
  }
  CHECK(seen > 1000);
}

TEST_CASE("file-local functions and their parameters are seen") {
  const source_tree::File file{
      "a.cpp",
      {"namespace {", "std::string quoted(std::string_view text) {", "}", "int of(const std::map<int, int>& a,",
       "       int b = 3) {", "}", "}  // namespace", "int outside(int a) {", "}"}};
  CHECK(local_functions(file) == std::vector<std::string>{"quoted/1", "of/2"});
}
