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

TEST_CASE("names of files keep their underscores in prose") {
  CHECK(sentence_html("libmaup_machine_code_llvm.so of x_longname") ==
        "libmaup_machine_code_llvm.so of x<sub>longname</sub>");
}

TEST_CASE("text is never markup") {
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
  CHECK(number_html("3.98e+14 m^3/s^2") == "3.98 × 10<sup>14</sup> m<sup>3</sup>/s<sup>2</sup>");
  CHECK(number_html("2 m^2") == "2 m<sup>2</sup>");
  CHECK(number_html("-3.5") == "−3.5");
  CHECK(number_html("3.2e-15 J") == "3.2 × 10<sup>−15</sup> J");
  CHECK(number_html("energy") == "energy");
  CHECK(number_html("e") == "e");
  CHECK(number_html("") == "");
}

TEST_CASE("a short equation is one formula, a long sum breaks before its signs") {
  const Layout x = layouts::name("x"), ten = layouts::name("abcdefghij"), zero = layouts::number("0");
  CHECK(display_math(layouts::name("T"), x) ==
        "<div class=\"formula\"><math displaystyle=\"true\"><mrow><mrow><mi>T</mi><mo "
        "form=\"infix\">=</mo><mi>x</mi></mrow></mrow></math></div>");
  const Layout term = layouts::product({ten, layouts::sum({ten, ten})});
  Layout sum = layouts::sum({term, ten, ten, ten});
  sum.minus[2] = true;
  const std::string html = display_math(sum, zero);
  CHECK(count(html, "<math") == 4);
  CHECK(count(html, "<wbr>") == 3);
  CHECK(count(html, "<mi>abcdefghij</mi><mo>+</mo><mi>abcdefghij</mi>") == 1);  // signs inside a term do not break
  CHECK(html.find("<mrow><mo form=\"infix\">&#x2212;</mo><mi>abcdefghij</mi></mrow>") != std::string::npos);
  CHECK(html.find("<mi>abcdefghij</mi><mo form=\"infix\">=</mo><mn>0</mn></mrow>") !=
        std::string::npos);  // = 0 stays with the last term
  CHECK(inline_math({}) == "");
}

TEST_CASE("a bracket longer than a line breaks inside") {
  const Layout long_name = layouts::name("abcdefghijklmnopqrst");
  const Layout bracket = layouts::sum({long_name, long_name, long_name, long_name, long_name});
  const std::string html =
      display_math(layouts::product({layouts::name("m"), bracket, layouts::name("x")}), layouts::number("0"));
  CHECK(count(html, "<math") == 5);
  CHECK(count(html, ">(</mo>") == 1);
  CHECK(count(html, ">)</mo>") == 1);
  CHECK(html.find("class=\"formula long\"") != std::string::npos);
}

TEST_CASE("the first sign of a sum belongs to its first term") {
  const Layout ten = layouts::name("abcdefghij");
  Layout sum = layouts::sum({ten, ten, ten, ten});
  sum.minus[0] = true;
  const std::string html = display_math(sum, layouts::number("0"));
  CHECK(count(html, "<math") == 4);
  CHECK(html.find("<mrow><mo form=\"prefix\">&#x2212;</mo><mi>abcdefghij</mi></mrow>") != std::string::npos);
}

TEST_CASE("the model text: statement words and comments are marked") {
  CHECK(model_html("param m = 1 kg # a < b\n  x # \"y\n") ==
        "<span class=\"word\">param</span> m = 1 kg <span class=\"comment\"># a &lt; b</span>\n"
        "  x <span class=\"comment\"># &quot;y</span>\n");
  CHECK(model_html("source \"# 1\" # c") ==
        "<span class=\"word\">source</span> &quot;# 1&quot; <span class=\"comment\"># c</span>\n");
  CHECK(model_html("parameters = 1").find("word") == std::string::npos);
}
