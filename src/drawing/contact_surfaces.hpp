#pragma once
#include "drawing/contact_places.hpp"

namespace maupertuis::drawing {

/// What the surface of a contact is drawn from.
struct SurfaceRequest {
  const MechanicalSystem& system;
  const Bindings& parameters;
  const Drawing& drawing;             // its times
  const ContactPlaces& contact;       // of one place
  const std::vector<double>& states;  // [frames × n]
  std::vector<double> low, high;      // [2] of all that moves
  double extent = 1;                  // m, of the picture
  double spacing = 1;                 // m, of hatching
  /// How far what touches reaches from its place against a direction: the surface is drawn where that touches it.
  std::function<double(double nx, double ny)> reach;
};

/// A line, a circle, any curve on which the gap is 0, hatched on the side where it is negative.
struct Surface {
  SolidShape shape;
  std::vector<double> positions;  // of the solid, [frames × 6], or [6] where it stands still
  bool still = true;
  std::vector<double> line;  // [n × 2] its points at the first frame, as far as the scene goes
  bool straight = false, closed = false, stop = false;  // stop: a short piece across the way of a place
  double distance = 0;                                  // between the places of what touches and what is drawn
};

/// Its pieces that the motion comes near to. None where it moves and changes its form.
std::vector<Surface> surfaces_of(const SurfaceRequest& request);

}  // namespace maupertuis::drawing
