#include "report/mathml.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {
std::string set(const std::string& fragment) {
  MathRow row = parse_mathml(fragment);
  typeset(row);
  return to_string(row);
}
}  // namespace

TEST_CASE("MathML comes back as it was") {
  for (const char* fragment : {"<mi>x</mi><mo>+</mo><mn>1</mn>", "<mrow><mover accent=\"true\"><mi>θ</mi><mo>&#x02D9;</mo></mover></mrow>", ""})
    CHECK(to_string(parse_mathml(fragment)) == fragment);
  CHECK(to_string(parse_mathml("<mspace width=\"1em\"/>")) == "<mspace width=\"1em\"></mspace>");
}

TEST_CASE("what is no MathML is shown as text") {
  CHECK(to_string(parse_mathml("a < b")) == "<mtext>a &lt; b</mtext>");
  CHECK(to_string(parse_mathml("<mi>x")) == "<mtext>&lt;mi&gt;x</mtext>");
  CHECK(to_string(parse_mathml("<mi>x</mo>")) == "<mtext>&lt;mi&gt;x&lt;/mo&gt;</mtext>");
}

TEST_CASE("an exponent stands above the index") {
  CHECK(set("<msup><msub><mi>θ</mi><mn>1</mn></msub><mn>2</mn></msup>") == "<msubsup><mi>θ</mi><mn>1</mn><mn>2</mn></msubsup>");
  CHECK(set("<msup><mi>x</mi><mn>2</mn></msup>") == "<msup><mi>x</mi><mn>2</mn></msup>");
}

TEST_CASE("brackets of plain height do not stretch, tall ones do") {
  CHECK(set("<mrow><mo>(</mo><mi>x</mi><mo>)</mo></mrow>") ==
        "<mrow><mo stretchy=\"false\">(</mo><mi>x</mi><mo stretchy=\"false\">)</mo></mrow>");
  const std::string tall = "<mrow><mo>(</mo><mfrac><mi>x</mi><mi>y</mi></mfrac><mo>)</mo></mrow>";
  CHECK(set(tall) == tall);
}

TEST_CASE("thin spaces stand around functions") {
  const std::string thin = "<mspace width=\"0.17em\"></mspace>", apply = "<mo>&#x2061;</mo>", times = "<mo>&#x2062;</mo>";
  const std::string bare = "<mrow><mi>sin</mi>" + apply + "<mi>θ</mi></mrow>";
  const std::string set_bare = "<mrow><mi>sin</mi>" + apply + thin + "<mi>θ</mi></mrow>";
  CHECK(set(bare) == set_bare);
  CHECK(set("<mrow><mi>l</mi>" + times + bare + times + "<mi>x</mi></mrow>") ==
        "<mrow><mi>l</mi>" + times + thin + set_bare + times + thin + "<mi>x</mi></mrow>");
  CHECK(set("<mrow><mi>l</mi>" + times + "<mi>x</mi></mrow>") == "<mrow><mi>l</mi>" + times + "<mi>x</mi></mrow>");
}

TEST_CASE("a sum falls into its terms") {
  const auto terms = signed_terms(parse_mathml("<mrow><mrow><mo>−</mo><mi>a</mi><mo>+</mo><mi>b</mi></mrow></mrow>"));
  REQUIRE(terms.size() == 2);
  CHECK(to_string(terms[0]) == "<mo>−</mo><mi>a</mi>");
  CHECK(to_string(terms[1]) == "<mo form=\"infix\">+</mo><mi>b</mi>");
  CHECK(signed_terms({}).empty());
}
