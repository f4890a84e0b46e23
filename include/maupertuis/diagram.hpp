#pragma once
#include <maupertuis/plot.hpp>

#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

/// Curves and points in one frame, for what is no time series: bifurcation diagrams, root loci, mode shapes.
struct Diagram {
  struct Curve {
    std::vector<double> x, y;  // of equal length; a value that is not finite is a gap
    std::size_t series = 0;    // which colour of the palette
    bool dashed = false;
    bool dots = false;  // a dot at each point instead of a line
  };
  struct Mark {  // a single place with a name, a ring
    double x = 0, y = 0;
    std::string label;
  };
  struct Key {  // a line of the legend
    std::string text;
    std::size_t series = 0;
    bool dashed = false, dots = false;
  };
  std::string title;  // empty: none
  std::string x_name, x_unit, y_name, y_unit;
  bool degrees_x = false, degrees_y = false;  // values are in rad, shown in degrees
  std::vector<Curve> curves;
  std::vector<Mark> marks;
  std::vector<Key> legend;
  std::vector<std::pair<double, std::string>> x_labels;  // names at places of the horizontal axis instead of numbers
  std::vector<double> include_y = {};  // places that the vertical axis reaches whatever the curves are
  bool zero_line = false;              // the axes x = 0 and y = 0 are drawn where they are inside
  PlotTheme theme = PlotTheme::Light;
  double width = 720;       // px, at least 240
  double frame_height = 0;  // px; 0: chosen from the width
};

/// One SVG picture; axes, ticks and colours as in `plot_svg`. Never fails on numbers.
std::string diagram_svg(const Diagram& diagram);

}  // namespace maupertuis
