#include "lines_in_parts.hpp"

#include <doctest/doctest.h>

// Wide lines by the meaning of their nodes.

using namespace maupertuis::straight;

TEST_CASE("parts that are alike become lanes with the same results") {
  for (const std::uint32_t parts : {2, 4, 8}) {
    const LineInParts line = line_in_parts(parts, parts, 30);
    const auto wide = widen(line.line, {}, {});
    REQUIRE(wide);
    CHECK(wide->wide == parts);
    CHECK(wide->checks.size() == 2);
    CHECK(2 * wide->size() < line.line.size() * (parts > 2 ? 1 : 2));
    const Evaluated expected = evaluate(line.line, arrays_of_parts()), actual = evaluate(*wide, arrays_of_parts());
    CHECK(actual.margin == doctest::Approx(expected.margin).epsilon(1e-14));
    for (const std::size_t array : {1, 3})
      for (std::size_t i = 0; i < LineInParts::stored; ++i)
        CHECK(actual.arrays[array][i] == doctest::Approx(expected.arrays[array][i]).epsilon(1e-13));
  }
}

TEST_CASE("parts with another sum, and lines without parts, stay as they are") {
  CHECK_FALSE(widen(line_in_parts(1, 4, 30, true).line, {}, {}));
  Builder to;
  to.store(to.sum({{1, to.given(0, 0), to.given(0, 1)}}), 1, 0);
  CHECK_FALSE(widen(to.finish(2, 1, 0), {}, {}));
}

TEST_CASE("parts that wait for each other are no lanes") {
  Builder to;
  Value last = to.given(0, 0);
  for (std::uint32_t part = 1; part <= 2; ++part) {
    to.set_part(part);
    const Value mine = to.sum({{1, to.given(0, part), to.given(0, 3)}, {1, last}});
    to.set_part(0);
    last = to.sum({{1, mine, mine}});
  }
  to.store(last, 1, 0);
  CHECK_FALSE(widen(to.finish(2, 1, 0), {}, {}));
}

TEST_CASE("numbers that two lines alone know are rearranged in both, and those that nobody reads are not stored") {
  const std::uint32_t parts = 4;
  Builder writes, reads;
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t part = 1; part <= parts; ++part) {
      const std::uint32_t place = part * 3 - i - 1;
      writes.set_part(part), reads.set_part(part);
      writes.store(writes.sum({{2, writes.given(0, place)}, {1}}), 1, place);
      if (i < 2) reads.store(reads.sum({{1, reads.given(0, place)}, {1, reads.given(0, 12)}}), 1, place);
    }
  writes.set_part(0);
  writes.store(writes.sum({{3, writes.given(0, 12)}}), 1, 12);
  Places places(13);
  const auto reader = widen(reads.finish(2, 1, 0), {{0, &places}}, {});
  const auto writer = widen(writes.finish(2, 1, 0), {}, {{1, &places}});
  REQUIRE(reader);
  REQUIRE(writer);
  CHECK(writer->stores.size() == 3);
  std::vector<double> x(13);
  std::iota(x.begin(), x.end(), 1.0);
  const std::vector<double> between = evaluate(*writer, {x, std::vector<double>(13, 0.0)}).arrays[1];
  const std::vector<double> y = evaluate(*reader, {between, std::vector<double>(13, 0.0)}).arrays[1];
  for (std::uint32_t part = 1; part <= parts; ++part)
    for (std::uint32_t i = 0; i < 2; ++i) {
      const std::uint32_t place = part * 3 - i - 1;
      CHECK(y[place] == 2 * x[place] + 1 + 3 * x[12]);
    }
}
