// Letters that look alike, and characters that are not shown.
#include <maupertuis/look_alikes.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("letters of three alphabets that look the same") {
  CHECK(latin_look("mass") == "mass");
  CHECK(latin_look("mаss") == "mass");                    // а of Cyrillic
  CHECK(latin_look("ΑΒΕ") == "ABE");                      // Greek
  CHECK(latin_look("ρ_0 ν α ω Δ θ") == "ρ_0 ν α ω Δ θ");  // told apart by everyone who reads formulas
  CHECK(foreign_letter("mass").empty());
  CHECK(foreign_letter("масса").empty());  // one alphabet throughout
  CHECK(foreign_letter("mаss") == "`а` (U+0430) is a Cyrillic letter");
  CHECK(foreign_letter("xΑ") == "`Α` (U+0391) is a Greek letter");
  CHECK(foreign_letter("Δx").empty());
}

TEST_CASE("what a terminal would act on is spelled out") {
  CHECK(visible("θ = 1 rad\n\tend") == "θ = 1 rad\n\tend");
  CHECK(visible("a\x1b[31mb") == "a\\x1b[31mb");
  CHECK(visible("a\rb\x7f") == "a\\x0db\\x7f");
  CHECK(visible("a\xc2\x9b"
                "31mb") == "a\\x9b31mb");  // the control sequence introducer of ISO 6429 as one character
  CHECK(visible("a\u202e"
                "b\u2066") == "a\\u202eb\\u2066");
  CHECK(visible("a\xff"
                "b\xc3") == "a\\xffb\\xc3");  // bytes that are no UTF-8
}
