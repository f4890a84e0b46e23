#include "../processors.hpp"
#include "lines_in_parts.hpp"

#include "kernel/straight_line/compile.hpp"

#include <doctest/doctest.h>

// Machine code of wide lines against the meaning of the lines that they come from.

using namespace maupertuis::straight;

TEST_CASE("wide lines, short ones and ones that are cut into functions, for this processor and lesser ones") {
  for (const std::string& processor : levels_here({"", "x86-64", "x86-64-v3"}))
    for (const std::uint32_t parts : {2, 4, 8})
      for (const int length : {3, 200}) {
        CAPTURE(processor);
        CAPTURE(parts);
        CAPTURE(length);
        const LineInParts line = line_in_parts(parts, parts, length);
        const auto wide = widen(line.line, {}, {});
        REQUIRE(wide);
        const auto [code, report] = compile({*wide}, {.cache = false, .processor = processor});
        REQUIRE_MESSAGE(code, report.trouble);
        auto arrays = arrays_of_parts();
        const Evaluated expected = evaluate(line.line, arrays);
        std::vector<double> scratch(scratch_size(*wide));
        code(0, arrays[0].data(), arrays[1].data(), arrays[2].data(), arrays[3].data(), scratch.data());
        for (const std::size_t array : {1, 3})
          for (std::size_t i = 0; i < LineInParts::stored; ++i)
            CHECK(arrays[array][i] == doctest::Approx(expected.arrays[array][i]).epsilon(1e-9).scale(1));
        CHECK(scratch[0] == doctest::Approx(expected.margin).epsilon(1e-9));
        CHECK(sound(scratch.data()) == (expected.margin > 0));
      }
}
