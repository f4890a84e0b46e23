#include "support.hpp"

#include <doctest/doctest.h>

namespace {
using namespace language_test;
}  // namespace

TEST_CASE("the outline has every statement, with the names of lists below it") {
  Document asked = document(pendulum);
  const auto found = symbols(asked);
  REQUIRE(found.size() == 8);
  CHECK(found[0].name == "pendulum");
  CHECK(found[0].kind == SymbolKind::System);
  REQUIRE(found[1].children.size() == 3);
  CHECK(found[1].children[2].name == "g");
  CHECK(found[1].children[2].detail == "param g = 9.81 m/s^2");
  CHECK(found[2].name == "θ");
  CHECK(found[7].name == "run 10 s");
}

TEST_CASE("formatting is that of maup fmt, and leaves a text with mistakes alone") {
  Document asked = document("coord theta:angle\nT=theta'^2\n");
  const auto edits = formatting(asked).edits;
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].text == "coord θ : angle\nT = θ'^2\n");
  Document done = document(edits[0].text);
  CHECK((formatting(done).edits.empty() && !formatting(done).mistake));
  Document wrong = document("coord theta:angle\nT=(theta'^2\n");
  const Formatting kept = formatting(wrong);
  CHECK(kept.edits.empty());
  REQUIRE(kept.mistake);
  CHECK(kept.mistake->severity == Severity::Error);
  CHECK(wrong.source().locate(kept.mistake->span->begin).line == 2);
}

TEST_CASE("tokens have the kind that the language reads in them, and do not overlap") {
  const std::string text = "coord θ : angle # deg\nT = 1/2 (3 [kg m^2]) θ̇^2 + ½ sin(θ) B.x\n";
  Document asked = document(text);
  std::string kinds;
  std::uint32_t end = 0;
  for (const SemanticToken& token : semantic_tokens(asked)) {
    CHECK(token.span.begin >= end);
    end = token.span.end;
    const std::string word = slice(text, token.span);
    if (word == "coord" || word == "T" || word == "angle") CHECK(token.kind == TokenKind::Keyword);
    if (word == "θ" || word == "θ̇") CHECK(token.kind == TokenKind::Coordinate);
    if (word == "kg" || word == "m") CHECK(token.kind == TokenKind::Unit);
    if (word == "sin") CHECK(token.kind == TokenKind::Function);
    if (word == "# deg") CHECK(token.kind == TokenKind::Comment);
    if (word == "x") CHECK(token.kind == TokenKind::Member);
    if (word == "½" || word == "3") CHECK(token.kind == TokenKind::Number);
    kinds += token.declaration ? "d" : ".";
  }
  CHECK(kinds.find('d') == 1);
  CHECK(kinds.find('d', 2) == std::string::npos);
}

TEST_CASE("statements of several lines and runs of comments fold") {
  const std::string text = "# one\n# two\nsystem a\nparam m = 1 kg,\n  l = 1 m\n# three\n";
  Document asked = document(text);
  const auto found = folding(asked);
  REQUIRE(found.size() == 2);
  CHECK(slice(text, found[0]) == "# one\n# two");
  CHECK(slice(text, found[1]) == "param m = 1 kg,\n  l = 1 m");
}

TEST_CASE("diagnostics: the fast ones at once, those of the derivation when asked") {
  // A start off the constraint is found when the equations are there.
  const SourceText text("a.lag",
                        "param m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, y)\n"
                        "constraint x^2 + y^2 = l^2\nconstraint x^2 + y^2 = 4 l^2\nstart x = 1 m\nrun 1 s\n");
  Document asked{text};
  CHECK(!asked.diagnostics().has_errors());
  CHECK(diagnose_derivation(text, {}).has_errors());
}

TEST_CASE("slow diagnostics stop when they are asked to") {
  std::string text = "param m = 1 kg, k = 1 N/m\n";
  for (int i = 0; i < 40; ++i) text += "coord x" + std::to_string(i) + " : length\n";
  text += "T = 1/2 m (";
  for (int i = 0; i < 40; ++i) text += (i ? " + x" : "x") + std::to_string(i) + "'^2";
  text += ")\n";
  std::atomic<bool> stop{true};
  CHECK_THROWS_AS(diagnose_derivation(SourceText("a.lag", text), &stop), Interrupted);
}
