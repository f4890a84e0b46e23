#pragma once
#include <maupertuis/drawing.hpp>

#include <array>

/// Solids in their own axes.
namespace maupertuis::shapes {

SolidShape box(int dimension, bool flat);  // flat: in space, a plate without thickness in the first two axes
SolidShape disc(int dimension);            // the unit disc in the first two axes
SolidShape hoop(int dimension);            // its rim alone
void add_spokes(SolidShape& shape, int dimension, int count);
SolidShape ball(bool meridians);  // in space: the unit ball, with three great circles where it turns

/// From 0 to 1 along the first axis; the others are its thickness. `windings` at least 1; `slant`: how far the front of
/// a winding leads its back, as a part of the length.
SolidShape spring(int dimension, int windings, double slant);
/// A dashpot: the cup stands on the first end, the plate on the second. Along the first axis in metres.
SolidShape cup(int dimension, double from, double to);
SolidShape plate(int dimension, double rod);
/// Bars across, from the ends of a spring or dashpot that stands `aside` to the places that it joins.
void add_bars_to_middle(SolidShape& shape, int dimension, double aside, bool both_ends);

/// A triangle on hatched ground below the origin, for a pivot; hatched ground behind the origin, for the end of a
/// spring.
SolidShape pivot();
SolidShape anchor();
/// A line with hatching below it, from −half to +half of the first axis; in space a square of lines.
SolidShape ground_line(double half, double spacing);
SolidShape ground_grid(int lines);

/// Semi-axes and principal axes (columns) of the homogeneous ellipsoid with this inertia [3 × 3, about its centre] and
/// mass; a semi-axis that the inertia does not give is a fiftieth of the largest. Zero or a negative mass: the largest
/// semi-axis is 1.
struct Ellipsoid {
  std::array<double, 3> semi_axes{};
  std::array<std::array<double, 3>, 3> axes{};  // [which][component], right-handed
};
Ellipsoid ellipsoid_of_inertia(const std::array<std::array<double, 3>, 3>& inertia, double mass);

/// Two unit vectors that make a right-handed basis with the direction of `axis`.
std::array<std::array<double, 3>, 3> basis_about(const std::array<double, 3>& axis);

}  // namespace maupertuis::shapes
