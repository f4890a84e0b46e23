#pragma once
#include "plot/polyline.hpp"

#include <vector>

namespace maupertuis {

/// Values at the corners of a grid, whose lines have these places in px.
struct Grid {
  std::vector<double> x, y;
  const std::vector<double>& values;  // [y × x]
};

/// The border of the region where the values are at least `level`, linear between corners along the sides of a cell, as
/// closed lines. Cells with a corner that is not finite belong to no region.
std::vector<Polyline> region_above(const Grid& grid, double level);

/// The value of `d` of an SVG path of closed lines, tenths of a px.
std::string closed_path(const std::vector<Polyline>& loops);

}  // namespace maupertuis
