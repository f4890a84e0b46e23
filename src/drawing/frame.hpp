#pragma once
#include <maupertuis/drawing.hpp>

#include <array>

namespace maupertuis::drawing {

/// A shaft and a head, in px; nothing where it is too short to be one.
std::vector<FrameItem> arrow(std::array<double, 2> from, std::array<double, 2> to, FrameColour colour, double weight,
                             double unit);
/// The ink of an arrow, by what acts.
std::size_t series_of(const Drawing::Element& arrow);
FrameItem words(const NameParts& text, double x, double y, char align, FrameColour colour);
/// Without the points that are nearer than `step` px to the last one kept.
std::vector<double> thinned(const std::vector<double>& line, double step);
/// Two unit vectors across `e`, which turn little when it does.
std::array<double, 6> sides_of(const std::array<double, 3>& e);

/// Scale bar, direction of gravity, the axes of space, the caption.
std::vector<FrameItem> furniture(const Drawing& drawing, const View& view, const FrameOptions& options);

}  // namespace maupertuis::drawing
