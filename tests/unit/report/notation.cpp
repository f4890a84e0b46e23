#include "report/notation.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("numbers for a reader") {
  CHECK(short_number(0.6) == "0.6");
  CHECK(short_number(-0.0) == "0");
  CHECK(short_number(3.21e-15, 2) == "3.2e-15");
  CHECK(quantity(2, "rad") == "2 rad");
  CHECK(quantity(2, "1") == "2");
}
