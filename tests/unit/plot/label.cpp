#include "plot/label.hpp"

#include <maupertuis/plot.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {
std::string parts(std::string_view name) {
  const NameParts p = name_parts(name);
  return p.base + "|" + p.index + "|" + std::to_string(p.dots) + (p.upright ? "|upright" : "");
}
}  // namespace

TEST_CASE("names split as in print") {
  CHECK(parts("θ") == "θ||0");
  CHECK(parts("θ1") == "θ|1|0");
  CHECK(parts("θ1''") == "θ|1|2");
  CHECK(parts("B.x'") == "x|B|1");
  CHECK(parts("x_cart") == "x|cart|0");
  CHECK(parts("θ1_max") == "θ|1,max|0");
  CHECK(parts("Ip") == "Ip||0|upright");
  CHECK(parts("q12") == "q|12|0");
  CHECK(parts("energy") == "energy||0|upright");
  CHECK(parts("") == "||0");
}

TEST_CASE("labels carry italics, an index, dots and exponents, and escape the rest") {
  const std::string svg = to_svg(name_text("θ1'"), 10);
  CHECK(svg.find("<tspan font-style=\"italic\">θ</tspan>") == 0);
  CHECK(svg.find(">.</tspan>") != std::string::npos);
  CHECK(svg.find("font-size=\"7.2\" dy=\"2.2\">1</tspan>") != std::string::npos);
  CHECK(plain(name_text("θ1''")) == "θ''1");
  CHECK(plain(unit_text("kg m^2/s^-1")) == "kg m^2/s^−1");
  CHECK(to_svg({{"a<b & \"c\""}}, 10) == "a&lt;b &amp; &quot;c&quot;");
  CHECK(plain(names_text({"a", "b", "c", "d", "e"})) == "a … e");
}

TEST_CASE("labels of formulas keep their numbers, and each name its own index") {
  for (const auto& [written, printed] : {std::pair{"0.5 θ", "0.5 θ"},
                                         {"1.25 θ^2", "1.25 θ^2"},
                                         {"exp(-0.1 θ)", "exp(−0.1 θ)"},
                                         {"m x'^2", "m x'^2"},
                                         {"θ1 - 0.5 θ2", "θ1 − 0.5 θ2"},
                                         {"bob.x^2/bob.y", "xbob^2/ybob"},
                                         {"1e-3 x^-2", "1e−3 x^−2"},
                                         {"2*x^(1/2)", "2·x^1/2"},
                                         {"reaction(rod)", "reaction(rod)"},
                                         {"energy drift", "energy drift"},
                                         {"x^", "x^"},
                                         {"1/(t - 5 [s])", "1/(t − 5 [s])"},
                                         {"x [m/s^2", "x [m/s^2"},
                                         {"x^(2", "x^2"}})
    CHECK(plain(name_text(written)) == printed);
  CHECK(to_svg(name_text("5 [s]"), 10).find("italic") == std::string::npos);  // no variable
}
