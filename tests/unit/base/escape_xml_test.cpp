// What stands in elements and attributes of XML.
#include <maupertuis/escape_xml.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("signs that XML has for itself are written by their names") {
  CHECK(escape_xml("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
  CHECK(escape_xml("θ₁ − φ'") == "θ₁ − φ'");
  CHECK(escape_xml("") == "");
}

TEST_CASE("what XML cannot hold is replaced, spaces and ends of lines are not") {
  using namespace std::string_view_literals;
  CHECK(escape_xml("a\0b\x1b[1m"sv) == "a\uFFFDb\uFFFD[1m");
  CHECK(escape_xml("a\tb\r\nc") == "a\tb\r\nc");
}
