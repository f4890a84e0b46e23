#include <doctest/doctest.h>

#include "support.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace maupertuis;
using namespace maupertuis::syntax;
using namespace maupertuis::syntax::test;

namespace format_test {
namespace {

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> models() {
  std::vector<std::filesystem::path> found;
  for (const char* folder : {"models", "tests/problems", "tests/golden/fmt"}) {
    const auto path = std::filesystem::path(PROJECT_DIR) / folder;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& file : std::filesystem::directory_iterator(path)) {
      if (file.path().extension() == ".lag") found.push_back(file.path());
    }
  }
  return found;
}

}  // namespace

TEST_CASE("canonical layout") {
  CHECK(formatted("param  m=1kg ,l = 60   cm\n") == "param m = 1 kg, l = 60 cm\n");
  CHECK(formatted("let a=-b*c+d/( e - -f )^ - 2\n") == "let a = -b*c + d/(e - -f)^-2\n");
  CHECK(formatted("let a = ½ m v² − √x\n") == "let a = 1/2 m v^2 - sqrt(x)\n");
  CHECK(formatted("let a = x^½\n") == "let a = x^(1/2)\n");
  CHECK(formatted("let a = sin²θ+cos 2θ\n") == "let a = sin^2 θ + cos 2θ\n");
  CHECK(formatted("let a = sin^2 ( θ )\n") == "let a = sin^2(θ)\n");
  CHECK(formatted("let a = 2θ\n") == "let a = 2 θ\n");
  CHECK(formatted("param m = 1\nlet a = m(m+1)(m-1)\n") == "param m = 1\nlet a = m (m + 1) (m - 1)\n");
  CHECK(formatted("let a = θ̇1 + ẍ + dot(theta) + dot(dot(x)) + dot(a b) + dot(u,v)\n") ==
        "let a = θ1' + x'' + θ' + x'' + (a b)' + dot(u, v)\n");
  CHECK(formatted("let a = dot((a + b)) + dot(dot(a b)) + dot(P.x)\n") == "let a = (a + b)' + (a b)'' + P.x'\n");
  CHECK(formatted("coord x,y:length,theta:angle\n") == "coord x, y : length, θ : angle\n");
  CHECK(formatted("input u:[ N ]=3 [ N ]*t\n") == "input u : [N] = 3 [N]*t\n");
  CHECK(formatted("T+=a·b×c\n") == "T += a · b × c\n");
  CHECK(formatted("body B inertia diag (1,2,3) rotation euler zxz(a,b,c)\n") ==
        "body B inertia diag(1, 2, 3) rotation euler zxz (a, b, c)\n");
  CHECK(formatted("start x=-10deg,y=60°\n") == "start x = -10 deg, y = 60 deg\n");
  CHECK(formatted("run -10 s\n") == "run -10 s\n");
  CHECK(formatted("expect conserved -x\n") == "expect conserved -x\n");
  CHECK(formatted("expect θ at 3 s=1±1e-3\n") == "expect θ at 3 s = 1 ± 1e-3\n");
  CHECK(formatted("draw O-A-( 0,1 ),trail B\n") == "draw O - A - (0, 1), trail B\n");
  CHECK(formatted("let a = piecewise(x<0 and y≥1:-x,else:x)\n") ==
        "let a = piecewise(x < 0 and y >= 1 : -x, else : x)\n");
  CHECK(formatted("source “a \"quoted\" title”\n") == "source “a \"quoted\" title”\n");
  CHECK(formatted("system a “title”\n") == "system a \"title\"\n");
}

TEST_CASE("lines, comments and blank lines stay") {
  CHECK(formatted("\n\n# head\n\n\n\nparam m = 1   #mass\n  # inside\n  , l = 2\n# next\ncoord x : number\n\n\n") ==
        "# head\n\nparam m = 1  #mass\n    # inside\n    , l = 2\n# next\ncoord x : number\n");
  CHECK(formatted("param m = 1 # a\nparam long = 2 # b\n\nparam n = 3 # c") ==
        "param m = 1     # a\nparam long = 2  # b\n\nparam n = 3  # c\n");
  CHECK(formatted("  param m = 1\r\n  param n = (2 + # two\r\n3)\r\n") ==
        "param m = 1\nparam n = (2 +  # two\n    3)\n");
  CHECK(formatted("\xEF\xBB\xBF# a\nparam m = 1\n") == "# a\nparam m = 1\n");
}

TEST_CASE("long lines are broken after commas and before signs") {
  std::string text = "let a = 1";
  for (int i = 0; i < 40; ++i) text += " + some_name" + std::to_string(i);
  const std::string once = formatted(text + "\n");
  std::istringstream lines(once);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    CHECK(line.size() <= 100);
    CHECK(line.substr(0, 4) == (count == 0 ? "let " : "    "));
  }
  CHECK(count > 4);
  CHECK(formatted(once) == once);
  CHECK(dump(Parsed(once).tree) == dump(Parsed(text).tree));
}

TEST_CASE("the models of the project keep their tree, and formatting twice changes nothing") {
  const auto files = models();
  CHECK(files.size() > 10);
  for (const auto& file : files) {
    CAPTURE(file.filename().string());
    Parsed before(read(file));
    REQUIRE_MESSAGE(!before.diagnostics.has_errors(), before.messages());
    const std::string once = format(before.tree, before.source);
    Parsed after(once);
    REQUIRE_MESSAGE(!after.diagnostics.has_errors(), after.messages());
    CHECK(dump(after.tree) == dump(before.tree));
    CHECK(after.tree.comments.size() == before.tree.comments.size());
    CHECK(format(after.tree, after.source) == once);
  }
}

TEST_CASE("golden: the sample models in canonical layout") {
  const auto folder = std::filesystem::path(PROJECT_DIR) / "tests/golden/fmt";
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".lag") continue;
    CAPTURE(file.path().filename().string());
    CHECK(formatted(read(file.path())) == read(std::filesystem::path(file.path()).replace_extension(".expected")));
    ++count;
  }
  CHECK(count >= 11);
}

}  // namespace format_test
