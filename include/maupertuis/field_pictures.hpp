#pragma once
#include <maupertuis/field_map.hpp>
#include <maupertuis/field_run.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What of a run of fields is drawn.
struct FieldPictureOptions {
  std::size_t field = 0;  // of those that are varied
  int order = 0;          // 0: u, 1: u'
  bool curves = true;     // of one variable: u(x) at moments
  bool map = true;        // of one variable: the space-time map
  bool degrees = false;   // angles
  bool dimensionless = false;
  std::string title;
  PlotTheme theme = PlotTheme::Light;
  double width = 720;
};

/// A field over space and time as an SVG picture: of one variable u(x) at six moments above the space-time map (x
/// across, t upwards), or one of both alone; in the plane u(x, y) at six moments.
/// Precondition: the run has rows.
std::string field_picture_svg(const FieldEquations& equations, const FieldRunResult& run,
                              const FieldPictureOptions& options);

/// One moment, row `row` of the run, alone: the curve u(x), or the plane; on the scales of the whole run.
std::string field_frame_svg(const FieldEquations& equations, const FieldRunResult& run,
                            const FieldPictureOptions& options, std::size_t row);

/// The shape of a mode (FieldModes::shapes): of one variable the curves of all fields, in the plane a map of the field
/// `options.field`; the largest value is 1. Precondition: the mode has a shape.
std::string field_shape_svg(const FieldEquations& equations, const FieldModes& modes, std::size_t mode,
                            const FieldPictureOptions& options);

/// Fields at rest: of one variable the curve of the field `options.field`, in the plane a map of it.
std::string field_equilibrium_svg(const FieldEquations& equations, const FieldEquilibrium& rest,
                                  const FieldPictureOptions& options);

/// Pictures of one size, each with its style, turned like pages in `seconds`.
std::string turned_pictures_svg(const std::vector<std::string>& frames, double seconds, bool loop);
/// The same on a page that needs nothing else, with controls.
std::string turned_pictures_html(const std::vector<std::string>& frames, double seconds, const std::string& title);

/// The value of a field at the places of row `row`, [upwards ×] places.
std::vector<double> field_values(const FieldRunResult& run, std::size_t row, std::size_t field, int order);

/// The moments that are drawn, rows of the trajectory: the first and the last among them.
std::vector<std::size_t> drawn_moments(const FieldRunResult& run, std::size_t most);

}  // namespace maupertuis
