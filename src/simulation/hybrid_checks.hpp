#pragma once
#include "simulation/hybrid_motions.hpp"

#include <optional>
#include <vector>

/// Whether a motion keeps what its mode says, and which contacts touch at an instant.
namespace maupertuis::hybrid {

/// To which what an event sets keeps constraints and contacts.
inline constexpr double digits_of_sets = 1e-9;

/// Whether the conditions of the mode hold as the next step begins.
bool goes_on(const ModeMotion& motion, double bound);

/// Whether a closed contact pulled as the last step began. `constraints`: of the system itself.
bool pulls(const ModeMotion& motion, std::size_t constraints, const UsualSizes& sizes);

/// An open contact whose gap has become negative though no step saw it close: then nothing of the motion holds. Where
/// all lies at zero still, gaps are measured by what accelerations make of them in the step.
std::optional<std::size_t> violated_contact(const ModeMotion& motion, double step, const State& here,
                                            UsualSizes& sizes);

/// A contact that the start violates.
std::optional<std::size_t> contact_violated_at_start(const ContactValues& values, const UsualSizes& sizes);

/// Contacts with g = 0: closed ones, those that were hit, and those whose gap is rounding. Not those that an event has
/// just set apart.
std::vector<std::size_t> touching_contacts(const ContactMode& mode, const Met& met, const ContactValues& values,
                                           const UsualSizes& sizes);

/// A contact that never slides and has a slip: the constraint that it is would take it away, with the energy, and no
/// impact that would do so is part of the model.
std::optional<std::size_t> sliding_though_sticking(const std::vector<std::size_t>& touching,
                                                   const MechanicalSystem& system, const ContactValues& values,
                                                   const UsualSizes& sizes);

}  // namespace maupertuis::hybrid
