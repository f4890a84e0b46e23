#pragma once
#include "analysis/linearization/matrices.hpp"

#include <maupertuis/modes.hpp>

namespace maupertuis {

/// The second-order form in coordinates y with unit mass, η = L⁻ᵀ y with M = L Lᵀ.
struct MassNormalForm {
  bool valid = false;      // M is positive definite
  bool symmetric = false;  // no first-order terms, K symmetric
  bool potential = false;  // K symmetric
  Matrix k, c;             // [f × f] of K + N and C + G
  Matrix to_independent;   // L⁻ᵀ
  Matrix translations;     // [f × translations] directions in y
};
MassNormalForm mass_normal_form(const Linearization& linearization, const std::vector<Translation>& translations);

/// Whether the point is stable, by the energy first, then by the eigenvalues of `modes`.
StabilityReport judge_stability(const PointEquations& equations, const Linearization& linearization,
                                const MassNormalForm& form, const std::vector<Translation>& translations,
                                const ModalAnalysis& modes, const Equilibrium* equilibrium);

}  // namespace maupertuis
