#include <maupertuis/diagnostic.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace maupertuis;

TEST_CASE("the caret stands under the exact span, counted in characters") {
  const SourceText source("a.lag", "system p\nT = ½ m l² θ̇ + sqr(θ)\n");
  const auto begin = static_cast<std::uint32_t>(source.text().find("sqr"));
  Diagnostics diagnostics;
  diagnostics.error("E0203", Span{begin, begin + 3}, "there is no function `sqr`", "A reason.", "Write sqrt.");
  const std::string text = render(diagnostics, source);
  CHECK(text.find("a.lag:2:") != std::string::npos);
  const std::size_t caret = text.find("^^^\n");
  REQUIRE(caret != std::string::npos);
  CHECK(text.find("A reason.") != std::string::npos);
  CHECK(text.find("Help: Write sqrt.") != std::string::npos);
}

TEST_CASE("a very long line is cut to a window around the caret") {
  const SourceText source("a.lag", std::string(500'000, 'x') + "!" + std::string(500'000, 'y'));
  Diagnostics diagnostics;
  diagnostics.error("E0102", Span{500'000, 500'001}, "a stray sign");
  const std::string text = render(diagnostics, source);
  CHECK(text.size() < 1000);
  CHECK(text.find('!') != std::string::npos);
}

TEST_CASE("a span beyond the text does not break the rendering") {
  const SourceText source("a.lag", "");
  Diagnostics diagnostics;
  diagnostics.error("E0101", Span{0, 10}, "an empty model");
  CHECK(render(diagnostics, source).find("an empty model") != std::string::npos);
}

TEST_CASE("did-you-mean finds the near and leaves the far") {
  const std::array<std::string, 4> names{"theta", "phi", "length", "θ1"};
  CHECK(did_you_mean("thtea", names) == "theta");
  CHECK(did_you_mean("lenght", names) == "length");
  CHECK(did_you_mean("zzz", names).empty());
  CHECK(did_you_mean("θ2", names) == "θ1");
}

TEST_CASE("lines and columns") {
  const SourceText source("a.lag", "ab\r\nθx\n");
  CHECK(source.line(1) == "ab");
  CHECK(source.line(2) == "θx");
  CHECK(source.line(9).empty());
  CHECK(source.locate(4).line == 2);
  CHECK(source.locate(6).column == 2);
}
