#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// Constraints of phase space and their classes, the numbers of a degenerate Lagrangian, Dirac's brackets.
void decide_degenerate(const expectation::PhaseConstraints& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result);
void decide_degenerate(const expectation::ClassCount& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result);
void decide_degenerate(const expectation::Bracket& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result);

}  // namespace maupertuis
