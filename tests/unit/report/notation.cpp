#include "report/notation.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("left sides of derivation steps") {
  CHECK(left_side_mathml("T") == "<mi>T</mi>");
  CHECK(left_side_mathml("∂L/∂θ1'") ==
        "<mfrac><mrow><mo>∂</mo><mi>L</mi></mrow><mrow><mo>∂</mo><msub><mover accent=\"true\"><mi>θ</mi><mo>&#x02D9;</mo>"
        "</mover><mn>1</mn></msub></mrow></mfrac>");
  CHECK(left_side_mathml("d/dt ∂L/∂x").find("<mfrac><mi>d</mi><mrow><mi>d</mi><mi>t</mi></mrow></mfrac><mfrac>") == 0);
  CHECK(left_side_mathml("A.x") == "<msub><mi>x</mi><mi>A</mi></msub>");
  CHECK(left_side_mathml("v_A^2") == "<msup><msub><mi>v</mi><mi>A</mi></msub><mn>2</mn></msup>");
  CHECK(left_side_mathml("Q_θ1") == "<msub><mi>Q</mi><msub><mi>θ</mi><mn>1</mn></msub></msub>");
  CHECK(left_side_mathml("T(particle A)") == "<mrow><mi>T</mi><mspace width=\"0.3em\"/><mtext>(particle A)</mtext></mrow>");
  CHECK(left_side_mathml("∂L/∂y'", true) ==
        "<mfrac><mrow><mo>∂</mo><mi>L</mi></mrow><mrow><mo>∂</mo><msup><mi>y</mi><mo>&#x2032;</mo></msup></mrow></"
        "mfrac>");
  CHECK(left_side_mathml("p_y'", true).find("&#x2032;") != std::string::npos);
  CHECK(left_side_mathml("p_y'", true).find("&#x02D9;") == std::string::npos);
  CHECK(left_side_mathml("x<y") == "<mi>x&lt;y</mi>");
  CHECK(left_side_mathml("") == "");
  CHECK(left_side_mathml("0") == "<mn>0</mn>");
}

TEST_CASE("units read back as they were written") {
  CHECK(unit_factor("") == 1);
  CHECK(unit_factor("cm") == doctest::Approx(0.01).epsilon(1e-15));
  CHECK(unit_factor("N s/m") == 1);
  CHECK(unit_factor("g cm^2") == doctest::Approx(1e-7).epsilon(1e-14));
  CHECK(unit_factor("J/(kg K)") == 1);
  CHECK(unit_factor("1/ms") == doctest::Approx(1000));
  CHECK(unit_factor("ms^-1") == doctest::Approx(1000));
  CHECK(unit_factor("deg") == doctest::Approx(0.017453292519943295));
  CHECK(unit_factor("nonsense") == 0);
  CHECK(unit_factor("kg (m") == 0);
}

TEST_CASE("numbers for a reader") {
  CHECK(short_number(0.6) == "0.6");
  CHECK(short_number(-0.0) == "0");
  CHECK(short_number(3.21e-15, 2) == "3.2e-15");
  CHECK(quantity(2, "rad") == "2 rad");
  CHECK(quantity(2, "1") == "2");
}
