// How running sums lie in vectors: whole, and in the lanes of what they add.
#include "rods.hpp"

#include <algorithm>

namespace {

bool is_scan(const packed::Pack& pack) {
  return pack.kind == packed::Pack::Scan || pack.kind == packed::Pack::ScanDown;
}

/// The vectors that running sums read begin where vectors do.
void check_lanes(const packed::PackedProgram& p) {
  for (const packed::Pack& pack : p.packs) {
    if (!is_scan(pack)) continue;
    CHECK(pack.out % packed::lanes == 0);
    for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
      CHECK(p.columns[c].kind != packed::Column::Gather);
      if (p.columns[c].kind == packed::Column::Contiguous) CHECK(p.columns[c].source % packed::lanes == 0);
    }
  }
}

std::size_t count_beginnings(const packed::PackedProgram& p) {
  return static_cast<std::size_t>(std::count_if(
      p.packs.begin(), p.packs.end(), [](const auto& pack) { return is_scan(pack) && pack.carry == no_slot; }));
}

}  // namespace

TEST_CASE("chains of points: positions and forces are running sums in the lanes of their links") {
  for (const int links : {17, 20, 24, 32, 100}) {
    CAPTURE(links);
    const Rods rods(links, chain);
    const packed::PackedProgram p = packed::pack(build_kernel(rods.source).program());
    check_lanes(p);
    CHECK(count_beginnings(p) == 4);  // x, y, and what they carry
    // Of the products of a residual and a sine only the first and the last links read forces from elsewhere.
    const auto copied = std::count_if(p.blocks.begin(), p.blocks.end(),
                                      [](const packed::Block& b) { return !b.direct && !b.weighted; });
    CHECK(copied <= 4);
    for (const packed::Pack& pack : p.packs) CHECK(pack.kind != packed::Pack::Scalar);
  }
}

TEST_CASE("chains of rods: the joints are running sums, whatever else begins at a joint") {
  Context context;
  KernelSource source;
  Expr x = context.number(0), y = x, lagrangian = x;
  for (int i = 0; i < 24; ++i) {
    const Expr angle = context.symbol("a" + std::to_string(i), Role::Coordinate);
    source.coordinates.push_back(angle);
    const Expr across = x + sin(angle) * Rational(2, 5), down = y - cos(angle) * Rational(2, 5);
    x = x + sin(angle) * Rational(4, 5), y = y - cos(angle) * Rational(4, 5);
    lagrangian = lagrangian + pow(context.time_derivative(across), 2) + pow(context.time_derivative(down), 2) +
                 pow(context.time_derivative(angle), 2) - down;
  }
  source.residual = variational_residual(lagrangian, source.coordinates);
  CHECK(count_beginnings(packed::pack(build_kernel(source).program())) >= 4);
}

TEST_CASE("chains that are solved in parts: what belongs to them stands in the lanes of the parts") {
  for (const int links : {64, 100, 131}) {
    CAPTURE(links);
    const Rods rods(links, chain);
    const Program program = build_kernel(rods.source).program();
    const sparse::Strip strip = sparse::strip_of(program);
    REQUIRE(strip.parts.size() == packed::lanes);
    CHECK(strip.whole + 2 * packed::lanes > static_cast<std::size_t>(links));
    std::vector<std::uint32_t> sorted = strip.order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < sorted.size(); ++i) REQUIRE(sorted[i] == i);
    for (std::size_t lane = 0; lane < packed::lanes; ++lane)
      for (std::size_t turn = 0; turn < strip.parts[lane].size(); ++turn)
        CHECK(strip.parts[lane][turn] == strip.order[packed::lanes * turn + lane]);

    const packed::PackedProgram p = packed::pack(program, {strip.order, strip.whole});
    std::size_t joins = 0;
    for (const packed::Pack& pack : p.packs) {
      joins += pack.kind == packed::Pack::Join || pack.kind == packed::Pack::JoinDown;
      if (pack.kind == packed::Pack::Join || pack.kind == packed::Pack::JoinDown)
        CHECK(pack.strands * packed::lanes == strip.whole);
      if (pack.kind != packed::Pack::Strand) continue;
      for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
        const packed::Column& column = p.columns[c];
        const bool is_vector = column.kind == packed::Column::Contiguous && column.source % packed::lanes == 0;
        CHECK((is_vector || column.source == p.program.one));
      }
    }
    CHECK(joins == 4);  // x, y, and what they carry
    // Forces are read where they stand but for those at the ends, coordinates are copied.
    CHECK(std::count_if(p.blocks.begin(), p.blocks.end(),
                        [](const packed::Block& b) { return !b.direct && !b.weighted; }) <= 4);
    CHECK(std::count_if(p.blocks.begin(), p.blocks.end(), [&](const packed::Block& b) {
            return p.copies_coordinates(b);
          }) >= static_cast<std::ptrdiff_t>(strip.whole / packed::lanes));
  }
}
