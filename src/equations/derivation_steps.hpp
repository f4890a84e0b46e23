#pragma once
#include <maupertuis/reactions.hpp>

#include <vector>

namespace maupertuis {

/// The textbook path from coordinates to the equations of `derivation`, each line with its rule.
std::vector<DerivationStep> derivation_steps(const EquationsOfMotion& equations, const Derivation& derivation,
                                             const std::vector<Reaction>& reactions);

}  // namespace maupertuis
