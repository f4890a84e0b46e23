#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <span>

/// What a motion with contacts needs before it begins.
namespace maupertuis {

/// E0729 where momenta are not linear in the velocities; E0730 for each contact with a kink or a step.
bool contacts_can_be_followed(const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// E0728 for each contact that is violated at the start.
bool start_keeps_contacts(const Model& model, double t, std::span<const double> q, Diagnostics& diagnostics);

}  // namespace maupertuis
