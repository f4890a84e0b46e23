#pragma once
#include "plot/axis.hpp"
#include "plot/label.hpp"

#include <maupertuis/plot.hpp>

#include <string>
#include <vector>

/// What a picture consists of, and how its parts are drawn. All lengths in px.
namespace maupertuis {

inline constexpr double tick_size = 12, label_size = 14, title_size = 16, line_height = 20;

// One quantity to draw, from a column or from the times.
struct Series {
  std::string name, unit;
  double factor = 1;  // shown = factor · value
  std::size_t column = 0;
  bool is_time = false;

  double at(const Trajectory& trajectory, std::size_t row) const {
    return factor * (is_time ? trajectory.times[row] : trajectory.at(row, column));
  }
};

struct Panel {
  std::string unit;
  std::vector<Series> series;
  double top = 0, height = 0;  // of the frame
  double legend_height = 0;
};

struct Figure {
  const Trajectory& trajectory;
  const PlotOptions& options;
  Series horizontal;
  std::vector<Panel> panels;
  double left = 0, right = 0, bottom = 0, height = 0;
  double marks_top = 0;       // of the names of marks
  std::size_t mark_rows = 1;  // lines that these take
  double strips_top = 0;      // of the bars below the panels
  double frame_width() const { return right - left; }
};

/// "θ₁, θ₂ (10⁻³ rad from 2 rad)"
RichText axis_text(const std::vector<std::string>& names, const std::string& unit, const Axis& axis);
std::string text_element(double x, double y, std::string_view anchor, double size, const RichText& text,
                         std::string_view more = {});

/// Height of the lines above the frame that name the curves; 0 for a single curve, which its axis names.
double legend_height(const Panel& panel, double width);

/// Grid, axes, curves, labels and legend of one panel; the lowest one labels the ticks of the shared axis, below the
/// bars.
std::string draw_panel(const Figure& figure, const Panel& panel, const Axis& across, const Axis& up, bool lowest);

/// Room for the names of marks above the panels, for the bars below them, and for their legend below the axis.
double names_of_marks_height(const Figure& figure);
/// One, or two where different names would stand on each other. Precondition: the figure has its left and right.
std::size_t rows_of_names(const Figure& figure, const Axis& across);
double strips_height(const Figure& figure);
double strips_legend_height(const Figure& figure);
double widest_strip_name(const Figure& figure);
/// Lines through the panels, below the curves; then names and bars.
std::string draw_marks(const Figure& figure, const Axis& across);
std::string draw_names_and_strips(const Figure& figure, const Axis& across);

}  // namespace maupertuis
