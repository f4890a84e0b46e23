#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <span>

/// What a motion with contacts needs before it begins.
namespace maupertuis {

/// E0728 for each contact that is violated at the start.
bool start_keeps_contacts(const Model& model, double t, std::span<const double> q, Diagnostics& diagnostics);

}  // namespace maupertuis
