#pragma once
#include <maupertuis/reactions.hpp>

#include "equations/step_writer.hpp"

namespace maupertuis {

/// "tied by 1 constraint, so 1 freedom if no constraint repeats another."
std::string counting_sentence(const MechanicalSystem& system);

/// φ, ψ and the rows of A.
void write_constraints(StepWriter& out);
/// A q̈ = b.
void write_constraint_accelerations(StepWriter& out);
/// The equations without λ where they are short, and λ itself; `any_left`: some acceleration was too long.
void write_solved_multipliers(StepWriter& out, bool any_left);
void write_reactions(StepWriter& out, const std::vector<Reaction>& reactions);

}  // namespace maupertuis
