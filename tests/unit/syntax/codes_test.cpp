#include <doctest/doctest.h>

#include <maupertuis/codes.hpp>

#include "support.hpp"

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

using namespace maupertuis;
using namespace maupertuis::syntax::test;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("the examples of every code: the wrong one gives it and nothing else, the right one gives nothing") {
  for (const CodeEntry& entry : syntax_codes()) {
    CAPTURE(entry.code);
    if (entry.wrong.empty() || entry.wrong.rfind("maup ", 0) == 0) continue;  // tests/cli tries command lines
    Parsed wrong{std::string(entry.wrong)};
    CHECK_MESSAGE(wrong.codes() == entry.code, wrong.messages());
    Parsed right{std::string(entry.right)};
    CHECK_MESSAGE(right.fine(), right.messages());
  }
}

TEST_CASE("the codes in the sources and in the catalogue are the same") {
  std::set<std::string> used, explained;
  const std::regex code("\"([EWN]0[0-9]{3})\"");
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(PROJECT_DIR) / "src/syntax")) {
    if (file.path().extension() != ".cpp" || file.path().filename() == "codes.cpp") continue;
    const std::string text = read(file.path());
    for (std::sregex_iterator i(text.begin(), text.end(), code), end; i != end; ++i) used.insert((*i)[1]);
  }
  for (const CodeEntry& entry : syntax_codes()) {
    CHECK(explained.insert(std::string(entry.code)).second);
    CHECK(entry.code.substr(1, 2) == "01");
    CHECK_FALSE(entry.explanation.empty());
  }
  CHECK(used == explained);
}
