#pragma once
#include "drawing/contact_places.hpp"
#include "drawing/outlines.hpp"

namespace maupertuis::drawing {

/// A line of ground that the model draws.
struct WrittenGround {
  std::vector<double> place, normal;
};

/// What the pictures of contacts are made from, when all else is in its place.
struct ContactSetting {
  Drawing& drawing;
  const MechanicalSystem& system;
  const Bindings& parameters;
  const ContactTracks& tracks;
  const std::vector<ContactImpulse>& impulses;
  std::vector<WrittenGround> grounds;
  std::vector<double> low, high;  // [2] of all that moves
  double extent = 1, hatching = 1;
  double metres_a_newton = 0;                               // of other arrows; 0: there are none
  std::function<void(const double*, std::size_t)> include;  // a place and its frame into the picture
};

/// Adds surfaces that no item of the model shows, arrows of the forces of contacts, and impulses: arrows that shrink
/// from the instant on.
void add_contacts(const ContactSetting& setting, std::vector<Outline>& outlines);

}  // namespace maupertuis::drawing
