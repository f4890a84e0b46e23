#pragma once
#include <maupertuis/trajectory.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace maupertuis {

/// The colours of a picture. Light and Dark carry their own background, so that a picture reads the same on any page;
/// Page leaves colours to the page that it is set in (see `plot_page_style`).
enum class PlotTheme { Light, Dark, Page };

/// Auto: one metre is as long across as upwards where both axes are lengths; elsewhere the axes fill the picture.
enum class PlotAspect { Auto, Free, Equal };

/// An instant with a name, in pictures over the time: a thin line through all panels.
struct PlotMark {
  double t = 0;
  std::string name;     // above the panels, where there is room for it
  bool dashed = false;  // an event of the model; else something that happens to the motion
};

/// What something does in the course of the time, in colours: a bar below the panels.
struct PlotStrip {
  enum class State { Open, Closed, Stick, Forward, Backward };
  struct Part {
    double from = 0, to = 0;
    State state = State::Open;
  };
  std::string name;
  std::vector<Part> parts;
};

struct PlotOptions {
  std::vector<std::string>
      columns;           // what is drawn; empty: every column. One panel for each unit, in order of appearance
  std::string against;   // the horizontal axis; empty: the time. A column gives a phase portrait
  std::string title;     // empty: none
  bool degrees = false;  // rad, rad/s, … are shown in degrees
  PlotAspect aspect = PlotAspect::Auto;
  PlotTheme theme = PlotTheme::Light;
  double width = 720;       // px, at least 240
  double panel_height = 0;  // px of one panel's frame; 0: chosen from the width and the number of panels
  std::string dots_by;      // dots instead of lines: one colour for each value of this column; empty: lines
  std::vector<std::pair<double, double>>
      outline;                         // a closed line around what is drawn, in the units of a single panel's axes
  std::vector<PlotMark> marks = {};    // over the time alone
  std::vector<PlotStrip> strips = {};  // the same; a legend names the states that occur
};

/// The sentence for the user where `options` do not fit `trajectory` (a column that is not there, with a suggestion);
/// empty where they do.
std::string plot_problem(const Trajectory& trajectory, const PlotOptions& options);

/// One SVG picture: series over time or phase portraits, in stacked panels that share the horizontal axis.
/// Ticks at 1, 2, 5 times a power of ten; a common power, and a common offset where digits would repeat, go to the axis
/// label. A value that is not finite is a gap. Lines are thinned to what a pixel shows: the size of the picture is
/// bounded, whatever the number of rows and marks. Never fails on numbers: constant, empty, tiny and huge series give a
/// picture. Precondition: plot_problem(trajectory, options) is empty.
std::string plot_svg(const Trajectory& trajectory, const PlotOptions& options = {});

/// The style sheet for pictures of PlotTheme::Page. They take their colours from the custom properties
/// --paper, --ink, --muted, --grid and --series-1 … --series-7.
std::string plot_page_style();
/// Those seven colours for light (or dark) paper; told apart by readers of any colour vision.
const std::vector<std::string_view>& plot_palette(bool dark);

/// A name as it is set in print: θ1' is a θ with one dot and the index 1, B.x is an x with the index B.
/// Words of several letters (energy) are set upright.
struct NameParts {
  std::string base;   // "θ", "x", "energy"
  std::string index;  // "1", "B", ""
  int dots = 0;       // time derivatives
  bool upright = false;
};
NameParts name_parts(std::string_view name);

}  // namespace maupertuis
