#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/mechanical_system.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// What becomes of a function of q, q', t that is conserved while all contacts are open and no event sets the state.
struct IntegralThroughModes {
  enum class Holds { Yes, No, Undecided };
  struct InMode {
    std::string mode;  // "floor sliding +"; "free"
    Holds holds = Holds::Undecided;
  };
  struct AtImpact {
    std::string contact;
    Holds kept = Holds::Undecided;
    double change = 0;  // the largest that was seen, relative to its size just before
  };
  struct AtEvent {
    std::string event;  // one that sets the state
    Holds kept = Holds::Undecided;
    double change = 0;  // as of impacts
  };
  std::vector<InMode> modes;
  std::vector<AtImpact> impacts;
  std::vector<AtEvent> events;
  std::size_t left_out = 0;  // modes that were not looked at: there are too many
  /// In all modes, at all impacts and events.
  bool everywhere() const;
};

/// Whether the equations hold in parts of the motion alone: between contacts, impacts, events that set the state.
bool is_in_parts(const Model& model);

/// In each mode by the zero test of dI/dt along its motion; at impacts by impacts at random states on the contact, near
/// the start: a change of more than rounding is a proof that it is not kept, and none at `impact_samples` of them
/// counts as kept. Of more than 64 modes those with at most one contact closed are looked at, up to 64, and the impacts
/// of the first 64 contacts. Events that set the state keep a function where its change vanishes as a formula;
/// otherwise it is looked at in random states at which the event happens.
std::vector<IntegralThroughModes> integrals_through_modes(const Model& model, const EquationsOfMotion& equations,
                                                          const std::vector<Expr>& integrals);
inline constexpr int impact_samples = 20;

}  // namespace maupertuis
