#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <vector>

namespace maupertuis {

/// The textbook path from coordinates to the equations of `derivation`, each line with its rule.
std::vector<DerivationStep> derivation_steps(const EquationsOfMotion& equations, const Derivation& derivation);

}  // namespace maupertuis
