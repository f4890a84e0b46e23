#pragma once
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/modes.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// Static friction at a point of rest.
struct StaticHold {
  std::string friction;  // of the contact or the coordinate
  double force = 0;      // |λ_t| with which it holds the point
  double limit = 0;      // the most that it may be: μ_s N
  Dimension dimension;   // of both: a force, or a moment along an angle
};

/// The values of one coordinate at which static friction holds the system.
struct RestingRange {
  std::size_t coordinate = 0;
  double from = 0, to = 0;  // SI; infinite where nothing ends it
};

/// Points of rest in one mode of contacts: closed ones press, the gaps of the others are open.
struct RestingMode {
  ContactMode mode;
  std::string text;           // "floor", "floor sticking"; "free"
  bool frictionless = false;  // friction acts in it, and is left out of its equations
  std::shared_ptr<const EquationsOfMotion> equations;
  ModalStudy study;  // entries that are points of rest here
  std::vector<bool>
      forces_are_open;  // [entries] the balance does not determine them; these keep the limits of friction
  std::vector<std::vector<StaticHold>> holds;       // [entries] the frictions that act there
  std::vector<std::optional<RestingRange>> ranges;  // [entries] where one coordinate tells what friction holds
};

struct RestingModes {
  std::vector<RestingMode> found;  // by the number of closed contacts, then in their order
  std::size_t sets_looked_at = 0;  // of closed contacts
  double sets = 1;                 // that there are
  bool all_sets() const { return static_cast<double>(sets_looked_at) >= sets; }
};

/// The points of rest of a system with contacts and friction, each with the linearization of its mode: contacts that
/// are closed and press are constraints, those and no others that touch there. Where friction acts the points are those
/// at which no friction is needed, with the equations without it, and beside them what static friction holds; where
/// there are none, points that friction holds. Of up to six contacts all sets of closed ones are looked at, of more 64:
/// those that touch at the start, or where the potential is lowest downhill from there, all together, and the smaller
/// ones; then those that are met. Points where a closed contact cannot press are left out. Empty, with E1308, where
/// there is none.
/// Precondition: no reactions stand in normal forces (with_reactions).
RestingModes resting_modes(const MechanicalSystem& system, const MotionState& start, Diagnostics& diagnostics);

/// The mode that rests at a point, given as to modal_study_at; the first of them in that order. Nothing, with E1308,
/// where none does.
std::optional<RestingMode> resting_mode_at(const MechanicalSystem& system, const MotionState& start,
                                           const std::vector<StartValue>& at, Diagnostics& diagnostics);

}  // namespace maupertuis
