#include "report/markup.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}
}  // namespace

TEST_CASE("text is never markup") {
  CHECK(escape_html("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
  CHECK(sentence_html("write `a < b`, not <b>") == "write <code>a &lt; b</code>, not &lt;b&gt;");
  CHECK(sentence_html("p_θ1 of θ12, h_E = T - V; `a_b - θ1`") ==
        "p<sub>θ<sub>1</sub></sub> of θ<sub>12</sub>, h<sub>E</sub> = T − V; <code>a_b - θ1</code>");
  CHECK(sentence_html("an open ` quote") == "an open <code> quote</code>");
}

TEST_CASE("units and numbers as in print") {
  CHECK(unit_html("kg m^2/s^2") == "kg m<sup>2</sup>/s<sup>2</sup>");
  CHECK(unit_html("s^-1") == "s<sup>−1</sup>");
  CHECK(number_html("1.2e-15") == "1.2 × 10<sup>−15</sup>");
  CHECK(number_html("1e+20 m") == "10<sup>20</sup> m");
  CHECK(number_html("-3.5") == "−3.5");
  CHECK(number_html("3.2e-15 J") == "3.2 × 10<sup>−15</sup> J");
  CHECK(number_html("energy") == "energy");
  CHECK(number_html("e") == "e");
  CHECK(number_html("") == "");
}

TEST_CASE("a short equation is one formula, a long sum breaks before its signs") {
  CHECK(display_math("<mi>T</mi>", "<mi>x</mi>") ==
        "<math displaystyle=\"true\"><mrow><mi>T</mi><mo>=</mo><mi>x</mi></mrow></math>");
  const std::string term = "<mrow><mi>a</mi><mo>+</mo><mi>b</mi></mrow>";
  const std::string sum = "<mrow>" + term + "<mo>+</mo><mi>c</mi><mo>−</mo><mi>d</mi><mo>+</mo><mi>e</mi></mrow>";
  const std::string html = display_math(sum, "<mn>0</mn>");
  CHECK(count(html, "<math") == 5);
  CHECK(count(html, "<wbr>") == 4);
  CHECK(html.find("<mrow>" + term + "</mrow></math>") != std::string::npos);  // signs inside a bracket do not break
  CHECK(html.find("<mrow><mo form=\"infix\">−</mo><mi>d</mi></mrow>") != std::string::npos);
  CHECK(html.find("<mrow><mo form=\"infix\">=</mo><mn>0</mn></mrow>") != std::string::npos);
  CHECK(inline_math("") == "");
}

TEST_CASE("the first sign of a sum belongs to its first term") {
  const std::string html = display_math("<mrow><mo>−</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>+</mo><mi>c</mi></mrow>", "<mn>0</mn>");
  CHECK(count(html, "<math") == 1);
  const std::string longer = display_math("<mrow><mo>−</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>+</mo><mi>c</mi><mo>+</mo><mi>d</mi></mrow>", "<mn>0</mn>");
  CHECK(longer.find("<mrow><mo>−</mo><mi>a</mi></mrow>") != std::string::npos);
}

TEST_CASE("the model text: statement words and comments are marked") {
  CHECK(model_html("param m = 1 kg # a < b\n  x # \"y\n") ==
        "<span class=\"word\">param</span> m = 1 kg <span class=\"comment\"># a &lt; b</span>\n"
        "  x <span class=\"comment\"># &quot;y</span>\n");
  CHECK(model_html("source \"# 1\" # c") ==
        "<span class=\"word\">source</span> &quot;# 1&quot; <span class=\"comment\"># c</span>\n");
  CHECK(model_html("parameters = 1").find("word") == std::string::npos);
}
