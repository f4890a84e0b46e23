#pragma once
#include <string>
#include <vector>

namespace maupertuis {

/// A place in the picture, px.
struct Pixel {
  double x = 0, y = 0;
};
using Polyline = std::vector<Pixel>;

/// Cuts a series where it is not finite, and before the points of `breaks` (ascending). A stretch of one point is a
/// polyline of one point.
std::vector<Polyline> split_at_gaps(const Polyline& points, const std::vector<std::size_t>& breaks = {});

/// For lines that run one way in x: of each column of `width` px the first, lowest, highest and last point, in their
/// order. The drawn line covers the same pixels (the M4 aggregation of Jugel et al., VLDB 2014).
Polyline thin_columns(const Polyline& line, double width);

/// Leaves out points that lie within `tolerance` px of the line that remains; ends and turning points stay.
Polyline straighten(const Polyline& line, double tolerance);

/// What has been drawn of one curve, pixel by pixel. A curve that fills an area comes over the same pixels again and
/// again: what would change no pixel is left out, so that a picture has at most a segment a pixel.
class Ink {
 public:
  Ink(double width, double height);
  /// The parts of `line` that darken a pixel that is still clear.
  std::vector<Polyline> draw(const Polyline& line);

 private:
  bool stroke(Pixel from, Pixel to);
  int columns_, rows_;
  std::vector<bool> dark_;  // [rows × columns]
};

/// The value of `d` of an SVG path: hundredths of a px, relative coordinates.
std::string path_data(const std::vector<Polyline>& lines);

}  // namespace maupertuis
