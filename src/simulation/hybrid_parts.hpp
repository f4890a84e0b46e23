#pragma once
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/integrator.hpp>

#include <limits>

/// What the parts of HybridMotion share.
namespace maupertuis {

/// A coefficient of friction for contacts that never slide, where their forces are sought.
inline constexpr double held_fast = 1e3;

/// a + factor b
SparseRow sum_of(const SparseRow& a, const SparseRow& b, double factor);

/// Of the sizes of terms: below, a gap or a speed is 0.
inline constexpr double rest_unit = 64 * std::numeric_limits<double>::epsilon();

/// Of the terms of g̈: what a located instant leaves of a force that falls through 0.
inline constexpr double located_force = 1e-9;

/// An event function of a mode, and what a root of it means.
struct HybridMotion::Watch {
  enum class What { Until, Event, Gap, Force, Hold, Slip, Normal } what = What::Event;
  std::size_t index = 0;  // of the event, the contact, the friction
  bool keeps_sign() const { return what != What::Until && what != What::Event; }  // must not be negative in its mode
  /// A gap or a force that comes to 0 and goes back changes nothing; a slip may come to rest there.
  bool touches_count() const { return !keeps_sign() || what == What::Slip; }
};

struct HybridMotion::ModeMotion {
  ContactMode mode;
  std::unique_ptr<EquationsOfMotion> equations;
  std::vector<Watch> watches;
  std::unique_ptr<TaylorStepper> stepper;
  std::size_t asked_for = 0;  // the last time, in turns of asking
};

/// What a step has met, to be settled before the next one.
struct HybridMotion::Pending {
  std::vector<std::size_t> hit;  // contacts whose gap came to 0
  std::vector<Watch> left;       // conditions of the mode that end here
  std::vector<const ModelEvent*> sets;
  bool begins = false;
};

/// What a contact or a friction may do next, the likeliest first.
struct HybridOption {
  bool closed = false;
  FrictionState state = FrictionState::None;
  std::int8_t normal_sign = 1;
};

struct HybridMotion::Choice {
  std::size_t contact = 0;  // or contacts + friction of a coordinate
  std::vector<HybridOption> options;
};

}  // namespace maupertuis
