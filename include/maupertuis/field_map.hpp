#pragma once
#include <maupertuis/plot.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// A quantity over a rectangle in colours: a space-time map (x across, t upwards), or a plane at several moments.
struct FieldMap {
  struct Sheet {
    std::string caption;         // above it: "t = 0.2 s"; empty: none
    std::vector<double> values;  // [y × x]
  };
  std::string title;  // empty: none
  std::string x_name, x_unit, y_name, y_unit, value_name, value_unit;
  std::vector<double> x, y;  // ascending, at least two of each
  std::vector<Sheet> sheets;
  /// Rows (indices into y) that are drawn as curves over x in a panel above a single sheet, with their names.
  struct Line {
    std::size_t row = 0;
    std::string name;
  };
  std::vector<Line> lines;
  std::vector<double> include = {};  // values that the colours reach whatever the sheets hold
  bool equal_scales = false;         // one unit of x is as long as one of y
  PlotTheme theme = PlotTheme::Light;
  double width = 720;  // px, at least 240
};

/// One SVG picture. Colours go in steps that look alike from blue over white to red where values have both signs, else
/// from pale to dark; a bar tells the values. Bands between levels are outlines, so that the picture stays sharp at any
/// size and small. Values that are not finite stay empty.
std::string field_map_svg(const FieldMap& map);

/// The colours of such a picture: of −1 .. 1 where `two_signs`, else of 0 .. 1; "#rrggbb".
std::string field_colour(double value, bool two_signs);

}  // namespace maupertuis
