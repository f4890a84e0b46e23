#pragma once
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/integrator.hpp>

#include <limits>

/// What the parts of HybridMotion share.
namespace maupertuis {

using namespace hybrid;

/// To which what an event sets keeps constraints and contacts.
inline constexpr double digits_of_sets = 1e-9;

/// What is said where rigid contact has no motion, or several.
inline constexpr const char* beyond_painleve =
    "Textbooks go on by an impact without collision, an impulse of the contact that is not hit; none is made here: a "
    "stiff spring in place of the rigid contact says what happens, as `force on P = (-μ N P.x'/sqrt(P.x'^2 + v0^2), "
    "N)` "
    "with N = k max(-P.y, 0) on a floor.";

/// Modes that are tried at an instant.
inline constexpr std::size_t most_choices = 1024;

/// Of the terms of g̈: what a located instant leaves of a force that falls through 0.
inline constexpr double located_force = 1e-9;

/// A mode that fits.
struct HybridMotion::Found {
  ContactMode mode;
  std::vector<double> accelerations;
  Given given;
};

}  // namespace maupertuis
