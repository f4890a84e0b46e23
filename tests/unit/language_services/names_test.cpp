#include "support.hpp"

#include <doctest/doctest.h>

namespace {
using namespace language_test;

std::string renamed(const std::string& marked, const std::string& name) {
  const Marked at(marked);
  Document asked = document(at.text);
  const Rename out = rename(asked, at.offset, name);
  return out.refusal.empty() ? edited(at.text, out.edits) : "refused: " + out.refusal;
}

std::vector<std::string> lines_of_references(const std::string& marked) {
  const Marked at(marked);
  Document asked = document(at.text);
  std::vector<std::string> out;
  for (const Span& span : references(asked, at.offset))
    out.push_back(std::to_string(asked.source().locate(span.begin).line) + " " + slice(at.text, span));
  return out;
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("a name leads to its declaration, in any spelling") {
  for (const char* use : {"V = -m g l cos |θ\n", "V = -m g l cos th|eta\n", "V = -m g l cos theta|\n"}) {
    const Marked at(std::string("param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ̇^2\n") + use);
    Document asked = document(at.text);
    const auto found = definition(asked, at.offset);
    REQUIRE(found);
    CHECK(found->begin == at.text.find("θ :"));
    CHECK(references(asked, at.offset).size() == 3);
    CHECK(references(asked, at.offset, false).size() == 2);
  }
}

TEST_CASE("the mass m is no metre") {
  const std::string text =
      "param m| = 2 kg, d = 3 m, c = 1 [m]\ncoord x : length\nT = 1/2 m x'^2\nV = 2 [N/m] x^2 + 0 [N m]\n"
      "force x = 3 m (1 [m/s^2])\nstart x = 2 m\n";
  CHECK(lines_of_references(text) == Words{"1 m", "3 m", "5 m"});
}

TEST_CASE("in a quantity place the dimension says whether m is the mass") {
  // 3 m is a mass where a mass is asked for, and a length where a length is.
  const std::string text = "param m| = 2 kg\ncoord x : length\npoint P mass 3 m at (x, 0)\nstart x = 2 m\nrun 1 s\n";
  CHECK(lines_of_references(text) == Words{"1 m", "3 m"});
  CHECK(renamed(text, "M") == "param M = 2 kg\ncoord x : length\npoint P mass 3 M at (x, 0)\nstart x = 2 m\nrun 1 s\n");
}

TEST_CASE("a new name goes everywhere, with its derivatives and momenta") {
  CHECK(renamed("param m = 1 kg\ncoord θ| : angle\nT = 1/2 m (1 [m^2]) θ̇^2\nstart θ' = 1 rad/s\n"
                "expect hamiltonian = p_θ^2/(2 m (1 [m^2]))\n",
                "φ") ==
        "param m = 1 kg\ncoord φ : angle\nT = 1/2 m (1 [m^2]) φ'^2\nstart φ' = 1 rad/s\n"
        "expect hamiltonian = p_φ^2/(2 m (1 [m^2]))\n");
  CHECK(renamed("field u|(x) : length on x = 0 m .. 1 m\ndensity = 1/2 [kg/m] u'^2 - 1/2 [N] u_x^2\n", "w") ==
        "field w(x) : length on x = 0 m .. 1 m\ndensity = 1/2 [kg/m] w'^2 - 1/2 [N] w_x^2\n");
  const std::string rod = "param m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\n";
  CHECK(renamed(rod + "constraint x^2 + y^2 = l^2 name ro|d\nstart x = l\nexpect reaction rod at 0 s = 0 N ± 1 N\n",
                "stick") ==
        rod + "constraint x^2 + y^2 = l^2 name stick\nstart x = l\nexpect reaction stick at 0 s = 0 N ± 1 N\n");
}

TEST_CASE("a theta that is typed in letters is renamed too, and nothing in comments and texts") {
  CHECK(renamed("system a \"the mass m\"\nparam m| = 1 kg # m\ncoord x : length\nT = 1/2 m x'^2\n", "mass_1") ==
        "system a \"the mass m\"\nparam mass_1 = 1 kg # m\ncoord x : length\nT = 1/2 mass_1 x'^2\n");
}

TEST_CASE("renames that are refused say why") {
  const std::string text = "param m| = 1 kg, g = 9.81 m/s^2\ncoord x : length\nT = 1/2 m x'^2\nV = m g x\n";
  CHECK(renamed(text, "g").find("is taken: a parameter has this name on line 1") != std::string::npos);
  CHECK(renamed(text, "sin").find("function") != std::string::npos);
  CHECK(renamed(text, "mass").find("separates") != std::string::npos);
  CHECK(renamed(text, "t").find("meaning of its own") != std::string::npos);
  for (const char* bad : {"", "2m", "a b", "a'", "a.b", "a#", "α β", "\xff"})
    CHECK(renamed(text, bad).find("is no name") != std::string::npos);
  CHECK(renamed("pa|ram m = 1 kg\n", "q").find("no name of this model") != std::string::npos);
  // `s` as a name makes of 3 s in a quantity place another thing: whatever the reading is, the codes tell.
  CHECK(renamed(text, "m") == Marked(text).text);
}

TEST_CASE("a rename that another line reads otherwise is refused") {
  // With x renamed to e1, the number 2e1 would have two meanings.
  CHECK(renamed("param m = 1 kg, k = 2e1 N/m\ncoord x| : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n", "e1")
            .find("refused") == 0);
}

TEST_CASE("events have names of their own") {
  const std::string text =
      "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nstart x' = 1 m/s\nrun 2 s\nevent hi|t when x = 1 m : record\n"
      "expect event hit 1 at 1 s ± 1e-9 s\n";
  CHECK(lines_of_references(text) == Words{"6 hit", "7 hit"});
}

TEST_CASE("every name of the gallery can be renamed there and back") {
  for (const auto& path : models_in("models")) {
    const std::string text = read_file(path);
    if (text.size() > 1500) continue;
    Document asked = document(text);
    CAPTURE(path.filename().string());
    for (const Symbol& symbol : symbols(asked)) {
      if (symbol.kind != SymbolKind::Parameter && symbol.kind != SymbolKind::Coordinate) continue;
      const Span span = symbol.children.empty() ? symbol.name_span : symbol.children[0].name_span;
      if (!definition(asked, span.begin)) continue;
      CAPTURE(slice(text, span));
      const Rename there = rename(asked, span.begin, "renamed_0");
      if (!there.refusal.empty()) continue;  // a space variable whose derivatives are named after it
      const std::string other = edited(text, there.edits);
      Document back_asked = document(other);
      const auto place = static_cast<std::uint32_t>(other.find("renamed_0"));
      const auto declared = definition(back_asked, place);
      REQUIRE(declared);
      CHECK(references(back_asked, place).size() == references(asked, span.begin).size());
    }
  }
}
