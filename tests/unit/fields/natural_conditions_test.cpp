// Natural conditions as they hold at each end: with the forces there, and not where the field is held.
#include <maupertuis/fields.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/study.hpp>
#include <maupertuis/transform.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace maupertuis;

TEST_CASE("natural conditions are told with the forces that act at an end, or that a given slope asks for") {
  const auto natural_of = [](const std::string& text) {
    Study study(SourceText("field.lag", "dimensionless\nparam F = 2, EA = 5\n" + text));
    const FieldEquations* equations = study.field_equations();
    REQUIRE(equations);
    std::vector<std::string> out;
    for (const NaturalAtEnds& n : natural_at_ends(*equations))
      out.push_back(
          (n.first ? "first " : "") + std::string(n.last ? "last " : "") +
          to_plain(field_layout(equations->system(), lay_out(readable(n.value, equations->order), equations->order))));
    return out;
  };
  const std::string bar = "field u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 EA u_x^2\n",
                    beam = "field u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 u_xx^2\n";
  using Lines = std::vector<std::string>;
  CHECK(natural_of(bar) == Lines{"first last -EA u_x"});
  CHECK(natural_of(bar + "boundary left : u = 0\nforce u(1) = F\n") == Lines{"last F - EA u_x"});
  CHECK(natural_of(bar + "boundary right : u = 0\nforce u(0) = F\n") == Lines{"first -F - EA u_x"});
  CHECK(natural_of(bar + "boundary left : u = 0\nboundary right : u_x = F/EA\n") == Lines{"last F - EA u_x"});
  CHECK(natural_of(bar + "boundary u_x = 0\n") == Lines{"first last -EA u_x"});
  CHECK(natural_of(beam + "boundary left : u = 0, u_x = 0\nforce u(1) = 2\nforce u_x(1) = 3\n") ==
        Lines{"last 2 + u_xxx", "last 3 - u_xx"});
  CHECK(natural_of(beam + "boundary left : u_x = 0\nboundary right : u = 0\n") == Lines{"first u_xxx", "last u_xx"});
}
